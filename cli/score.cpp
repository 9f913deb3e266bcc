// actformer score: what generated motions are worth beside real ones.
#include "eval/scoring/score.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <set>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/scratch.hpp"
#include "base/process/process.hpp"
#include "cli/commands.hpp"
#include "cli/format.hpp"
#include "cli/progress.hpp"
#include "eval/scoring/labels_file.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    eval::ScoreRequest request;
    std::vector<fs::path> generated;
    fs::path generator, labels, out;
    std::string program, device, generate_on;
    std::size_t repeats = 1, per_class = 100;
    std::uint64_t seed = 0;
    bool json = false;
};

/// Where features and motions are put while they are needed: beside the output, so that scoring goes on where it was, else
/// in a temporary folder. Gone when scoring has ended well, the temporary one in any case.
class WorkFolder {
  public:
    explicit WorkFolder(const fs::path& out) {
        if (out.empty()) {
            path_ = temporary_.emplace("score").path();
            return;
        }
        path_ = out.string() + ".work";
        std::error_code error;
        fs::create_directories(path_, error);
        if (error) throw Error("{}: no folder can be made there: {}", path_.string(), error.message());
    }
    ~WorkFolder() {
        std::error_code ignored;
        if (!temporary_) fs::remove(path_, ignored);  // where nothing is in it yet
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const fs::path& path() const { return path_; }
    void done() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }

  private:
    std::optional<Scratch> temporary_;
    fs::path path_;
};

/// Of a generator's weights, or of all files of its folder that decide what it generates.
std::string fingerprint_of(const fs::path& run) {
    if (!fs::is_directory(run))
        throw Error("{}: no such folder; --generator names the folder of a generator's training",
                    run.string());
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(run)) {
        const auto extension = entry.path().extension();
        if (entry.is_regular_file() && (extension == ".h5" || extension == ".pt" || extension == ".yaml"))
            files[entry.path().filename().string()] = checksum_file(entry.path());
    }
    Checksum all;
    for (const auto& [name, sum] : files) all.add(name + "|" + sum + "|");
    return all.hex();
}

/// Numbers from 1 of the classes that the real side has, where these are not all: no others can be scored.
std::string classes_to_generate(const eval::ScoreRequest& request) {
    const ingest::Dataset dataset(request.real);
    std::set<std::uint32_t> labels;
    for (const auto clip : dataset.split(request.split)) labels.insert(dataset.clips()[clip].label);
    if (labels.size() == dataset.header().classes.size()) return {};
    std::string out;
    for (const auto label : labels) out += fmt::format("{}{}", out.empty() ? "" : ",", label + 1);
    return out;
}

eval::MotionSet generated_set(const Options& options, const std::string& fingerprint,
                              const std::string& classes, std::uint64_t seed, const fs::path& work) {
    eval::MotionSet set;
    set.name = fmt::format("{}, seed {}", options.generator.string(), seed);
    set.key = fmt::format("{}|{}|{}|{}", fingerprint, seed, options.per_class, classes);
    set.seed = seed;
    set.temporary = true;
    set.file = [&options, classes, seed, work] {
        const auto motions = work / fmt::format("seed-{}.h5", seed);
        std::vector<std::string> command{options.program,
                                         "generate",
                                         "--generator",
                                         options.generator.string(),
                                         "-o",
                                         motions.string(),
                                         "--seed",
                                         std::to_string(seed),
                                         "--per-class",
                                         std::to_string(options.per_class)};
        if (!classes.empty()) command.insert(command.end(), {"--classes", classes});
        if (!options.generate_on.empty()) command.insert(command.end(), {"--device", options.generate_on});
        const auto result = run_process(command, work / "generate.log");
        if (result.exit != 0)
            throw Error(
                "{}: failed: {}", command_line(command),
                result.last_line.empty() ? fmt::format("exit code {}", result.exit) : result.last_line);
        return motions;
    };
    return set;
}

