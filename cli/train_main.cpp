#include "cli/bench.hpp"
#include "cli/program.hpp"
#include "cli/score.hpp"
#include "model/generators/generated_motions.hpp"

int main(int argc, char** argv) {
    actformer::cli::keep_freed_memory();
    return actformer::cli::run_program(argc, argv, [](CLI::App& app) {
        actformer::cli::add_train(app);
        actformer::cli::add_generate(app);
        actformer::cli::add_import(app);
        actformer::cli::add_model(app);
        actformer::cli::add_score(app, actformer::model::generated_sets);
        auto* bench =
            app.add_subcommand("bench", "Measure speed on this machine, with peers in the same run");
        bench->require_subcommand(1);
        actformer::cli::add_bench_train(*bench);
    });
}
