#include "base/files/regular_file.hpp"

#include "base/error.hpp"

namespace actformer {

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

}  // namespace actformer
