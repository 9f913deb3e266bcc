// actformer score: what generated motions are worth beside real ones.
#include "cli/score.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/lock.hpp"
#include "base/files/output.hpp"
#include "base/files/scratch.hpp"
#include "base/files/temporary.hpp"
#include "base/files/work_folder.hpp"
#include "base/process/interruption.hpp"
#include "base/random/shuffle.hpp"
#include "base/text/counted.hpp"
#include "cli/common_options.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "eval/scoring/labels_file.hpp"
#include "eval/scoring/motions_file_source.hpp"
#include "eval/scoring/score.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/export/foreign.hpp"
#include "kernels/sampler.hpp"
#include "reports/same_path.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;

struct ScoreOptions {
    eval::ScoreMotions motions;
    eval::ScoreFeatures features;
    eval::GeneratedRequest generate;
    std::vector<fs::path> generated;
    fs::path labels, out;
    std::string device;
    std::uint32_t frames = 0;
    std::uint64_t seed = 0;
    std::string protocol = "actformer";
    std::uint32_t samples = 0;  ///< most motions that ACTOR's protocol makes; 0: 3000
    bool kid = false, fid_infinity = false, force = false, json = false;
    bool repeats_given = false, per_class_given = false;

    bool as_actor() const { return protocol == "actor"; }
    eval::ScorerOptions scorer() const {
        eval::ScorerOptions asked;
        asked.seed = seed;
        asked.protocol = as_actor() ? eval::Protocol::actor : eval::Protocol::actformer;
        asked.kid = kid;
        asked.fid_infinity = fid_infinity;
        return asked;
    }
};

