#include "ingest/export/foreign.hpp"

#include <algorithm>

#include "base/checksum/own_checksum.hpp"
#include "base/error.hpp"
#include "base/files/mapped_file.hpp"
#include "base/hdf5/reader.hpp"
#include "base/numpy/zip.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

/// Motions of the Python package are the user's.
bool is_of_this_program(const hdf5::Reader& file) {
    if (!file.has_attribute("program")) return false;
    const auto program = file.attribute_texts("program");
    return program.size() == 1 && names_this_program(program[0]);
}

/// Datasets' shards and networks' weights name the program too, and hold no motions of (P*C, K, T).
bool is_own_hdf5(const fs::path& path) {
    const hdf5::Reader file(path);
    if (!is_of_this_program(file) || !file.has_attribute("representation") || file.has_attribute("dataset") ||
        file.has_attribute("kind"))
        return false;
    const auto names = file.names();
    return std::ranges::all_of(
        names, [&](const auto& name) { return file.is_array(name) && file.shape(name).size() == 3; });
}

bool is_hdf5(std::string_view bytes) {
    return bytes.starts_with("\x89HDF");
}

bool is_imported(const fs::path& path) try {
    if (!is_hdf5(MappedFile(path).text())) return false;
    const hdf5::Reader file(path);
    return is_of_this_program(file) && file.has_attribute("imported");
} catch (const Error&) {
    return false;
}

bool is_own(const fs::path& path) try {
    const MappedFile file(path);
    const auto bytes = file.text();
    if (bytes.starts_with("PK")) {
        const auto members = zip_members(bytes);
        const auto has = [&](std::string_view name) {
            return std::ranges::count(members, name, &ZipMember::name) == 1;
        };
        return has("program.npy") && has("clips.npy") && has("parents.npy");
    }
    constexpr std::size_t head = 4096;
    if (bytes.starts_with("glTF")) {
        constexpr std::string_view key = "\"generator\":\"";
        const auto at = bytes.substr(0, head).find(key);
        return at != bytes.npos && names_this_program(bytes.substr(at + key.size()));
    }
    return is_hdf5(bytes) && is_own_hdf5(path);
} catch (const Error&) {
    return false;
}

bool holds_something(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) > 0;
}

[[noreturn]] void refuse(const fs::path& path, std::string_view why) {
    throw Error("{}: is there, and {}; choose another name, or replace it with --force", path.string(), why);
}

}  // namespace

void refuse_foreign(const fs::path& path) {
    if (holds_something(path) && !is_own(path))
        refuse(path, path.extension() == ".bvh" ? "a .bvh does not tell whether this program wrote it"
                                                : "holds no motions that this program wrote");
}

void refuse_foreign_weights(const fs::path& path) {
    if (holds_something(path) && !is_imported(path)) refuse(path, "holds no weights that import wrote");
}

void refuse_foreign(const fs::path& path, std::string_view what,
                    const std::function<bool(std::string_view)>& is_own) {
    if (!holds_something(path)) return;
    try {
        if (is_own(MappedFile(path).text())) return;
    } catch (const std::exception&) {  // of another kind, or damaged
    }
    refuse(path, fmt::format("holds no {} that this program wrote", what));
}

}  // namespace actformer::ingest
