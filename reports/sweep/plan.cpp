#include "reports/sweep/plan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "base/hdf5/reader.hpp"
#include "base/process/shipped.hpp"
#include "eval/run_weights.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "reports/same_path.hpp"
#include "reports/sweep/configuration.hpp"
#include "reports/sweep/raw_files.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t fingerprint_digits = 12;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

/// The number that text_in finds; `otherwise` where it finds none.
double number_in(const Settings& set, const fs::path& config, const char* key, double otherwise) {
    const auto text = text_in(set, config, key, {});
    double value = otherwise;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

/// Windows a second that trainings of each kind were seen to take on two cores, by the width of their networks.
double training_pace(const std::string& kind, const Settings& set, const fs::path& config) {
    if (kind == "generator") return 200 * std::pow(200 / number_in(set, config, "width", 200), 1.5);
    return 17 * std::pow(number_in(set, config, "width", 1), -1.67);
}

/// The Error that `refuse` throws for an HDF5 file; empty without one, and for a file that cannot be read: the job that uses it will say
/// why.
template <typename Refuse>
std::string fault_of_file(const fs::path& path, Refuse refuse) {
    std::optional<hdf5::Reader> file;
    try {
        if (fs::is_regular_file(path)) file.emplace(path);
    } catch (const Error&) {
        return {};
    }
    try {
        if (file) refuse(*file);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

/// Empty where it may hold motions, as files of other tools do.
std::string fault_of_motions(const fs::path& path) {
    if (fs::is_directory(path))
        return fmt::format("{}: a folder; a file of motions (.h5) is expected", path.string());
    return fault_of_file(
        path, [&](const hdf5::Reader& file) { ingest::refuse_other_than_motions(file, path.string()); });
}

/// Builds the jobs one after another; the same work asked for again is the same job.
class Planner {
  public:
    Planner(const Sweep& sweep, fs::path beside, fs::path out, const JobRunner& runner)
        : sweep_(sweep), beside_(std::move(beside)), out_(std::move(out)), runner_(runner) {}

    Plan plan() {
        for (const auto& row : sweep_.rows) plan_row(row);
        return std::move(plan_);
    }

  private:
    /// A dataset or network: the job that makes it, none where it is there, and its path.
    struct Made {
        std::optional<std::size_t> job;
        std::string path;
        double clips = 0;        ///< of a dataset; 0 where that is not known yet
        std::string contents{};  ///< checksum of weights or of a dataset that are there
    };

    /// Its path where it is there; empty where it is not.
    std::string place_of(const std::string& path) const {
        for (const auto& candidate : {fs::path(path), beside_ / path, shipped_folder() / path})
            if (fs::exists(candidate)) return fs::absolute(candidate).lexically_normal().string();
        return {};
    }

    std::string found(const std::string& path, Job& job) const {
        if (auto at = place_of(path); !at.empty()) return at;
        if (job.problem.empty())
            job.problem = fmt::format("{}: no such file or folder{}", path, did_you_mean(path));
        return path;
    }

    /// What lies there where it cannot be `wanted`; else empty.
    static std::string other_than(std::string_view wanted, const std::string& at) {
        const auto is = ingest::other_kind(at, wanted);
        return is.empty() ? "" : fmt::format("{}: holds {}, not {}", at, is, wanted);
    }

    /// Of weights, or of a training's folder; a training has weights once it has done an epoch.
    static std::string fault_of_weights(std::string_view wanted, const std::string& at) try {
        if (auto other = other_than(wanted, at); !other.empty()) return other;
        const auto file = eval::weights_of(at);
        return fault_of_file(file, [&](const hdf5::Reader& reader) {
            ingest::refuse_other_file(reader, file.string(), wanted, "give a training or its weights");
        });
    } catch (const Error& e) {
        return e.what();
    }

    /// What should be there, and needs no job then; where it is not, or `fault_of` finds one, `job` stands for it and says so.
    template <typename Fault>
    Made there(const std::string& path, const char* what, Job job, Fault fault_of) {
        const auto at = found(path, job);
        if (job.problem.empty()) job.problem = fault_of(at);
        if (job.problem.empty()) return {{}, at};
        job.work = MissingWork{what, at};
        return {add(std::move(job)), at};
    }

    /// Weights, or the folder of a training.
    Made ready_weights(const std::string& path, std::string_view kind, Job job) {
        auto made = there(path, "weights", std::move(job),
                          [&](const std::string& at) { return fault_of_weights(kind, at); });
        if (made.job) return made;
        try {
            made.contents = checksum_file(eval::weights_of(made.path));
        } catch (const Error&) {  // a job that uses them will say why
        }
        return made;
    }

    /// The contents that a file has now are part of the fingerprint.
    std::string with_contents(const std::string& path, Job& job) {
        const auto at = found(path, job);
        if (fs::is_regular_file(at)) {
            contents_ += "|" + checksum_file(at);
            read_.insert(at);
        }
        return at;
    }

    /// The files that are there now are part of the fingerprint.
    std::string with_listing(const std::string& path, Job& job) {
        const auto at = found(path, job);
        if (fs::exists(at)) contents_ += "|" + listing_of(at, out_);
        return at;
    }

    /// The contents of a file that an argument names, as in --labels=classes.csv, are part of the fingerprint.
    void count_argument(const std::string& word) {
        const auto file = word.starts_with("-") ? word.substr(word.find('=') + 1) : word;
        std::error_code ignored;
        const bool number = file.find_first_not_of("0123456789") == std::string::npos;
        if (!number && fs::is_regular_file(file, ignored)) contents_ += "|" + checksum_file(file);
    }

    /// What a training's windows are, and the recogniser that chooses its weights, are part of the fingerprint.
    void count_settings(const Settings& set, const std::string& config) {
        if (text_in(set, config, "joints", {}) == "common15") contents_ += "|centred windows";
        const auto chooses = text_in(set, config, "recogniser", {});
        std::error_code ignored;
        if (!fs::exists(chooses, ignored)) return;
        try {
            contents_ += "|" + checksum_file(eval::weights_of(chooses));
        } catch (const Error&) {  // the training will say why
        }
    }

    /// It may be one that comes with the program. Throws Error where there is none.
    std::string configuration_at(const std::string& path) const {
        const auto at = place_of(path);
        return at.empty() ? file_or_shipped(path, "model/configs").string() : at;
    }

    std::string configuration(const std::string& path, Job& job) {
        try {
            return with_contents(configuration_at(path), job);
        } catch (const Error& e) {
            if (job.problem.empty()) job.problem = e.what();
            return path;
        }
    }

    std::size_t add(Job job) {
        Checksum sum;
        sum.add(fmt::format("{}|{}|{}", job.kind, ACTFORMER_VERSION, contents_));
        contents_.clear();
        const auto read = std::exchange(read_, {});
        for (const auto& word : runner_.identity(job.work))  // a file with known contents may lie anywhere
            sum.add("|" + (read.contains(word) ? fs::path(word).filename().string() : word));
        job.id = job.kind + "-" + sum.hex().substr(0, fingerprint_digits);
        for (std::size_t i = 0; i < plan_.jobs.size(); ++i)
            if (plan_.jobs[i].id == job.id) return i;
        plan_.jobs.push_back(std::move(job));
        return plan_.jobs.size() - 1;
    }

    /// Where others find what a job makes: the job's own path as one within the sweep.
    std::string made_by(std::size_t job, std::string path) const {
        replace_all(path, "{job}", "{out}/jobs/" + plan_.jobs[job].id);
        return path;
    }

    /// To be called right before the job is added, as the contents become part of its fingerprint.
    void need(Job& job, const Made& made) {
        if (!made.contents.empty()) {
            contents_ += "|" + made.contents;
            read_.insert(made.path);
        }
        if (!made.job) return;
        if (std::find(job.needs.begin(), job.needs.end(), *made.job) == job.needs.end())
            job.needs.push_back(*made.job);
    }

    Made dataset(const std::string& name) {
        const auto found = datasets_.find(name);
        return found != datasets_.end() ? found->second
                                        : datasets_[name] = new_dataset(sweep_.datasets.at(name), name);
    }

    Made new_dataset(const SweepDataset& d, const std::string& name) {
        Job job;
        job.kind = "ingest";
        job.title = "dataset " + name;
        if (!d.path.empty()) {
            auto made = there(d.path, "dataset", std::move(job),
                              [](const std::string& at) { return other_than(ingest::own::dataset, at); });
            if (!made.job) look_into(made);
            return made;
        }
        IngestWork work;
        work.format = d.format;
        work.clips = d.clips;
        work.seed = d.seed;
        work.actions = d.actions;
        work.arguments = d.arguments;
        for (const auto& raw : d.raw) work.raw.push_back(with_listing(raw, job));
        for (const auto& word : d.arguments) count_argument(word);
        if (d.clips > 0) {
            job.amount = static_cast<double>(d.clips);
            job.pace = 300;  // written as text first
        }
        job.work = work;
        const auto at = add(std::move(job));
        return {at, made_by(at, work.out) + (d.use.empty() ? "" : "/" + d.use), static_cast<double>(d.clips)};
    }

    /// A dataset that is there: how many clips it has, and the checksum of all that it is. A job that uses one that cannot be read
    /// will say why.
    static void look_into(Made& dataset) {
        try {
            const auto folder = ingest::one_dataset_at(dataset.path);
            dataset.contents = ingest::dataset_checksum(folder);
            dataset.clips = static_cast<double>(ingest::Dataset(folder).clips().size());
        } catch (const Error&) {
            dataset.clips = 0;
        }
    }

    std::size_t train(Job job, const std::string& config, const Settings& set, const Made& data) {
        need(job, data);
        TrainingWork work{job.kind, configuration(config, job), data.path, set};
        count_settings(set, work.config);
        job.amount =
            number_in(set, work.config, "epochs", 0) * data.clips / 2;  // a protocol trains on about half
        job.pace = training_pace(job.kind, set, work.config);
        job.work = std::move(work);
        return add(std::move(job));
    }

    Made recogniser(const std::string& name) {
        const auto& r = sweep_.recognisers.at(name);
        Job job;
        job.kind = "recogniser";
        job.title = "recogniser " + name;
        if (!r.weights.empty()) return ready_weights(r.weights, ingest::own::recogniser, std::move(job));
        const auto at = train(std::move(job), r.config, r.set, dataset(r.data));
        return {at, made_by(at, TrainingWork().out)};
    }

    Made generator(const SweepRow& row, std::uint64_t seed, const Made& data) {
        Job job;
        job.kind = "generator";
        job.title = fmt::format("{}, seed {}: generator", row.name, seed);
        if (!row.weights.empty()) return ready_weights(row.weights, ingest::own::generator, std::move(job));
        auto set = row.set;
        set["seed"] = std::to_string(seed);
        const auto at = train(std::move(job), row.config, set, data);
        return {at, made_by(at, TrainingWork().out)};
    }

    /// The libtorch device that a row trains on, where it says one.
    static std::string device_of(const SweepRow& row) {
        const auto device = row.set.find("device");
        return device == row.set.end() ? "" : device->second;
    }

    /// A few motions to look at.
    std::size_t generate(const SweepRow& row, std::uint64_t seed, const Made& generator) {
        Job job;
        job.kind = "generate";
        job.title = fmt::format("{}, seed {}: motions to look at", row.name, seed);
        need(job, generator);
        GenerationWork work;
        work.generator = generator.path;
        work.device = device_of(row);
        job.work = std::move(work);
        job.amount = 1;
        job.pace = 0.5;
        return add(std::move(job));
    }

    void plan_row(const SweepRow& row) {
        PlannedRow planned{&row, split_of(row), {}};
        const auto data = dataset(row.data);
        const auto together = row.recogniser.empty() ? Made{} : recogniser(row.recogniser);
        const auto single = row.single_recogniser.empty() ? Made{} : recogniser(row.single_recogniser);
        const bool trains = row.motions.empty() && row.weights.empty();
        const auto seeds = trains ? row.seeds : std::vector<std::uint64_t>{0};
        for (const auto seed : seeds)
            planned.runs.push_back(planned_run(planned, seed, data, together, single));
        plan_.rows.push_back(std::move(planned));
    }

    /// What it trains on, where it does not say.
    std::string split_of(const SweepRow& row) const {
        if (!row.split.empty()) return row.split;
        std::string config;
        try {
            if (!row.config.empty()) config = configuration_at(row.config);
        } catch (const Error&) {  // the training will say so
        }
        return text_in(row.set, config, "train_split", "all");
    }

    /// Each file is a repeat.
    std::vector<std::string> ready_motions(const std::vector<std::string>& paths, Job& job) {
        std::vector<std::string> files;
        for (const auto& path : paths) {
            files.push_back(with_contents(path, job));
            if (job.problem.empty()) job.problem = fault_of_motions(files.back());
        }
        const auto again = given_twice(std::vector<fs::path>(files.begin(), files.end()));
        if (again && job.problem.empty())
            job.problem = fmt::format("{}: given twice in motions; each file is a repeat", again->string());
        return files;
    }

    PlannedRun planned_run(const PlannedRow& planned, std::uint64_t seed, const Made& data,
                           const Made& recogniser, const Made& single) {
        const auto& row = *planned.row;
        PlannedRun run;
        run.seed = seed;
        Job job;
        job.kind = "score";
        job.title = fmt::format("{}, seed {}: scores", row.name, seed);
        ScoringWork work;
        work.recogniser = recogniser.path;
        run.recogniser = recogniser.path.empty() ? single.path : recogniser.path;
        work.single_recogniser = single.path;
        work.data = run.dataset = data.path;
        work.split = planned.split;
        work.device = row.device;
        work.window = row.window;
        work.repeats = row.repeats;
        work.per_class = row.per_class;
        const auto made_with = row.motions.empty() ? generator(row, seed, data) : Made{};
        if (row.motions.empty()) {
            run.generator = made_with.job;
            run.generate = generate(row, seed, made_with);
            run.run = work.generator = made_with.path;
            run.motions = made_by(*run.generate, GenerationWork().out);
            work.generate_on = device_of(row);
        }
        for (const auto& made : {data, recogniser, single, made_with}) need(job, made);
        if (!row.motions.empty()) {
            work.motions = ready_motions(row.motions, job);
            run.motions = work.motions.front();  // as the features that are kept
        }
        job.amount = static_cast<double>(row.repeats * row.per_class);
        job.pace = 10;  // of each of some tens of classes
        job.work = work;
        run.score = add(std::move(job));
        run.scores = made_by(run.score, work.out);
        run.features = made_by(run.score, work.features);
        return run;
    }

    const Sweep& sweep_;
    fs::path beside_, out_;
    const JobRunner& runner_;
    std::string contents_;        ///< checksums of the files that the next job reads
    std::set<std::string> read_;  ///< their paths
    std::map<std::string, Made> datasets_;
    Plan plan_;
};

}  // namespace

Plan make_plan(const Sweep& sweep, const fs::path& beside, const fs::path& out, const JobRunner& runner) {
    return Planner(sweep, beside, out, runner).plan();
}

std::string filled_in(std::string path, const fs::path& out, const Job& job) {
    replace_all(path, "{job}", "{out}/jobs/" + job.id);
    replace_all(path, "{out}", out.string());
    return path;
}

}  // namespace actformer::reports
