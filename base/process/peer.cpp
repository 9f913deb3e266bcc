#include "base/process/peer.hpp"

#include <unistd.h>

#include "base/process/child.hpp"
#include "base/process/pipe.hpp"

namespace actformer {

std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const std::map<std::string, std::string>& more) {
    Pipe pipe;
    Child child(command, pipe.to.get(), STDERR_FILENO, more);
    auto said = pipe.read_all();
    if (child.wait() != 0) return {};
    return said;
}

}  // namespace actformer
