#include "base/process/peer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/process/child.hpp"

namespace actformer {
namespace {

struct Pipe {
    Pipe() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw Error("no pipe can be made: {}", std::strerror(errno));
        from = ends[0];
        to = ends[1];
    }
    ~Pipe() {
        ::close(from);
        close_to();
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    void close_to() {
        if (to >= 0) ::close(to);
        to = -1;
    }
    int from = -1, to = -1;
};

}  // namespace

std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const std::map<std::string, std::string>& more) {
    Pipe pipe;
    Child child(command, pipe.to, STDERR_FILENO, more);
    pipe.close_to();
    std::string said;
    std::array<char, 4096> piece;
    for (;;) {
        const auto got = ::read(pipe.from, piece.data(), piece.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        said.append(piece.data(), static_cast<std::size_t>(got));
    }
    if (child.wait() != 0) return {};
    return said;
}

}  // namespace actformer