/// Where features are put while they are needed: beside the output, so that scoring goes on where it was, else
/// in a temporary folder. Gone when scoring has ended well, the temporary one in any case.
class WorkFolder {
  public:
    explicit WorkFolder(const fs::path& out) {
        const auto output = out.empty() ? Output{{}, true} : output_at(out);
        if (output.stream) {
            path_ = temporary_.emplace("score").path();
            return;
        }
        path_ = output.file.string() + ".work";
        expect_own_folder(path_, eval::is_kept_by_score);
        kept_.emplace(
            [this, &out] {
                lock_ = FileLock::on_folder_if_free(path_);
                if (!lock_)
                    throw Error("{}: another score is writing there; wait for it, or choose another -o",
                                out.string());
                return path_;
            },
            Temporary::Removes::empty_folder);
        goes_on_.emplace("the same command goes on from there");
    }
    ~WorkFolder() {
        std::error_code ignored;
        if (!temporary_) fs::remove(path_, ignored);  // where nothing is in it yet
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const fs::path& path() const { return path_; }
    void done() { remove_own_folder(path_, eval::is_kept_by_score); }

  private:
    std::optional<Scratch> temporary_;
    std::optional<Temporary> kept_;
    std::optional<FileLock> lock_;
    std::optional<GoesOn> goes_on_;
    fs::path path_;
};

/// Labels that the real side has, where these are not all: no others can be scored.
std::vector<std::uint32_t> labels_to_generate(const eval::WindowsOptions& real) {
    const ingest::Dataset dataset(real.dataset);
    std::set<std::uint32_t> labels;
    for (const auto clip : dataset.split(real.split)) labels.insert(dataset.clips()[clip].label);
    if (labels.size() == dataset.header().classes.size()) return {};
    return {labels.begin(), labels.end()};
}

/// ACTOR's protocol: a motion for every window of the real side, of its class, in 20 seeds; for more than 3,000 windows some. So
/// classes are as frequent on both sides.
void ask_as_actor(const ScoreOptions& options, const eval::WindowsOptions& real,
                  eval::GeneratedRequest& wanted) {
    constexpr std::uint32_t most = 3000;
    if (options.per_class_given)
        throw Error("--per-class: ACTOR's protocol makes a motion for every real window; leave it out");
    const ingest::Dataset dataset(real.dataset);
    const auto clips = dataset.split(real.split);
    std::vector<std::uint32_t> frames;
    for (const auto clip : clips) frames.push_back(dataset.clips()[clip].frames);
    auto windows = kernels::consecutive_windows(frames, real.window);
    std::mt19937_64 random(options.seed);
    shuffle(windows, random);
    windows.resize(std::min<std::size_t>(windows.size(), options.samples ? options.samples : most));
    std::map<std::uint32_t, std::uint32_t> counts;
    for (const auto& window : windows) ++counts[dataset.clips()[clips[window.clip]].label];
    wanted.labels.clear();
    for (const auto& [label, count] : counts) {
        wanted.labels.push_back(label);
        wanted.counts.push_back(count);
    }
    if (!options.repeats_given) wanted.sets = 20;
}

/// True where features files are scored, false where motions are.
bool from_features(const ScoreOptions& options) {
    const auto& m = options.motions;
    const auto& f = options.features;
    const bool features = !f.real.empty() || !f.generated.empty();
    const bool motions = !m.recogniser.empty() || !m.real.dataset.empty() || !options.generated.empty() ||
                         !options.generate.generator.empty() || !m.single_recogniser.empty();
    if (features && motions)
        throw Error(
            "score takes either --real-features and --generated-features, or motions with a recogniser");
    if (features && (f.real.empty() || f.generated.empty()))
        throw Error("score takes --real-features and --generated-features together");
    if (features) return true;
    if ((m.recogniser.empty() && m.single_recogniser.empty()) || m.real.dataset.empty())
        throw Error(
            "score takes --recogniser, --real and --generated, or two features files (see actformer score "
            "--help)");
    if (options.generated.empty() == options.generate.generator.empty())
        throw Error(
            "score takes either --generated, motions that are there, or --generator, whose motions it makes");
    return false;
}

/// What the options ask for, with the sets of motions.
eval::ScoreMotions prepared(const ScoreOptions& options, const eval::GenerateSets& generate,
                            const fs::path& work) {
    auto request = options.motions;
    request.work = work;
    request.options = options.scorer();
    request.real.dataset = ingest::one_dataset_at(request.real.dataset);
    eval::MotionsFileOptions files{options.frames, request.real.batch, {}};
    if (!options.labels.empty())
        files.labels =
            eval::read_labels_file(options.labels, ingest::Dataset(request.real.dataset).header().classes);
    for (const auto& path : options.generated) request.generated.push_back(eval::motions_in(path, files));
    if (options.generate.generator.empty()) return request;
    if (!generate) throw Error("score --generator: this program has no libtorch; see docs/installing.md");
    auto wanted = options.generate;
    wanted.labels = labels_to_generate(request.real);
    if (options.as_actor()) ask_as_actor(options, request.real, wanted);
    wanted.seed = options.seed;
    wanted.frames = options.frames;
    request.generated = generate(wanted);
    return request;
}

std::string value_text(const eval::Metric& metric, double value) {
    return metric.unit == "%" ? fmt::format("{:.2f}", metric.scale * value)
                              : fmt::format("{:#.4g}", metric.scale * value);
}

/// Empty of distances, which real motions have from others alone.
std::string of_real(const eval::Metric& metric, const nlohmann::ordered_json& real) {
    const auto found = real.find(metric.name);
    return found != real.end() && found->is_number() ? value_text(metric, found->get<double>()) : "";
}

void print_metrics(const eval::ScoreReport& report, const nlohmann::ordered_json& real) {
    say("{:<18}{:>22}{:>10}{:>20}\n", "", "generated", "real", "real against real");
    for (const auto& metric : eval::metrics()) {
        const auto got = summary(report, metric);
        if (!got) continue;
        auto text = value_text(metric, got->mean);
        if (got->half_width) text += " ± " + value_text(metric, *got->half_width);
        const auto floor = report.floor ? value_of(report.floor->score, metric) : std::nullopt;
        say("{:<18}{:>22}{:>10}{:>20}   {}\n", heading_with_unit(metric), text, of_real(metric, real),
            floor ? value_text(metric, *floor) : "-", describe(metric.direction));
    }
}

void print_classes(const nlohmann::ordered_json& classes) {
    const auto cell = [](const nlohmann::ordered_json& value, double scale) {
        return value.is_null() ? std::string("-") : fmt::format("{:#.4g}", scale * value.get<double>());
    };
    say("\n{:<28}{:>8}{:>11}{:>12}{:>10}{:>10}\n", "class", "real", "generated", "accuracy %", "FID", "FIDa");
    for (const auto& c : classes)
        say("{:<28.27}{:>8}{:>11}{:>12}{:>10}{:>10}\n", c["class"].get<std::string>(),
            c["real"].get<std::size_t>(), c["generated"].get<std::size_t>(), cell(c["accuracy"], 100),
            cell(c["fid"], 1), cell(c["fida"], 1));
}

void print_text(const eval::Scored& scored) {
    const auto& report = scored.report;
    const auto& real = scored.json["real"];
    say("{} of {}, {}; {}\n", counted(report.repeats.size(), "repeat"),
        counted(report.classes.size(), "class"), counted(real["samples"].get<std::uint64_t>(), "real sample"),
        report.real_accuracy
            ? fmt::format("the recogniser is right on {:.1f} % of the real ones", 100 * *report.real_accuracy)
            : "no recogniser tells their classes");
    print_metrics(report, real);
    if (report.classes.size() <= 30) print_classes(scored.json["per_class"]);
    if (!report.warnings.empty()) say("\n");
    for (const auto& warning : report.warnings) say("warning: {}\n", warning);
}

eval::Scored scored_by(const ScoreOptions& options, const eval::GenerateSets& generate,
                       const fs::path& work) {
    if (from_features(options)) {
        auto request = options.features;
        request.options = options.scorer();
        return eval::score_features(request);
    }
    const auto request = prepared(options, generate, work);
    kernels::Device device(options.device);
    Progress progress("score", "sequences", options.json);
    auto scored = eval::score_motions(request, device, [&](std::uint64_t done, std::uint64_t all) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    });
    progress.clear();
    return scored;
}

