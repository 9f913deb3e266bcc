// actformer train: trains a model of a configuration in a run folder.
#include "cli/commands.hpp"

namespace actformer::cli {

void add_train(CLI::App& app) {
    auto* train = app.add_subcommand("train", "Train a model; started again, it goes on where it was");
    train->require_subcommand(1);
    add_check_trainings(*train);
    add_train_recogniser(*train);
    add_train_generator(*train);
}

}  // namespace actformer::cli