void check_choice(const Options& options) {
    const auto& r = options.request;
    const bool from_features = !r.real_features.empty() || !r.generated_features.empty();
    const bool from_motions = !r.recogniser.empty() || !r.real.empty() || !options.generated.empty() ||
                              !options.generator.empty() || !r.single_recogniser.empty();
    if (from_features && from_motions)
        throw Error(
            "score takes either --real-features and --generated-features, or motions with a recogniser");
    if (from_features && (r.real_features.empty() || r.generated_features.empty()))
        throw Error("score takes --real-features and --generated-features together");
    if (from_features) return;
    if (r.recogniser.empty() || r.real.empty())
        throw Error(
            "score takes --recogniser, --real and --generated, or two features files (see actformer score "
            "--help)");
    if (options.generated.empty() == options.generator.empty())
        throw Error(
            "score takes either --generated, motions that are there, or --generator, whose motions it makes");
}

eval::ScoreRequest prepared(const Options& options, const fs::path& work) {
    auto request = options.request;
    request.work = work;
    request.options.seed = options.seed;
    if (!request.real_features.empty()) return request;
    request.recogniser = eval::weights_of(request.recogniser);
    if (!request.single_recogniser.empty())
        request.single_recogniser = eval::weights_of(request.single_recogniser);
    const auto folders = ingest::datasets_at(request.real);
    if (folders.size() != 1)
        throw Error("{}: holds {} datasets; take one at a time, as in {}", request.real.string(),
                    folders.size(), folders[0].string());
    request.real = folders[0];
    if (!options.labels.empty())
        request.labels =
            eval::read_labels_file(options.labels, ingest::Dataset(request.real).header().classes);
    for (const auto& path : options.generated) request.generated.push_back(eval::motions_in(path));
    if (options.generator.empty()) return request;
    const auto fingerprint = fingerprint_of(options.generator), classes = classes_to_generate(request);
    for (std::size_t i = 0; i < options.repeats; ++i)
        request.generated.push_back(generated_set(options, fingerprint, classes, options.seed + i, work));
    return request;
}

std::string value_text(const eval::Metric& metric, double value) {
    return metric.unit == "%" ? fmt::format("{:.2f}", metric.scale * value)
                              : fmt::format("{:.4g}", metric.scale * value);
}

void print_metrics(const eval::ScoreReport& report) {
    fmt::print("{:<16}{:>22}{:>22}\n", "", "generated", "real against real");
    for (const auto& metric : eval::metrics()) {
        const auto got = summary(report, metric);
        if (!got) continue;
        auto text = value_text(metric, got->mean);
        if (got->half_width) text += " ± " + value_text(metric, *got->half_width);
        const auto floor = report.floor ? value_of(report.floor->score, metric) : std::nullopt;
        fmt::print("{:<16}{:>22}{:>22}   {}\n", fmt::format("{} {}", metric.heading, metric.unit), text,
                   floor ? value_text(metric, *floor) : "-", describe(metric.direction));
    }
}

void print_classes(const nlohmann::ordered_json& classes) {
    const auto cell = [](const nlohmann::ordered_json& value, double scale) {
        return value.is_null() ? std::string("-") : fmt::format("{:.4g}", scale * value.get<double>());
    };
    fmt::print("\n{:<28}{:>8}{:>11}{:>12}{:>10}{:>10}\n", "class", "real", "generated", "accuracy %", "FID",
               "FIDa");
    for (const auto& c : classes)
        fmt::print("{:<28}{:>8}{:>11}{:>12}{:>10}{:>10}\n", c["class"].get<std::string>().substr(0, 27),
                   c["real"].get<std::size_t>(), c["generated"].get<std::size_t>(), cell(c["accuracy"], 100),
                   cell(c["fid"], 1), cell(c["fida"], 1));
}

void print_text(const eval::Scored& scored) {
    const auto& report = scored.report;
    const auto& real = scored.json["real"];
    fmt::print("{} of {}, {}; the recogniser is right on {} % of the real ones\n",
               counted(report.repeats.size(), "repeat"), counted(report.classes.size(), "class"),
               counted(real["samples"].get<std::uint64_t>(), "real sample"),
               report.real_accuracy ? fmt::format("{:.1f}", 100 * *report.real_accuracy) : "?");
    print_metrics(report);
    if (report.classes.size() <= 30) print_classes(scored.json["per_class"]);
    if (!report.warnings.empty()) fmt::print("\n");
    for (const auto& warning : report.warnings) fmt::print("warning: {}\n", warning);
}

