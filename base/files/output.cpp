#include "base/files/output.hpp"

#include <unistd.h>

#include <cerrno>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "base/files/descriptor.hpp"

namespace actformer {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40;  // as Linux follows

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
    throw Error("{}: cannot be written: {}", path.string(), why);
}

}  // namespace

fs::path without_links(fs::path path) {
    std::error_code error;
    for (int i = 0; i < most_links && fs::is_symlink(path, error); ++i) {
        const auto to = fs::read_symlink(path, error);
        if (error) break;
        path = to.is_absolute() ? to : path.parent_path() / to;
    }
    return path;
}

Output output_at(const fs::path& path) {
    std::error_code error;
    const auto there = fs::status(path, error);
    switch (there.type()) {
        case fs::file_type::directory:
            refuse(path, "it is a folder; give a file name");
        case fs::file_type::character:
        case fs::file_type::fifo:
            return {path, true};
        case fs::file_type::block:
            refuse(path, "it is a disk; give a file name");
        case fs::file_type::regular:
        case fs::file_type::not_found:
            break;
        case fs::file_type::none:
            refuse(path, error.message() + "; choose another place");
        default:
            refuse(path, "it is no regular file; choose another place");
    }
    auto file = without_links(path);
    // Links below /proc/self/fd may lead to a file that has no name any more.
    if (fs::exists(there) && file != path && !fs::equivalent(file, path, error)) return {path, true};
    const auto folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error))
        refuse(path, fmt::format("there is no folder {}; make it first", folder.string()));
    return {std::move(file), false};
}

void check_output(const fs::path& path) {
    if (!output_at(path).stream)
        Aside{path};  // NOLINT(bugprone-unused-raii): made and removed
    else if (::access(path.c_str(), W_OK) != 0)
        refuse(path, reason() + "; choose another place");
}

}  // namespace actformer
