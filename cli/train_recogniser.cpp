// actformer train recogniser: trains an ST-GCN or a GRU classifier in a run folder.
#include "model/recognisers/train_recogniser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "cli/training_options.hpp"
#include "model/generators/method.hpp"

namespace actformer::cli {
namespace {

nlohmann::ordered_json to_json(const model::RecogniserResult& result) {
    const auto& training = result.training;
    nlohmann::ordered_json json{{"epochs", training.epochs}, {"weights", training.weights.string()}};
    if (training.best) {
        json["best_epoch"] = training.best->epoch;
        json["best_weights"] = training.best_weights.string();
        json["best_class_accuracy"] = training.best->values.at("class_accuracy");
        json["class_accuracy"] = result.confusion.mean_class_accuracy();
        json["sample_accuracy"] = result.confusion.sample_accuracy();
        json["classes"] = result.classes;
        json["confusion"] = result.confusion.rows();
    }
    return json;
}

void print_text(const model::RecogniserResult& result, const std::string& split) {
    const auto& training = result.training;
    if (result.confusion.samples() > 0) {
        std::istringstream table(result.confusion.table(result.classes));
        for (std::string line; std::getline(table, line);) say("{}\n", line);
        say("accuracy on {}: {:.2f} %, the mean over classes of the windows recognised ({:.2f} % of all "
            "{})\n",
            split, 100 * result.confusion.mean_class_accuracy(), 100 * result.confusion.sample_accuracy(),
            result.confusion.samples());
    }
    say("{}: after epoch {}\n", training.weights.string(), training.epochs);
    if (training.best)
        say("{}: after epoch {}, {:.2f} %\n", training.best_weights.string(), training.best->epoch,
            100 * training.best->values.at("class_accuracy").get<double>());
}

void refuse_generators(const std::string& config) {
    const auto named = model::model_named_in(config);
    if (named == "generator" || std::ranges::count(model::methods(), named, &model::Method::name) > 0)
        throw Error(
            "{}: a generator's configuration, as `model: {}` says; `actformer train generator` takes it",
            config, named);
}

void run(const TrainingOptions& options) {
    refuse_generators(options.config);
    const auto config = options.read(model::recogniser_config(model::recogniser_kind_in(options.config)));
    TrainingDisplay display(config.get<std::int64_t>("epochs"));
    const auto result = model::train_recogniser(config, options.run, display.events());
    display.clear();
    if (options.json)
        say_json(to_json(result));
    else
        print_text(result, config.get<std::string>("test_split"));
}

}  // namespace

void add_train_recogniser(CLI::App& train) {
    auto options = std::make_shared<TrainingOptions>();
    auto* command = train.add_subcommand(
        "recogniser",
        "Train an action recogniser: ST-GCN, or with model: gru Action2Motion's GRU classifier");
    add_training_options(command, *options);
    examples(command,
             "  actformer train recogniser -c recogniser-ntu-1p --data ntu/ntu-1p -o "
             "recogniser\n"
             "  actformer train recogniser -c recogniser-small --data bnr10 -o small "
             "train_split=xstyle/test test_split=xstyle/train epochs=10\n"
             "  actformer train recogniser -c recogniser-gru --data humanact12 -o gru\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
