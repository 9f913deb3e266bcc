#include "base/files/lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
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

std::optional<FileLock> FileLock::on_folder_if_free(const std::filesystem::path& folder) {
    for (;;) {  // whoever held it last may have removed the folder in between
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error) throw Error("{}: no folder can be made there: {}", folder.string(), error.message());
        FileLock lock;
        lock.file_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (lock.file_ >= 0 && ::flock(lock.file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return {};
        struct stat held {
        }, named{};
        if (lock.file_ < 0 || ::fstat(lock.file_, &held) != 0)
            throw Error("{}: cannot be opened: {}", folder.string(), std::strerror(errno));
        if (::stat(folder.c_str(), &named) == 0 && held.st_dev == named.st_dev && held.st_ino == named.st_ino)
            return lock;
    }
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
