#include "base/process/peer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/files/descriptor.hpp"
#include "base/process/child.hpp"

namespace actformer {
namespace {

struct Pipe {
    Pipe() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw Error("no pipe can be made: {}", std::strerror(errno));
        from = Descriptor(ends[0]);
        to = Descriptor(ends[1]);
    }
    Descriptor from, to;
};

}  // namespace

std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const std::map<std::string, std::string>& more) {
    Pipe pipe;
    Child child(command, pipe.to.get(), STDERR_FILENO, more);
    pipe.to.close();
    std::string said;
    std::array<char, 4096> piece;
    for (;;) {
        const auto got = ::read(pipe.from.get(), piece.data(), piece.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        said.append(piece.data(), static_cast<std::size_t>(got));
    }
    if (child.wait() != 0) return {};
    return said;
}

}  // namespace actformer
