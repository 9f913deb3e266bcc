// Other programs that benchmarks compare this one with.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace actformer {

/// All that command[0], run with the arguments that follow and with `more` in its environment, prints on standard output; nothing
/// where it fails. Its standard error is ours.
std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const std::map<std::string, std::string>& more = {});

}  // namespace actformer
