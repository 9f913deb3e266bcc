#include "base/files/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.hpp"

namespace actformer {
namespace {

[[noreturn]] void refuse_kind(const std::filesystem::path& path, const char* kind) {
    throw Error("{}: {}, where a regular file is expected; move it away", path.string(), kind);
}

}  // namespace

const char* irregular_kind(const std::filesystem::path& path) {
    std::error_code ignored;
    switch (std::filesystem::status(path, ignored).type()) {
        case std::filesystem::file_type::directory:
            return "a folder";
        case std::filesystem::file_type::fifo:
            return "a FIFO";
        case std::filesystem::file_type::socket:
            return "a socket";
        case std::filesystem::file_type::block:
        case std::filesystem::file_type::character:
            return "a device";
        default:
            return "";
    }
}

void refuse_irregular(const std::filesystem::path& path) {
    if (const std::string kind = irregular_kind(path); !kind.empty())
        throw Error("{}: {}, where a regular file is expected", path.string(), kind);
}

Readable open_to_read(const std::filesystem::path& path) {
    int error = 0;
    // Without O_NONBLOCK a FIFO would be waited for until it has a writer.
    for (const int flags : {O_RDONLY | O_NONBLOCK, O_RDONLY}) {
        Descriptor file(path, flags);
        struct stat status {};
        if (file.get() >= 0 && ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode))
            return {std::move(file), static_cast<std::uint64_t>(status.st_size)};
        error = errno;
        refuse_irregular(path);
        if (error != EWOULDBLOCK) break;  // else another program has to give up its lease on the file first
    }
    throw Error("{}: cannot be read: {}", path.string(), std::strerror(error));
}

Descriptor open_regular(const std::filesystem::path& path, int flags) {
    Descriptor file(path, flags | O_NOFOLLOW | O_NONBLOCK);
    const int error = errno;
    if (file.get() < 0 && error == ELOOP) refuse_kind(path, "a symbolic link");
    struct stat status {};
    const bool regular = file.get() >= 0 && ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode);
    if (const char* kind = irregular_kind(path); !regular && *kind) refuse_kind(path, kind);
    errno = error;
    return file;
}

}  // namespace actformer
