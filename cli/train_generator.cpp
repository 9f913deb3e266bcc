// actformer train generator: trains ActFormer in a run folder.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/training_options.hpp"
#include "model/generators/actformer/gan_settings.hpp"
#include "model/generators/actformer/generator_trainer.hpp"

namespace actformer::cli {
namespace {

struct Options : TrainingOptions {
    bool data_parallel = false;
};

void print_epoch(const model::GeneratorEpoch& report, std::int64_t epochs) {
    fmt::print(
        stderr,
        "epoch {:>4} of {}  step {:>6}  D {:7.4f}  G {:7.4f}  real {:+.2f} made {:+.2f}  {:.2f} steps/s\n",
        report.epoch, epochs, report.step, report.discriminator_loss, report.generator_loss,
        report.real_score, report.made_score, report.steps_a_second);
}

std::string text_of(const model::GeneratorScores& scores) {
    return fmt::format("recognised {:.1f} %  FIDw {:.2f}  FIDm {}", 100 * scores.accuracy, scores.fid_whole,
                       scores.fid_mean ? fmt::format("{:.2f}", *scores.fid_mean) : "-");
}

nlohmann::ordered_json to_json(const model::GeneratorScores& scores) {
    return {{"epoch", scores.epoch},
            {"step", scores.step},
            {"accuracy", scores.accuracy},
            {"fid_whole", scores.fid_whole},
            {"fid_mean", scores.fid_mean ? nlohmann::ordered_json(*scores.fid_mean) : nullptr}};
}

void print_json(const model::GeneratorResult& result) {
    nlohmann::ordered_json json{
        {"epochs", result.epochs}, {"steps", result.steps}, {"weights", result.weights.string()}};
    if (!result.average_weights.empty()) json["average_weights"] = result.average_weights.string();
    if (result.real_accuracy) json["real_accuracy"] = *result.real_accuracy;
    if (result.last) json["last"] = to_json(*result.last);
    if (result.best) {
        json["best_weights"] = result.best_weights.string();
        json["best"] = to_json(*result.best);
    }
    fmt::print("{}\n", json.dump(2));
}

void print_text(const model::GeneratorResult& result) {
    fmt::print("{}: after epoch {}, step {}\n", result.weights.string(), result.epochs, result.steps);
    if (!result.average_weights.empty())
        fmt::print("{}: means over the last steps\n", result.average_weights.string());
    if (result.best)
        fmt::print("{}: after epoch {}: {} (of real windows {:.1f} %)\n", result.best_weights.string(),
                   result.best->epoch, text_of(*result.best), 100 * result.real_accuracy.value_or(0));
}

void run(const Options& options) {
    const auto config = options.read(model::generator_config());
    const auto epochs = config.get<std::int64_t>("epochs");
    Progress progress("train", "steps");
    model::GeneratorEvents events;
    events.progress = [&](double fraction, std::uint64_t steps) { progress.update(fraction, steps); };
    events.note = [&](const std::string& line) {
        progress.clear();
        fmt::print(stderr, "{}\n", line);
    };
    events.epoch = [&](const model::GeneratorEpoch& report) {
        progress.clear();
        print_epoch(report, epochs);
    };
    events.scores = [&](const model::GeneratorScores& scores) {
        progress.clear();
        fmt::print(stderr, "epoch {:>4}: {}{}\n", scores.epoch, text_of(scores), scores.best ? "  best" : "");
    };
    const auto result = model::train_generator(config, options.run, options.data_parallel, events);
    progress.clear();
    if (result.weights.empty()) return;  // another process writes and tells
    options.json ? print_json(result) : print_text(result);
}

}  // namespace

void add_train_generator(CLI::App& train) {
    auto options = std::make_shared<Options>();
    auto* command = train.add_subcommand("generator", "Train ActFormer to generate motions of given classes");
    add_training_options(command, *options);
    command->add_flag("--data-parallel", options->data_parallel,
                      "As one of the processes that torchrun, mpirun or srun started");
    examples(
        command,
        "  actformer train generator -c model/configs/actformer-small.yaml --data ntu/ntu-1p -o generator\n"
        "  actformer train generator -c model/configs/actformer-ntu-2p.yaml --data ntu/ntu-2p -o generator "
        "recogniser=recogniser device=cuda bf16=true\n"
        "  torchrun --no_python --nproc_per_node 2 actformer train generator -c "
        "model/configs/actformer-small.yaml --data ntu/ntu-1p -o generator --data-parallel\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
