// actformer train: trains a model of a configuration in a run folder.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "kernels/error.hpp"
#include "model/recogniser_trainer.hpp"

namespace actformer::cli {
namespace {

struct Options {
    std::string config, data, run;
    std::vector<std::string> overrides;
    bool json = false;
};

void print_epoch(const model::EpochReport& report, std::uint64_t epochs) {
    fmt::print(stderr, "epoch {:>3} of {}  rate {:<7g} loss {:.4f}  trained {:5.1f} %", report.epoch, epochs,
               report.rate, report.loss, 100 * report.train_accuracy);
    if (report.scored)
        fmt::print(stderr, "  test {:5.1f} %{}", 100 * report.class_accuracy,
                   report.best ? " best" : "     ");
    fmt::print(stderr, "  {:.0f} windows/s, {}\n", report.windows_a_second, duration(report.seconds));
}

nlohmann::ordered_json to_json(const model::TrainingResult& result) {
    nlohmann::ordered_json json{{"epochs", result.epochs}, {"weights", result.last_weights.string()}};
    if (result.best_epoch > 0) {
        json["best_epoch"] = result.best_epoch;
        json["best_weights"] = result.best_weights.string();
        json["best_class_accuracy"] = result.best_class_accuracy;
        json["class_accuracy"] = result.confusion.mean_class_accuracy();
        json["sample_accuracy"] = result.confusion.sample_accuracy();
        json["classes"] = result.classes;
        json["confusion"] = result.confusion.rows();
    }
    return json;
}

void print_text(const model::TrainingResult& result, const std::string& split) {
    if (result.confusion.samples() > 0)
        fmt::print(
            "{}accuracy on {}: {:.2f} %, the mean over classes of the windows recognised ({:.2f} % of all "
            "{})\n",
            result.confusion.table(result.classes), split, 100 * result.confusion.mean_class_accuracy(),
            100 * result.confusion.sample_accuracy(), result.confusion.samples());
    fmt::print("{}: after epoch {}\n", result.last_weights.string(), result.epochs);
    if (result.best_epoch > 0)
        fmt::print("{}: after epoch {}, {:.2f} %\n", result.best_weights.string(), result.best_epoch,
                   100 * result.best_class_accuracy);
}

void run(const Options& options) {
    auto config = model::recogniser_config();
    config.load(options.config);
    for (const auto& assignment : options.overrides) config.override_with(assignment);
    if (!options.data.empty()) config.override_with("data=" + options.data);
    const auto epochs = config.get<std::int64_t>("epochs");

    Progress progress("train", "windows");
    model::TrainingEvents events;
    events.progress = [&](double fraction, std::uint64_t windows) { progress.update(fraction, windows); };
    events.note = [&](const std::string& line) {
        progress.clear();
        fmt::print(stderr, "{}\n", line);
    };
    events.epoch = [&](const model::EpochReport& report) {
        progress.clear();
        print_epoch(report, static_cast<std::uint64_t>(epochs));
    };
    const auto result = model::train_recogniser(config, options.run, events);
    progress.clear();
    if (options.json)
        fmt::print("{}\n", to_json(result).dump(2));
    else
        print_text(result, config.get<std::string>("test_split"));
}

}  // namespace

void add_train(CLI::App& app) {
    auto* train = app.add_subcommand("train", "Train a model; started again, it goes on where it was");
    train->require_subcommand(1);
    auto options = std::make_shared<Options>();
    auto* command = train->add_subcommand("recogniser", "Train the ST-GCN action recogniser");
    command->add_option("-c,--config", options->config, "Configuration, as in model/configs")
        ->required()
        ->type_name("CONFIG.yaml");
    command->add_option("--data", options->data, "Dataset folder, before the configuration's data:")
        ->type_name("DATASET");
    command->add_option("-o,--out", options->run, "Folder of this training")->required()->type_name("RUN");
    command->add_option("overrides", options->overrides, "As in batch=32, before the configuration's")
        ->type_name("KEY=VALUE");
    command->add_flag("--json", options->json, "Print the result as JSON");
    examples(command,
             "  actformer train recogniser -c model/configs/recogniser-ntu-1p.yaml --data ntu/ntu-1p -o "
             "recogniser\n"
             "  actformer train recogniser -c model/configs/recogniser-small.yaml --data bnr10 -o small "
             "train_split=xstyle/test test_split=xstyle/train epochs=10\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
