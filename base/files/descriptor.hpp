// An open file of the system, closed once.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace actformer {

class Descriptor {
  public:
    Descriptor() = default;
    explicit Descriptor(int fd) : fd_(fd) {}
    /// As open(2), and closed in programs that this one starts; get() is negative, and errno says why, where that fails.
    Descriptor(const std::filesystem::path& path, int flags);
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }

    int get() const { return fd_; }

    /// False, and errno says why, where what was written may not have arrived. True where it is closed already.
    bool close();

  private:
    int fd_ = -1;
};

/// Why the last call of the system failed, in a few words.
std::string reason();

/// Bytes read, fewer than `size` only at the end of the file. Throws Error naming `path`.
std::size_t read_fully(int fd, char* to, std::size_t size, const std::filesystem::path& path);

/// False, and errno says why, where not all of it could be written.
bool write_fully(int fd, std::string_view bytes);

}  // namespace actformer
