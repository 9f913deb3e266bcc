// Loaded in front of a program (LD_PRELOAD): counts the calls of the system with which it changes files below a folder, and lets one
// of them fail. From the environment:
//   FAIL_BELOW   the folder
//   FAIL_AT      which call, from 1; 0 or absent: none
//   FAIL_ON      1: all calls behind it fail too, as on a disk that stays full
//   FAIL_COUNT   a file that is told at the end how many calls there were
//   FAIL_LIST    a file that is told of every call before it is made: a line of its name and path
//   FAIL_WAITS   a file: the call FAIL_AT does not fail, but waits until that is there
// Nothing is written or named by a call that fails; a descriptor whose closing fails is closed. The error is ENOSPC, or EIO of what
// brings bytes to the disk.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

std::atomic<long> calls;

struct Plan {
    const char* below = std::getenv("FAIL_BELOW");
    long at = std::getenv("FAIL_AT") ? std::atol(std::getenv("FAIL_AT")) : 0;
    bool on = std::getenv("FAIL_ON") != nullptr;
    const char* waits = std::getenv("FAIL_WAITS");
    const char* count = std::getenv("FAIL_COUNT");
    const char* list = std::getenv("FAIL_LIST");
    pid_t process = ::getpid();
    ~Plan() {
        if (!count || ::getpid() != process) return;
        put(count, O_TRUNC, std::to_string(calls.load()));
    }
    static void put(const char* path, int how, const std::string& text) {
        const long file = ::syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | how, 0600);
        ::syscall(SYS_write, file, text.data(), text.size());
        ::syscall(SYS_close, file);
    }
};

const Plan& plan() {
    static const Plan one;
    return one;
}

