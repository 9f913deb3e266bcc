#include "base/files/aside.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/files/file.hpp"

namespace actformer {
namespace {

namespace fs = std::filesystem;

constexpr int most_names = 1000;
constexpr std::size_t kept_back = std::size_t{1} << 16;  // bytes that wait for more

// From here on direct writes pay: copying into the page cache costs as much processor time as parsing ten times as much text, and
// evicts that text.
constexpr std::size_t much = std::size_t{1} << 20;

bool lock_now(int fd) {
    return ::flock(fd, LOCK_EX | LOCK_NB) == 0;
}

bool is_at(int fd, const fs::path& path) {
    struct stat open {
    }, named{};
    return ::fstat(fd, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
           open.st_ino == named.st_ino;
}

/// Removes a file whose writer is no more: nobody holds its lock. False where it is in use, or no file.
bool remove_left_behind(const fs::path& path) {
    const Descriptor old(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (old.get() < 0) return errno == ENOENT;
    struct stat status {};
    return ::fstat(old.get(), &status) == 0 && S_ISREG(status.st_mode) && lock_now(old.get()) &&
           is_at(old.get(), path) && ::unlink(path.c_str()) == 0;
}

/// A new, locked file; none where others are there, or are just taking it for one left behind. Where the file system knows no
/// locks it goes without, and nobody takes it for one left behind.
std::optional<Descriptor> created(const fs::path& path, int& error) {
    Descriptor file(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW);
    error = file.get() < 0 ? errno : 0;
    if (file.get() < 0) return {};
    if (!lock_now(file.get()) && errno == EWOULDBLOCK) return {};
    if (!is_at(file.get(), path)) return {};
    return file;
}

bool is_synced(int fd) {
    return ::fsync(fd) == 0 || errno == EINVAL || errno == ENOSYS || errno == ENOTSUP;  // it knows no sync
}

[[noreturn]] void not_written(const fs::path& path) {
    const int error = errno;
    throw Error("{}: not all of it could be written: {}; {}", path.string(), std::strerror(error),
                remedy(error));
}

}  // namespace

std::string remedy(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "free some space, or choose another place";
        case EFBIG:
            return "raise the limit of a file's size (ulimit -f)";
        default:
            return "choose another place";
    }
}

Aside::Aside(fs::path path, Sync sync) : path_(std::move(path)), output_(output_at(path_)), sync_(sync) {
    if (output_.stream)
        open_stream();
    else
        temporary_.emplace([this] { return create(); });
}

Aside::~Aside() {
    if (temporary_ && !committed_) ::unlink(temporary_->path().c_str());
}

fs::path Aside::create() {
    const auto name = [this](int i) {
        return fs::path(output_.file.string() + (i == 0 ? ".partial" : fmt::format(".partial.{}", i)));
    };
    int error = 0;
    for (int i = 0; i < most_names && (error == 0 || error == EEXIST); ++i) {
        auto file = created(name(i), error);
        if (!file && error == EEXIST && remove_left_behind(name(i))) file = created(name(i), error);
        if (!file) continue;
        file_ = std::move(*file);
        lock_ = Descriptor(::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0));
        if (lock_.get() < 0) {
            error = errno;
            ::unlink(name(i).c_str());
            break;
        }
        std::error_code ignored;  // where several writers were killed
        for (int j = i + 1; fs::exists(fs::symlink_status(name(j), ignored)) && remove_left_behind(name(j));
             ++j)
            continue;
        return name(i);
    }
    if (error == 0 || error == EEXIST)
        throw Error("{}: cannot be written: others hold {} and all names like it; remove those files",
                    path_.string(), name(0).string());
    errno = error;
    fail();
}

void Aside::open_stream() {
    file_ = Descriptor(output_.file, O_WRONLY | O_NONBLOCK | O_NOCTTY);
    if (file_.get() < 0 && errno == ENXIO)
        throw Error("{}: cannot be written: nobody reads from it; start its reader first", path_.string());
    if (file_.get() < 0 || ::fcntl(file_.get(), F_SETFL, 0) != 0) fail();
}

void Aside::write(std::string_view bytes) {
    check();
    if (buffer_.size() + bytes.size() < kept_back) {
        buffer_ += bytes;
        return;
    }
    flush();
    write_blocks_directly(bytes);
    put(bytes);
}

void Aside::put(std::string_view bytes) {
    if (!write_fully(file_.get(), bytes)) fail();
    at_ += bytes.size();
}

void Aside::flush() {
    put(buffer_);
    buffer_.clear();
}

/// Writes whole blocks from the front of `bytes` past the page cache and removes them from it; none where the file system
/// will not, or where there are few or they do not begin at a block. Direct writing is off when it returns.
void Aside::write_blocks_directly(std::string_view& bytes) {
    const int flags = ::fcntl(file_.get(), F_GETFL);
    if (bytes.size() < much || reinterpret_cast<std::uintptr_t>(bytes.data()) % direct_block != 0 ||
        at_ % direct_block != 0 || output_.stream || ::fcntl(file_.get(), F_SETFL, flags | O_DIRECT) != 0)
        return;
    while (bytes.size() >= direct_block) {
        const auto done = ::write(file_.get(), bytes.data(), bytes.size() / direct_block * direct_block);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) break;  // put() says why
        bytes.remove_prefix(static_cast<std::size_t>(done));
        at_ += static_cast<std::uint64_t>(done);
        if (static_cast<std::size_t>(done) % direct_block != 0) break;
    }
    ::fcntl(file_.get(), F_SETFL, flags);
}

