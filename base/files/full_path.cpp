#include "base/files/full_path.hpp"

namespace actformer {

std::filesystem::path full_path(const std::filesystem::path& path) {
    return std::filesystem::absolute(path / "").lexically_normal().parent_path();
}

}  // namespace actformer
