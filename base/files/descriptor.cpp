#include "base/files/descriptor.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"

namespace actformer {

Descriptor::Descriptor(const std::filesystem::path& path, int flags)
    : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}

bool Descriptor::close() {
    const int fd = std::exchange(fd_, -1);
    return fd < 0 || ::close(fd) == 0;
}

std::string reason() {
    return std::strerror(errno);
}

std::size_t read_fully(int fd, char* to, std::size_t size, const std::filesystem::path& path) {
    std::size_t done = 0;
    while (done < size) {
        const auto got = ::read(fd, to + done, size - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw Error("{}: cannot be read: {}", path.string(), reason());
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

bool write_fully(int fd, std::string_view bytes) {
    while (!bytes.empty()) {
        const auto put = ::write(fd, bytes.data(), bytes.size());
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(put));
    }
    return true;
}

}  // namespace actformer