void Aside::write_at(std::uint64_t at, std::string_view bytes) {
    check();
    need_file();
    while (!bytes.empty()) {
        const auto done = ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) fail();
        bytes.remove_prefix(static_cast<std::size_t>(done));
        at += static_cast<std::uint64_t>(done);
    }
}

void Aside::read_at(std::uint64_t at, char* to, std::size_t bytes) {
    check();
    need_file();
    while (bytes > 0) {
        const auto done = ::pread(file_.get(), to, bytes, static_cast<off_t>(at));
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) fail();
        if (done == 0) break;
        to += done;
        bytes -= static_cast<std::size_t>(done);
        at += static_cast<std::uint64_t>(done);
    }
    std::memset(to, 0, bytes);
}

void Aside::resize(std::uint64_t bytes) {
    check();
    need_file();
    if (::ftruncate(file_.get(), static_cast<off_t>(bytes)) != 0) fail();
}

std::uint64_t Aside::size() {
    check();
    need_file();
    struct stat status {};
    if (::fstat(file_.get(), &status) != 0) fail();
    return static_cast<std::uint64_t>(status.st_size);
}

void Aside::settle() {
    if (settled_) return;
    check();
    flush();
    if (!output_.stream && sync_ == Sync::now && !is_synced(file_.get())) fail();
    if (!file_.close()) fail();
    settled_ = true;
}

void Aside::commit() {
    settle();
    if (temporary_) {
        std::error_code error;
        temporary_->keep_as(output_.file, error);
        if (error) {
            errno = error.value();
            fail();
        }
    }
    committed_ = true;
    lock_.close();
    if (!temporary_ || sync_ == Sync::later) return;
    const auto& file = output_.file;
    sync_names(file.has_parent_path() ? file.parent_path() : fs::path("."));
}

void Aside::check() const {
    if (!failure_.empty()) throw Error("{}", failure_);
}

void Aside::need_file() {
    if (!output_.stream) return;
    failure_ = fmt::format(
        "{}: cannot be written: it is a device or a FIFO, and such a file is not written from its beginning "
        "to its end; give a file name",
        path_.string());
    throw Error("{}", failure_);
}

void Aside::fail() {
    const int error = errno;
    failure_ =
        fmt::format("{}: cannot be written: {}; {}", path_.string(), std::strerror(error), remedy(error));
    throw Error("{}", failure_);
}

void sync_file(const fs::path& path) {
    const Descriptor open(path, O_RDONLY | O_NOFOLLOW);
    if (open.get() < 0 || !is_synced(open.get())) not_written(path);
}

void sync_names(const fs::path& folder) {
    const Descriptor open(folder, O_RDONLY | O_DIRECTORY);
    if (open.get() >= 0 && !is_synced(open.get()))
        not_written(folder);  // who may not read a folder cannot sync it
}

void sync_folder(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_directory()) sync_names(entry.path());
        if (entry.is_regular_file()) sync_file(entry.path());
    }
    sync_names(folder);
}

void sync_all(const fs::path& folder) {
    const Descriptor file(folder, O_RDONLY | O_DIRECTORY);
    if (file.get() >= 0 && ::syncfs(file.get()) != 0 && errno != ENOSYS) not_written(folder);
}

}  // namespace actformer
