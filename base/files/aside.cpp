#include "base/files/aside.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/error.hpp"

namespace actformer {

namespace fs = std::filesystem;

Aside::Aside(fs::path path, const std::string& ending)
    : path_(std::move(path)), partial_(path_.string() + ".partial" + ending) {
    std::error_code ignored;
    const auto folder = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored))
        throw Error("{}: cannot be written: there is no folder {}; make it first", path_.string(),
                    folder.string());
    if (fs::is_directory(path_, ignored))
        throw Error("{}: cannot be written: it is a folder; give a file name", path_.string());
    temporary_.emplace([this] {
        errno = 0;
        if (!std::ofstream(partial_, std::ios::binary))
            throw Error("{}: cannot be written: {}; choose another place", path_.string(),
                        std::strerror(errno));
        return partial_;
    });
}

Aside::~Aside() {
    std::error_code ignored;
    if (!committed_) fs::remove(partial_, ignored);
}

void Aside::commit(bool complete) {
    if (!complete) throw Error("{}: cannot be written whole; is the disk full?", path_.string());
    std::error_code failed;
    fs::rename(partial_, path_, failed);
    if (failed) throw Error("{}: cannot be written: {}", path_.string(), failed.message());
    committed_ = true;
}

}  // namespace actformer