/// Options that change nothing in what is asked for.
void refuse_without_effect(const CLI::App& command, const ScoreOptions& options) {
    const bool of_features = from_features(options);
    if (of_features)
        refuse_given(command,
                     {"--keep-features", "--window", "--frames", "--split", "--labels", "--initial-noise",
                      "--repeats", "--per-class", "--generate-on", "--device", "--batch"},
                     "features are scored as they are");
    else if (options.generate.generator.empty())
        refuse_given(command, {"--repeats", "--per-class", "--generate-on"},
                     "is for --generator; the motions of --generated are there");
    else
        refuse_given(command, {"--labels"}, "is for --generated; what --generator makes has labels");
    if (!of_features && options.motions.recogniser.empty())
        refuse_given(command, {"--kid", "--fid-infinity", "--initial-noise"},
                     "takes a --recogniser that sees all persons; --single-recogniser alone gives FIDa");
}

/// The same file again is no second repeat.
void refuse_repeats_given_twice(const ScoreOptions& options) {
    const auto refuse = [](const char* option, const std::vector<fs::path>& files) {
        if (const auto again = reports::given_twice(files))
            throw Error("{}: {} is given twice; each file is a repeat", option, again->string());
    };
    refuse("--generated", options.generated);
    refuse("--generated-features", options.features.generated);
}

bool are_own_scores(std::string_view bytes) {
    const auto scores = nlohmann::json::parse(bytes);
    return scores.contains("per_class") && scores.contains("provenance");
}

/// Features that are kept may not take the place of motions, which are called generated.h5 as well.
void refuse_foreign_outputs(const ScoreOptions& options) {
    ingest::refuse_foreign(options.out, "scores", are_own_scores);
    if (options.motions.keep.empty()) return;
    for (const auto* name : {"real.h5", "generated.h5"}) {
        const auto path = options.motions.keep / name;
        ingest::refuse_foreign(path, "features",
                               [&](std::string_view) { return eval::is_own_features(path); });
    }
}

void run(const ScoreOptions& options, const eval::GenerateSets& generate) {
    if (options.samples > 0 && (!options.as_actor() || options.generate.generator.empty()))
        throw Error("--samples is for --protocol actor with --generator; --per-class is for the others");
    if (!options.out.empty()) check_output(options.out);
    if (!options.force) refuse_foreign_outputs(options);
    WorkFolder work(options.out);
    const auto scored = scored_by(options, generate, work.path());
    for (const auto& note : scored.notes) remark("{}\n", note);
    if (!options.out.empty()) write_whole(options.out, with_checksum(scored.json).dump(2) + "\n");
    work.done();
    if (options.json)
        say_json(scored.json);
    else
        print_text(scored);
}

