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

}  // namespace

FileLock::FileLock(const std::filesystem::path& path) : file_(open_lock(path)) {
    while (file_.get() >= 0 && ::flock(file_.get(), LOCK_EX) != 0 && errno == EINTR) {
    }
}

std::optional<FileLock> FileLock::if_free(const std::filesystem::path& path) {
    FileLock lock;
    lock.file_ = open_lock(path);
    if (lock.file_.get() < 0)
        throw Error("{}: cannot be made or written: {}", path.string(), std::strerror(errno));
    if (::flock(lock.file_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return {};
    return lock;
}

std::optional<FileLock> FileLock::on_folder_if_free(const std::filesystem::path& folder) {
    for (;;) {  // whoever held it last may have removed the folder in between
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error) throw Error("{}: no folder can be made there: {}", folder.string(), error.message());
        FileLock lock;
        lock.file_ = Descriptor(folder, O_RDONLY | O_DIRECTORY);
        if (lock.file_.get() >= 0 && ::flock(lock.file_.get(), LOCK_EX | LOCK_NB) != 0 &&
            errno == EWOULDBLOCK)
            return {};
        struct stat held {
        }, named{};
        if (lock.file_.get() < 0 || ::fstat(lock.file_.get(), &held) != 0)
            throw Error("{}: cannot be opened: {}", folder.string(), std::strerror(errno));
        if (::stat(folder.c_str(), &named) == 0 && held.st_dev == named.st_dev && held.st_ino == named.st_ino)
            return lock;
    }
}

bool FileLock::is_held(const std::filesystem::path& path) {
    FileLock lock;
    lock.file_ = Descriptor(path, O_RDONLY | O_NONBLOCK | O_NOFOLLOW);  // a FIFO or link is no lock
    return lock.file_.get() >= 0 && ::flock(lock.file_.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace actformer
