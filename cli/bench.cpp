// actformer bench: how fast the program is on this machine, beside what its users had before.
#include "cli/bench.hpp"

namespace actformer::cli {

void add_bench(CLI::App& app) {
    auto* command = app.add_subcommand("bench", "Measure speed on this machine, with peers in the same run");
    command->require_subcommand(1);
    add_bench_ingest(*command);
    add_bench_features(*command);
    add_bench_score(*command);
}

}  // namespace actformer::cli
