// actformer train generator: trains a generator of any method in a run folder.
#include "model/generators/train_generator.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "cli/training_options.hpp"
#include "model/generators/method.hpp"

namespace actformer::cli {
namespace {

struct TrainGeneratorOptions : TrainingOptions {
    bool data_parallel = false;
};

nlohmann::ordered_json to_json(const model::ValidationReport& scores) {
    nlohmann::ordered_json json{{"epoch", scores.epoch}, {"step", scores.step}};
    json.update(scores.values);
    return json;
}

void print_json(const model::TrainingResult& result) {
    nlohmann::ordered_json json{
        {"epochs", result.epochs}, {"steps", result.steps}, {"weights", result.weights.string()}};
    if (!result.average_weights.empty()) json["average_weights"] = result.average_weights.string();
    if (result.last) json["last"] = to_json(*result.last);
    if (result.best) {
        json["real_accuracy"] = result.best->values.at("real_accuracy");
        json["best_weights"] = result.best_weights.string();
        json["best"] = to_json(*result.best);
    }
    say_json(json);
}

void print_text(const model::TrainingResult& result) {
    say("{}: after epoch {}, step {}\n", result.weights.string(), result.epochs, result.steps);
    if (!result.average_weights.empty())
        say("{}: the weights' moving average (EMA)\n", result.average_weights.string());
    if (result.best)
        say("{}: after epoch {}: {}\n", result.best_weights.string(), result.best->epoch,
            text_of(result.best->values));
}

void run(const TrainGeneratorOptions& options) {
    const auto config = options.read(model::read_generator_config(options.config));
    TrainingDisplay display(config.get<std::int64_t>("epochs"));
    const auto result = model::train_generator(config, options.run, options.data_parallel, display.events());
    display.clear();
    if (result.weights.empty()) return;  // another process writes and tells
    options.json ? print_json(result) : print_text(result);
}

std::string methods_named() {
    std::string lines = "Methods, as in the configuration's line `model: NAME`:\n";
    for (const auto& method : model::methods())
        lines += fmt::format("  {:<14} {}\n", method.name, method.title);
    return lines;
}

}  // namespace

void add_train_generator(CLI::App& train) {
    auto options = std::make_shared<TrainGeneratorOptions>();
    auto* command = train.add_subcommand("generator", "Train a method to generate motions of given classes");
    add_training_options(command, *options);
    command->add_flag("--data-parallel", options->data_parallel,
                      "Train as one of the processes that torchrun, mpirun or srun started");
    examples(command,
             "  actformer train generator -c actformer-small --data ntu/ntu-1p -o generator\n"
             "  actformer train generator -c actformer-ntu-2p --data ntu/ntu-2p -o generator "
             "recogniser=recogniser device=cuda bf16=true\n"
             "  actformer train generator -c actformer-cmu --data cmu -o generator tensorboard=true\n"
             "  torchrun --no_python --nproc_per_node 2 actformer train generator -c "
             "actformer-small --data ntu/ntu-1p -o generator --data-parallel\n" +
                 methods_named());
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
