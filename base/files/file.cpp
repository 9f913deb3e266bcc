#include "base/files/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "base/files/descriptor.hpp"
#include "base/files/memory_for.hpp"
#include "base/files/regular_file.hpp"

namespace actformer {

namespace fs = std::filesystem;

namespace {

/// "128 MiB", rounded up; "1024 bytes" of less than one.
std::string in_units(std::uint64_t bytes) {
    constexpr std::uint64_t mebibyte = 1 << 20;
    return bytes < mebibyte ? fmt::format("{} bytes", bytes)
                            : fmt::format("{} MiB", bytes / mebibyte + (bytes % mebibyte != 0));
}

}  // namespace

std::string_view read_text(const fs::path& path, std::vector<char>& scratch, std::uint64_t limit) {
    const auto [file, size] = open_to_read(path);
    if (size > limit)
        throw Error("{}: {}, and a file of this kind has at most {}; look whether it is the right file",
                    path.string(), in_units(size), in_units(limit));
    try {
        if (scratch.size() < size + text_padding) scratch.resize(size + text_padding);
    } catch (const std::bad_alloc&) {
        throw NoMemoryFor(path);
    }
    const auto got = read_fully(file.get(), scratch.data(), size, path);
    std::memset(scratch.data() + got, 0, text_padding);
    return {scratch.data(), got};
}

void read_in_pieces(const fs::path& path, const std::function<void(std::string_view)>& use) {
    const auto file = open_to_read(path).file;
    std::vector<char> piece(std::size_t{1} << 20);
    while (const auto got = read_fully(file.get(), piece.data(), piece.size(), path))
        use({piece.data(), got});
}

void write_whole(const fs::path& path, std::string_view bytes, Sync sync) {
    Aside file(path, sync);
    file.write(bytes);
    file.commit();
}

void append(const fs::path& path, std::string_view bytes) {
    auto file = open_regular(path, O_WRONLY | O_CREAT | O_APPEND);
    const Descriptor same(file.get() < 0 ? -1 : ::fcntl(file.get(), F_DUPFD_CLOEXEC, 0));
    struct stat before {};
    const bool there = same.get() >= 0 && ::fstat(same.get(), &before) == 0;
    if (there && write_fully(file.get(), bytes) && file.close()) return;
    const int error = errno;
    if (there) static_cast<void>(::ftruncate(same.get(), before.st_size) == 0);
    throw Error("{}: cannot be written: {}; {}", path.string(), std::strerror(error), remedy(error));
}

void make_folders(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(without_links(folder), error);
    if (error)
        throw Error("{}: the folder cannot be made: {}; choose another place", folder.string(),
                    error.message());
}

}  // namespace actformer