void add_generator_options(CLI::App* command, ScoreOptions& options) {
    auto& generate = options.generate;
    command
        ->add_option("--generator", generate.generator,
                     "Folder of a generator's training, or its weights: its motions are made")
        ->type_name("RUN|WEIGHTS.h5");
    command->add_option("--repeats", generate.sets, "Seeds that the generator is scored with")
        ->check(CLI::Range(1, 10'000))
        ->capture_default_str();
    command->add_option("--per-class", generate.per_class, "Motions that the generator makes of a class")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command->add_option("--generate-on", generate.device,
                        "Where libtorch generates: cpu, cuda or cuda:N (default: cpu)");
}

void add_motion_options(CLI::App* command, ScoreOptions& options) {
    auto& request = options.motions;
    command->add_option("--recogniser", request.recogniser, "Folder of its training, or its weights")
        ->type_name("RUN|WEIGHTS.h5");
    command
        ->add_option(
            "--single-recogniser", request.single_recogniser,
            "One-person recogniser, for FIDa of motions of several persons; alone, nothing else is measured")
        ->type_name("RUN|WEIGHTS.h5");
    command
        ->add_option(
            "--initial-noise", request.initial_noise,
            "Seed of the states that a GRU recogniser begins with, as published (default: they begin at 0)")
        ->type_name("SEED");
    command->add_option("--real", request.real.dataset, "Dataset of real clips")->type_name("DATASET");
    command->add_option("--split", request.real.split, "Split of the dataset")->capture_default_str();
    command->add_option("--generated", options.generated, "Motions to score, each file a repeat")
        ->type_name("MOTIONS.h5");
    command
        ->add_option("--labels", options.labels,
                     "Lines of a motion's name and its action, where neither its attribute `label` nor its "
                     "name (A001_0) tells it")
        ->type_name("FILE");
    add_generator_options(command, options);
    command->add_option("--window", request.real.window, "Frames of the windows that real clips are cut into")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command->add_option("--frames", options.frames, "Take the first N frames of every motion (default: all)")
        ->check(CLI::Range(1, 1'000'000));
    command->add_option("--batch", request.real.batch, "Sequences handed to the device together")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    add_device_option(command, options.device);
}

}  // namespace

void add_score(CLI::App& app, const eval::GenerateSets& generate) {
    auto options = std::make_shared<ScoreOptions>();
    auto* command =
        app.add_subcommand("score", "Accuracy, FIDs, diversity of generated motions beside real ones");
    add_motion_options(command, *options);
    command
        ->add_option("--real-features", options->features.real,
                     "Features of the real side, with labels, in place of recogniser and dataset")
        ->type_name("FEATURES.h5");
    command
        ->add_option("--generated-features", options->features.generated,
                     "Features of the generated side, with labels, each file a repeat")
        ->type_name("FEATURES.h5");
    command
        ->add_option("--protocol", options->protocol,
                     "How a paper's tables are measured: actformer, or actor (a motion for every real "
                     "window, 20 seeds, "
                     "accuracy over all motions, 1.96 s / sqrt(n))")
        ->check(CLI::IsMember({"actformer", "actor"}))
        ->capture_default_str();
    command
        ->add_option("--samples", options->samples,
                     "Most motions that ACTOR's protocol makes (default: 3000; MDM's copy of it: 1000)")
        ->check(CLI::Range(2, 1'000'000));
    command->add_flag("--kid", options->kid, "Kernel inception distance too, exact over all pairs");
    command->add_flag("--fid-infinity", options->fid_infinity,
                      "FIDs without the bias of few samples too, extrapolated from subsets");
    command->add_option("--seed", options->seed, "Seed of the first repeat, and of all random draws")
        ->capture_default_str();
    command
        ->add_option("--keep-features", options->motions.keep,
                     "Folder to leave the features of both sides in")
        ->type_name("DIR");
    command->add_option("-o,--out", options->out, "Scores as JSON; interrupted, it goes on where it was")
        ->type_name("SCORES.json")
        ->check(ends_in(".json"));
    add_force_option(command, options->force);
    command->add_flag("--json", options->json, "Print JSON");
    examples(
        command,
        "  actformer score --recogniser recogniser --real ntu/ntu-1p --split xsub/train --generated "
        "motions.h5\n"
        "  actformer score --recogniser recogniser --real ntu/ntu-1p --split xsub/train --generator run "
        "--repeats 20 -o scores.json\n"
        "  actformer score --recogniser recogniser --real uestc --split test --generator run --protocol "
        "actor "
        "--samples 1000\n"
        "  actformer score --recogniser recogniser --real ntu/ntu-1p --generator run --kid --fid-infinity\n"
        "  actformer score --single-recogniser ntu15 --real gta-3p --generator run\n"
        "  actformer score --real-features real.h5 --generated-features generated.h5\n"
        "Real clips are cut into windows; their features are kept in $XDG_CACHE_HOME/actformer/features "
        "(or ~/.cache), so that the next scoring starts at once.\n"
        "Of several repeats the mean is given with the half-width of its 95 % interval, t s / sqrt(n); "
        "ACTOR's takes 1.96 "
        "for t.\n");
    command->callback([options, generate, command] {
        options->repeats_given = command->count("--repeats") > 0;
        options->per_class_given = command->count("--per-class") > 0;
        refuse_without_effect(*command, *options);
        refuse_repeats_given_twice(*options);
        run(*options, generate);
    });
}

void add_score(CLI::App& app) {
    add_score(app, {});
}

}  // namespace actformer::cli
