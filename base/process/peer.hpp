// Other programs, run beside this one to be compared with it.
#pragma once

#include <optional>
#include <string>

namespace actformer {

/// All that a shell's command line prints, once it has ended; nothing where it fails. Its complaints go where ours go.
std::optional<std::string> output_of(const std::string& line);

}  // namespace actformer