bool is_below(const char* path) {
    const auto* folder = plan().below;
    return folder && path && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

/// Counts a call; whether it must fail.
bool fails(int error, const char* name, const std::string& path) {
    const auto& p = plan();
    if (::getpid() != p.process) return false;  // a child that only closes what it has from its parent
    const long n = ++calls;
    if (p.list) Plan::put(p.list, O_APPEND, std::string(name) + " " + path + "\n");
    if (p.waits) {
        constexpr useconds_t while_absent = 1000;
        while (n == p.at && ::access(p.waits, F_OK) != 0) ::usleep(while_absent);
        return false;
    }
    if (p.at == 0 || n < p.at || (n > p.at && !p.on)) return false;
    errno = error;
    return true;
}

/// The path of a descriptor's file or folder where that is below the one watched, as the kernel has it: the C library opens and closes
/// some without telling. Else empty.
std::string watched(int fd) {
    char path[4096];
    const auto link = "/proc/self/fd/" + std::to_string(fd);
    const auto size = ::readlink(link.c_str(), path, sizeof path - 1);
    if (size <= 0) return {};
    path[size] = 0;
    return is_below(path) ? path : std::string();
}

template <typename Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int opened(int folder, const char* path, int flags, mode_t mode) {
    const bool writes = (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
    if (is_below(path) && writes && fails(ENOSPC, "open", path)) return -1;
    static auto* const next = real<int(int, const char*, int, ...)>("openat");
    return next(folder, path, flags, mode);
}

mode_t mode_of(int flags, va_list rest) {
    return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
}

/// A call on a descriptor that is written to.
template <typename Result, typename... Arguments>
Result on_descriptor(const char* name, int error, int fd, Arguments... arguments) {
    if (const auto path = watched(fd); !path.empty() && fails(error, name, path)) return -1;
    return real<Result(int, Arguments...)>(name)(fd, arguments...);
}

/// A call that makes or changes names.
template <typename... Arguments>
int on_path(const char* name, const char* path, Arguments... arguments) {
    if (is_below(path) && fails(ENOSPC, name, path)) return -1;
    return real<int(Arguments...)>(name)(arguments...);
}

FILE* opened_stream(const char* name, const char* path, const char* mode) {
    const bool writes = std::strpbrk(mode, "wa+") != nullptr;
    if (is_below(path) && writes && fails(ENOSPC, name, path)) return nullptr;
    return real<FILE*(const char*, const char*)>(name)(path, mode);
}

}  // namespace

#define OPENS(name, before, arguments)          \
    int name before {                           \
        va_list rest;                           \
        va_start(rest, flags);                  \
        const auto mode = mode_of(flags, rest); \
        va_end(rest);                           \
        return opened arguments;                \
    }

extern "C" {

OPENS(open, (const char* path, int flags, ...), (AT_FDCWD, path, flags, mode))
OPENS(open64, (const char* path, int flags, ...), (AT_FDCWD, path, flags, mode))
OPENS(openat, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))
OPENS(openat64, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))
// As they are called where the compiler checks arguments (-D_FORTIFY_SOURCE).
int __open_2(const char* path, int flags) {
    return opened(AT_FDCWD, path, flags, 0);
}
int __open64_2(const char* path, int flags) {
    return opened(AT_FDCWD, path, flags, 0);
}
int __openat_2(int folder, const char* path, int flags) {
    return opened(folder, path, flags, 0);
}
int __openat64_2(int folder, const char* path, int flags) {
    return opened(folder, path, flags, 0);
}
int creat(const char* path, mode_t mode) {
    return opened(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}
int creat64(const char* path, mode_t mode) {
    return creat(path, mode);
}
FILE* fopen(const char* path, const char* mode) {
    return opened_stream("fopen", path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
    return opened_stream("fopen64", path, mode);
}

ssize_t write(int fd, const void* from, size_t size) {
    return on_descriptor<ssize_t>("write", ENOSPC, fd, from, size);
}
ssize_t writev(int fd, const iovec* from, int count) {
    return on_descriptor<ssize_t>("writev", ENOSPC, fd, from, count);
}
ssize_t pwrite(int fd, const void* from, size_t size, off_t at) {
    return on_descriptor<ssize_t>("pwrite", ENOSPC, fd, from, size, at);
}
ssize_t pwrite64(int fd, const void* from, size_t size, off64_t at) {
    return on_descriptor<ssize_t>("pwrite64", ENOSPC, fd, from, size, at);
}
int ftruncate(int fd, off_t size) noexcept {
    return on_descriptor<int>("ftruncate", ENOSPC, fd, size);
}
int ftruncate64(int fd, off64_t size) noexcept {
    return on_descriptor<int>("ftruncate64", ENOSPC, fd, size);
}
int fallocate(int fd, int mode, off_t at, off_t size) {
    return on_descriptor<int>("fallocate", ENOSPC, fd, mode, at, size);
}
int fsync(int fd) {
    return on_descriptor<int>("fsync", EIO, fd);
}
int fdatasync(int fd) {
    return on_descriptor<int>("fdatasync", EIO, fd);
}
int syncfs(int fd) noexcept {
    return on_descriptor<int>("syncfs", EIO, fd);
}

int close(int fd) {
    const int flags = ::fcntl(fd, F_GETFL);
    const auto written = flags >= 0 && (flags & O_ACCMODE) != O_RDONLY ? watched(fd) : std::string();
    const auto done = static_cast<int>(::syscall(SYS_close, fd));
    return !written.empty() && fails(EIO, "close", written) ? -1 : done;
}

int rename(const char* from, const char* to) noexcept {
    return on_path("rename", to, from, to);
}
int renameat(int folder, const char* from, int other, const char* to) noexcept {
    return on_path("renameat", to, folder, from, other, to);
}
int link(const char* from, const char* to) noexcept {
    return on_path("link", to, from, to);
}
int symlink(const char* from, const char* to) noexcept {
    return on_path("symlink", to, from, to);
}
int mkdir(const char* path, mode_t mode) noexcept {
    return on_path("mkdir", path, path, mode);
}
int truncate(const char* path, off_t size) noexcept {
    return on_path("truncate", path, path, size);
}
int truncate64(const char* path, off64_t size) noexcept {
    return on_path("truncate64", path, path, size);
}
}
