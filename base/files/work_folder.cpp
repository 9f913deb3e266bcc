#include "base/files/work_folder.hpp"

#include "base/error.hpp"

namespace actformer {

namespace fs = std::filesystem;

void expect_own_folder(const fs::path& folder, const IsOwnFile& is_own) {
    constexpr auto choose = "or choose another -o";
    std::error_code error, ignored;  // a file may go while it is looked at
    const auto there = fs::symlink_status(folder, ignored);
    if (!fs::exists(there)) return;
    if (fs::is_symlink(there))
        throw Error("{}: a symbolic link where the command works, which follows none; remove it, {}",
                    folder.string(), choose);
    if (!fs::is_directory(there))
        throw Error("{}: in the way of the folder that the command works in; move it, {}", folder.string(),
                    choose);
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const auto type = entry->symlink_status(ignored).type();
        if (type == fs::file_type::directory || type == fs::file_type::not_found) continue;
        if (type != fs::file_type::regular || !is_own(entry->path().lexically_relative(folder)))
            throw Error(
                "{}: in a folder that the command works in and removes, and not made by it; move it, {}",
                entry->path().string(), choose);
    }
    if (error && error != std::errc::no_such_file_or_directory)
        throw Error("{}: cannot be read: {}; move it, {}", folder.string(), error.message(), choose);
}

void remove_own_folder(const fs::path& folder, const IsOwnFile& is_own) try {
    std::error_code ignored;
    expect_own_folder(folder, is_own);
    fs::remove_all(folder, ignored);
} catch (const Error&) {  // it holds what others made
}

bool is_called(const fs::path& name, const std::string& file) {
    const auto& said = name.native();
    return said == file || said.starts_with(file + ".partial");
}

}  // namespace actformer
