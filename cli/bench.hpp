// The benchmarks of `actformer bench`, one file each.
#pragma once

#include "cli/commands.hpp"

namespace actformer::cli {

void add_bench_ingest(CLI::App& bench);
void add_bench_features(CLI::App& bench);
void add_bench_score(CLI::App& bench);
void add_bench_train(CLI::App& bench);  ///< in the program of the commands over libtorch

}  // namespace actformer::cli
