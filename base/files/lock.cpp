#include "base/files/lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"

namespace actformer {
namespace {

Descriptor open_lock(const std::filesystem::path& path) {
    return {path, O_RDWR | O_CREAT | O_NOFOLLOW};
}

/// Whether the open file is the one that was `named`: whoever held it last may have removed that in between.
bool is_open(int fd, const struct stat& named) {
    struct stat held {};
    return ::fstat(fd, &held) == 0 && held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& path) : file_(open_lock(path)) {
    while (file_.get() >= 0 && ::flock(file_.get(), LOCK_EX) != 0 && errno == EINTR) {
    }
}

std::optional<FileLock> FileLock::if_free(const std::filesystem::path& path) {
    for (;;) {
        FileLock lock;
        lock.file_ = open_lock(path);
        if (lock.file_.get() < 0)
            throw Error("{}: cannot be made or written: {}", path.string(), std::strerror(errno));
        if (::flock(lock.file_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return {};
        struct stat named {};
        if (::lstat(path.c_str(), &named) == 0 && is_open(lock.file_.get(), named)) return lock;
    }
}

std::optional<FileLock> FileLock::on_folder_if_free(const std::filesystem::path& folder) {
    for (;;) {
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error) throw Error("{}: no folder can be made there: {}", folder.string(), error.message());
        FileLock lock;
        lock.file_ = Descriptor(folder, O_RDONLY | O_DIRECTORY);
        if (lock.file_.get() >= 0 && ::flock(lock.file_.get(), LOCK_EX | LOCK_NB) != 0 &&
            errno == EWOULDBLOCK)
            return {};
        if (lock.file_.get() < 0)
            throw Error("{}: cannot be opened: {}", folder.string(), std::strerror(errno));
        struct stat named {};
        if (::stat(folder.c_str(), &named) == 0 && is_open(lock.file_.get(), named)) return lock;
    }
}

bool FileLock::is_held(const std::filesystem::path& path) {
    FileLock lock;
    lock.file_ = Descriptor(path, O_RDONLY | O_NONBLOCK | O_NOFOLLOW);  // a FIFO or link is no lock
    return lock.file_.get() >= 0 && ::flock(lock.file_.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace actformer
