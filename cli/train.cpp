// actformer train: trains a model of a configuration in a run folder.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "cli/progress.hpp"
#include "cli/training_options.hpp"
#include "model/recognisers/recogniser_trainer.hpp"

namespace actformer::cli {
namespace {

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

void run(const TrainingOptions& options) {
    const auto config = options.read(model::recogniser_config());
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
    auto options = std::make_shared<TrainingOptions>();
    auto* command = train->add_subcommand("recogniser", "Train the ST-GCN action recogniser");
    add_training_options(command, *options);
    examples(command,
             "  actformer train recogniser -c model/configs/recogniser-ntu-1p.yaml --data ntu/ntu-1p -o "
             "recogniser\n"
             "  actformer train recogniser -c model/configs/recogniser-small.yaml --data bnr10 -o small "
             "train_split=xstyle/test test_split=xstyle/train epochs=10\n");
    command->callback([options] { run(*options); });
    add_train_generator(*train);
}

}  // namespace actformer::cli
