#include "base/files/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "base/files/aside.hpp"

namespace actformer {
namespace {

class Descriptor {
  public:
    Descriptor(const std::filesystem::path& path, int flags)
        : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }
    bool close() {
        const int fd = std::exchange(fd_, -1);
        return fd < 0 || ::close(fd) == 0;
    }

  private:
    int fd_;
};

std::string reason() {
    return std::strerror(errno);
}

/// Bytes read, fewer than `size` only at the end of the file.
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

// From here on direct writes pay: copying into the page cache costs as much processor time as parsing ten times as much text, and
// evicts that text.
constexpr std::size_t much = std::size_t{1} << 20;

/// Writes whole blocks from the front of `bytes` past the page cache and removes them from it; none where the file system
/// will not, or where there are few or they do not begin at a block. Direct writing is off when it returns.
void write_blocks_directly(int fd, std::string_view& bytes) {
    const int flags = ::fcntl(fd, F_GETFL);
    if (bytes.size() < much || reinterpret_cast<std::uintptr_t>(bytes.data()) % direct_block != 0 ||
        ::fcntl(fd, F_SETFL, flags | O_DIRECT) != 0)
        return;
    while (bytes.size() >= direct_block) {
        const auto put = ::write(fd, bytes.data(), bytes.size() / direct_block * direct_block);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) break;  // write_fully says why
        bytes.remove_prefix(static_cast<std::size_t>(put));
        if (static_cast<std::size_t>(put) % direct_block != 0) break;
    }
    ::fcntl(fd, F_SETFL, flags);
}

}  // namespace

std::string_view read_text(const std::filesystem::path& path, std::vector<char>& scratch,
                           std::uint64_t limit) {
    const Descriptor file(path, O_RDONLY);
    struct stat status {};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0)
        throw Error("{}: cannot be read: {}", path.string(), reason());
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > limit)
        throw Error("{}: {} MiB of text, more than the {} MiB that one clip may have", path.string(),
                    size >> 20, limit >> 20);
    if (scratch.size() < size + text_padding) scratch.resize(size + text_padding);
    const auto got = read_fully(file.get(), scratch.data(), size, path);
    std::memset(scratch.data() + got, 0, text_padding);
    return {scratch.data(), got};
}

void read_in_pieces(const std::filesystem::path& path, const std::function<void(std::string_view)>& use) {
    const Descriptor file(path, O_RDONLY);
    if (file.get() < 0) throw Error("{}: cannot be read: {}", path.string(), reason());
    std::vector<char> piece(std::size_t{1} << 20);
    while (const auto got = read_fully(file.get(), piece.data(), piece.size(), path))
        use({piece.data(), got});
}

void write_whole(const std::filesystem::path& path, std::string_view bytes) {
    Aside aside(path);
    Descriptor file(aside.partial(), O_WRONLY);
    if (file.get() >= 0) write_blocks_directly(file.get(), bytes);
    if (file.get() < 0 || !write_fully(file.get(), bytes) || !file.close())
        throw Error("{}: cannot be written: {}", path.string(), reason());
    aside.commit();
}

}  // namespace actformer
