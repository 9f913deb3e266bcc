#include "reports/sweep/plan.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr std::size_t fingerprint_digits = 12;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

double number_in(const Settings& set, const char* key, double otherwise) {
    const auto found = set.find(key);
    if (found == set.end()) return otherwise;
    double value = otherwise;
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
    return value;
}

/// What the configuration tells, unless `set` says it; else `otherwise`.
double number_in(const Settings& set, const fs::path& config, const char* key, double otherwise) {
    try {
        otherwise = YAML::LoadFile(config.string())[key].as<double>(otherwise);
    } catch (const YAML::Exception&) {
    }
    return number_in(set, key, otherwise);
}

/// Windows a second that trainings of each kind were seen to take on two cores, by the width of their networks.
double training_pace(const std::string& kind, const Settings& set, const fs::path& config) {
    if (kind == "generator") return 200 * std::pow(200 / number_in(set, config, "width", 200), 1.5);
    return 17 * std::pow(number_in(set, config, "width", 1), -1.67);
}

/// Builds the jobs one after another; the same work asked for again is the same job.
class Planner {
  public:
    Planner(const Sweep& sweep, fs::path beside) : sweep_(sweep), beside_(std::move(beside)) {}

    Plan plan() {
        for (const auto& row : sweep_.rows) plan_row(row);
        return std::move(plan_);
    }

  private:
    /// A dataset or recogniser: the job that makes it, none where it is there, and its path.
    struct Made {
        std::optional<std::size_t> job;
        std::string path;
        double clips = 0;  ///< of a dataset; 0 where that is not known yet
    };

    std::string found(const std::string& path, Job& job) const {
        for (const auto& candidate : {fs::path(path), beside_ / path})
            if (fs::exists(candidate)) return fs::absolute(candidate).lexically_normal().string();
        if (job.problem.empty()) job.problem = fmt::format("{}: no such file or folder", path);
        return path;
    }

    /// What should be there, and needs no job then; where it is not, `job` stands for it and says so.
    Made at_hand(const std::string& path, const char* what, Job job) {
        const auto at = found(path, job);
        if (job.problem.empty()) return {{}, at};
        job.commands = {{what, at}};
        return {add(std::move(job)), at};
    }

    /// The contents that a file has now are part of the fingerprint.
    std::string with_contents(const std::string& path, Job& job) {
        const auto at = found(path, job);
        if (fs::is_regular_file(at)) contents_ += "|" + checksum_file(at);
        return at;
    }

    std::size_t add(Job job) {
        Checksum sum;
        sum.add(fmt::format("{}|{}|{}", job.kind, ACTFORMER_VERSION, contents_));
        contents_.clear();
        for (const auto& command : job.commands)
            for (const auto& word : command) sum.add("|" + word);
        job.id = job.kind + "-" + sum.hex().substr(0, fingerprint_digits);
        for (std::size_t i = 0; i < plan_.jobs.size(); ++i)
            if (plan_.jobs[i].id == job.id) return i;
        plan_.jobs.push_back(std::move(job));
        return plan_.jobs.size() - 1;
    }

    std::string folder_of(std::size_t job) const { return "{out}/jobs/" + plan_.jobs[job].id; }

    void need(Job& job, const Made& made) {
        if (!made.job) return;
        if (std::find(job.needs.begin(), job.needs.end(), *made.job) == job.needs.end())
            job.needs.push_back(*made.job);
    }

    Made dataset(const std::string& name) {
        const auto& d = sweep_.datasets.at(name);
        Job job;
        job.kind = "ingest";
        job.title = "dataset " + name;
        if (!d.path.empty()) {
            auto made = at_hand(d.path, "dataset", std::move(job));
            if (!made.job) made.clips = clips_in(made.path);
            return made;
        }
        Words ingest{"{program}", "ingest", d.format};
        if (d.clips > 0) {
            Words synth{"{program}",
                        "synth",
                        "ntu",
                        "-o",
                        "{job}/raw",
                        "--clips",
                        std::to_string(d.clips),
                        "--seed",
                        std::to_string(d.seed)};
            if (!d.actions.empty()) synth.insert(synth.end(), {"--actions", d.actions});
            job.commands.push_back(synth);
            ingest.emplace_back("{job}/raw");
            job.work = static_cast<double>(d.clips);
            job.pace = 300;  // written as text first
        }
        for (const auto& raw : d.raw) ingest.push_back(found(raw, job));
        ingest.insert(ingest.end(), {"-o", "{job}/data"});
        ingest.insert(ingest.end(), d.arguments.begin(), d.arguments.end());
        job.commands.push_back(ingest);
        const auto at = add(std::move(job));
        return {at, folder_of(at) + "/data" + (d.use.empty() ? "" : "/" + d.use),
                static_cast<double>(d.clips)};
    }

    /// 0 where it cannot be read: whoever uses it will say why.
    static double clips_in(const std::string& path) {
        try {
            return static_cast<double>(ingest::Dataset(path).clips().size());
        } catch (const Error&) {
            return 0;
        }
    }

