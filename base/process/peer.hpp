// Other programs that benchmarks compare this one with.
#pragma once

#include <optional>
#include <string>

namespace actformer {

/// All that a shell command prints on standard output; nothing where it fails. Its standard error is ours.
std::optional<std::string> output_of(const std::string& line);

}  // namespace actformer
