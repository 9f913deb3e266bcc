// Trainings and generations of the tests in a process that has loaded libtorch already: that takes a second of processor time, as long as
// all else that a small one does.
#pragma once

#include <optional>
#include <string>

#include "tests/support/command_result.hpp"

namespace actformer::test {

/// What `actformer ARGUMENTS` does, by the library that the program actformer-train opens. None where another program does it, where a
/// shell must read the words, or where there is no such library.
std::optional<CommandResult> run_in_warm_training(const std::string& arguments);

}  // namespace actformer::test
