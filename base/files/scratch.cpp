#include "base/files/scratch.hpp"

#include <cstdlib>

#include "base/error.hpp"

namespace actformer {

namespace fs = std::filesystem;

Scratch::Scratch(const std::string& purpose, const fs::path& where) {
    const auto below = where.empty() ? fs::temp_directory_path() : where;
    auto name = (below / ("actformer-" + purpose + "-XXXXXX")).string();
    if (!mkdtemp(name.data()))
        throw Error("{}: no folder can be made in it; choose another place", below.string());
    path_ = name;
}

Scratch::~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace actformer
