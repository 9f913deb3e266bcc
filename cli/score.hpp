// `score` in the program that can generate.
#pragma once

#include "cli/commands.hpp"
#include "eval/scoring/motion_source.hpp"

namespace actformer::cli {

/// `generate` makes the motions of `score --generator`.
void add_score(CLI::App& app, const eval::GenerateSets& generate);

}  // namespace actformer::cli
