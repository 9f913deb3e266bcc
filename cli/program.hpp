// What every program of actformer's shares: parsing, and one line for whatever goes wrong.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/commands.hpp"

namespace actformer::cli {

/// Work goes batch by batch in buffers of the same sizes. Giving them back to the system in between would cost as much in
/// page faults as a good part of the work does.
void keep_freed_memory();

/// Why a command would refuse the words, the program's name first; empty where it takes them. Runs nothing.
std::string problem_of(std::vector<std::string> words, const std::function<void(CLI::App&)>& add_commands);

/// Parses and runs `actformer` with the commands that `add_commands` gives it. Exit code 0, or 1 with one line on
/// standard error, or 128 + the signal that ended it.
int run_program(int argc, char** argv, const std::function<void(CLI::App&)>& add_commands);

}  // namespace actformer::cli