void run(Options options) {
    check_choice(options);
    if (options.program.empty()) options.program = (program_folder() / "actformer").string();
    WorkFolder work(options.out);
    const auto request = prepared(options, work.path());
    std::unique_ptr<kernels::Device> device;
    Progress progress("score", "sequences", options.json);
    eval::ScoreEvents events;
    events.progress = [&](const std::string&, std::uint64_t done, std::uint64_t all) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    };
    const auto scored = eval::score(
        request,
        [&]() -> kernels::Device& {
            if (!device) device = std::make_unique<kernels::Device>(options.device);
            return *device;
        },
        events);
    progress.clear();
    if (!options.out.empty()) write_whole(options.out, scored.json.dump(2) + "\n");
    work.done();
    if (options.json)
        fmt::print("{}\n", scored.json.dump(2));
    else
        print_text(scored);
}

void add_motion_options(CLI::App* command, Options& options) {
    auto& request = options.request;
    command->add_option("--recogniser", request.recogniser, "Folder of its training, or its weights")
        ->type_name("RUN|WEIGHTS.h5");
    command
        ->add_option("--single-recogniser", request.single_recogniser,
                     "One-person recogniser, for FIDa of motions of several persons")
        ->type_name("RUN|WEIGHTS.h5");
    command->add_option("--real", request.real, "Dataset of real clips")->type_name("DATASET");
    command->add_option("--split", request.split, "Split of the dataset")->capture_default_str();
    command->add_option("--generated", options.generated, "Motions to score, each file a repeat")
        ->type_name("MOTIONS.h5");
    command
        ->add_option("--labels", options.labels,
                     "Lines of a motion's name and its action, where names do not tell it as A001_0 does")
        ->type_name("FILE");
    command
        ->add_option("--generator", options.generator,
                     "Folder of a generator's training, or its weights: its motions are made")
        ->type_name("RUN|WEIGHTS.h5");
    command->add_option("--repeats", options.repeats, "Seeds that the generator is scored with")
        ->check(CLI::Range(1, 10'000))
        ->capture_default_str();
    command->add_option("--per-class", options.per_class, "Motions that the generator makes of a class")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command->add_option("--generate-on", options.generate_on,
                        "Where libtorch generates: cpu, cuda or cuda:N (default: cpu)");
    command->add_option("--program", options.program, "The actformer that generates (default: this one)")
        ->type_name("PROGRAM");
    command->add_option("--window", request.window, "Frames of the windows that real clips are cut into")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command->add_option("--frames", request.frames, "Take the first N frames of every motion (default: all)")
        ->check(CLI::Range(1, 1'000'000));
    command->add_option("--batch", request.batch, "Sequences handed to the device together")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    command->add_option("--device", options.device, "OpenCL device: a number, gpu, cpu, or part of a name");
}

}  // namespace

void add_score(CLI::App& app) {
    auto options = std::make_shared<Options>();
    auto* command =
        app.add_subcommand("score", "Accuracy, FIDs, diversity of generated motions beside real ones");
    auto& request = options->request;
    add_motion_options(command, *options);
    command
        ->add_option("--real-features", request.real_features,
                     "Features of the real side, with labels, in place of recogniser and dataset")
        ->type_name("FEATURES.h5");
    command
        ->add_option("--generated-features", request.generated_features,
                     "Features of the generated side, with labels, each file a repeat")
        ->type_name("FEATURES.h5");
    command->add_option("--seed", options->seed, "Seed of the first repeat, and of all random draws")
        ->capture_default_str();
    command->add_option("--keep-features", request.keep, "Folder to leave the features of both sides in")
        ->type_name("DIR");
    command->add_option("-o,--out", options->out, "Scores as JSON; interrupted, it goes on where it was")
        ->type_name("SCORES.json");
    command->add_flag("--json", options->json, "Print JSON");
    examples(
        command,
        "  actformer score --recogniser recogniser --real ntu/ntu-1p --split xsub/train --generated "
        "motions.h5\n"
        "  actformer score --recogniser recogniser --real ntu/ntu-1p --split xsub/train --generator run "
        "--repeats 20 -o scores.json\n"
        "  actformer score --real-features real.h5 --generated-features generated.h5\n"
        "Real clips are cut into windows; their features are kept in $XDG_CACHE_HOME/actformer/features "
        "(or ~/.cache), so that the next scoring starts at once.\n"
        "Of several repeats the mean is given with the half-width of its 95 % interval, t s / sqrt(n).\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
