#include "base/files/lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.hpp"

namespace actformer {
namespace {

int open_lock(const std::filesystem::path& path) {
    return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& path) : file_(open_lock(path)) {
    while (file_ >= 0 && ::flock(file_, LOCK_EX) != 0 && errno == EINTR) {
    }
}

std::optional<FileLock> FileLock::if_free(const std::filesystem::path& path) {
    FileLock lock;
    lock.file_ = open_lock(path);
    if (lock.file_ < 0) throw Error("{}: cannot be made or written: {}", path.string(), std::strerror(errno));
    if (::flock(lock.file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return {};
    return lock;
}

bool FileLock::is_held(const std::filesystem::path& path) {
    FileLock lock;
    lock.file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    return lock.file_ >= 0 && ::flock(lock.file_, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

FileLock::~FileLock() {
    if (file_ >= 0) ::close(file_);
}

FileLock::FileLock(FileLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
}

}  // namespace actformer