    void add_training_words(Job& job, const std::string& config, const Settings& set, const Made& data) {
        auto& words = job.commands[0];
        words.insert(words.end(), {"-c", with_contents(config, job), "--data", data.path, "-o", "{job}/run"});
        for (const auto& [key, value] : set) words.push_back(key + "=" + value);
        job.work = number_in(set, words[4], "epochs", 0) * data.clips / 2;  // a protocol trains on about half
        job.pace = training_pace(job.kind, set, words[4]);
    }

    Made recogniser(const std::string& name) {
        const auto& r = sweep_.recognisers.at(name);
        Job job;
        job.kind = "recogniser";
        job.title = "recogniser " + name;
        if (!r.weights.empty()) return at_hand(r.weights, "weights", std::move(job));
        const auto data = dataset(r.data);
        need(job, data);
        job.commands = {{"{program}", "train", "recogniser"}};
        add_training_words(job, r.config, r.set, data);
        const auto at = add(std::move(job));
        return {at, folder_of(at) + "/run"};
    }

    std::size_t generator(const SweepRow& row, std::uint64_t seed, const Made& data) {
        Job job;
        job.kind = "generator";
        job.title = fmt::format("{}, seed {}: generator", row.name, seed);
        need(job, data);
        job.commands = {{"{program}", "train", "generator"}};
        auto set = row.set;
        set["seed"] = std::to_string(seed);
        add_training_words(job, row.config, set, data);
        return add(std::move(job));
    }

    /// A few motions to look at.
    std::size_t generate(const SweepRow& row, std::uint64_t seed, std::size_t generator) {
        Job job;
        job.kind = "generate";
        job.title = fmt::format("{}, seed {}: motions to look at", row.name, seed);
        job.needs = {generator};
        job.commands = {{"{program}", "generate", "--generator", folder_of(generator) + "/run", "-o",
                         "{job}/motions.h5", "--per-class", "4", "--seed", "0"}};
        if (const auto device = row.set.find("device"); device != row.set.end())
            job.commands[0].insert(job.commands[0].end(), {"--device", device->second});
        job.work = 1;
        job.pace = 0.5;
        return add(std::move(job));
    }

    void plan_row(const SweepRow& row) {
        PlannedRow planned{&row, {}};
        const auto data = dataset(row.data), eyes = recogniser(row.recogniser);
        const auto single = row.single_recogniser.empty() ? Made{} : recogniser(row.single_recogniser);
        const auto seeds = row.motions.empty() ? row.seeds : std::vector<std::uint64_t>{0};
        for (const auto seed : seeds) {
            PlannedRun run;
            run.seed = seed;
            Job job;
            job.kind = "score";
            job.title = fmt::format("{}, seed {}: scores", row.name, seed);
            for (const auto& made : {data, eyes, single}) need(job, made);
            Words words{"{program}", "score",   "--recogniser", eyes.path,  "--real",
                        data.path,   "--split", row.split,      "--window", std::to_string(row.window)};
            if (!single.path.empty()) words.insert(words.end(), {"--single-recogniser", single.path});
            if (!row.device.empty()) words.insert(words.end(), {"--device", row.device});
            if (row.motions.empty()) {
                run.generator = generator(row, seed, data);
                run.generate = generate(row, seed, *run.generator);
                run.run = folder_of(*run.generator) + "/run";
                run.motions = folder_of(*run.generate) + "/motions.h5";
                job.needs.push_back(*run.generator);
                words.insert(words.end(), {"--generator", run.run, "--repeats", std::to_string(row.repeats),
                                           "--per-class", std::to_string(row.per_class)});
                if (const auto device = row.set.find("device"); device != row.set.end())
                    words.insert(words.end(), {"--generate-on", device->second});
            } else {
                words.emplace_back("--generated");
                for (const auto& motions : row.motions) words.push_back(with_contents(motions, job));
                run.motions = words.back();
            }
            words.insert(words.end(), {"-o", "{job}/scores.json", "--keep-features", "{job}/features"});
            job.commands = {words};
            job.work = static_cast<double>(row.repeats * row.per_class);
            job.pace = 10;  // of each of some tens of classes
            run.score = add(std::move(job));
            run.scores = folder_of(run.score) + "/scores.json";
            run.features = folder_of(run.score) + "/features";
            run.recogniser = eyes.path;
            run.dataset = data.path;
            planned.runs.push_back(std::move(run));
        }
        plan_.rows.push_back(std::move(planned));
    }

    const Sweep& sweep_;
    fs::path beside_;
    std::string contents_;
    Plan plan_;
};

}  // namespace

Plan make_plan(const Sweep& sweep, const fs::path& beside) {
    return Planner(sweep, beside).plan();
}

std::vector<std::string> filled_in(const std::vector<std::string>& words, const std::string& program,
                                   const fs::path& out, const Job& job) {
    auto filled = words;
    for (auto& word : filled) {
        replace_all(word, "{job}", "{out}/jobs/" + job.id);
        replace_all(word, "{out}", out.string());
        replace_all(word, "{program}", program);
    }
    return filled;
}

}  // namespace actformer::reports
