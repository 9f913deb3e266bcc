// Files of others, which an output does not replace.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace actformer::ingest {

/// Throws Error, with the remedy, where `path` is there and holds no motions that `export` or `generate` wrote: HDF5 files, .npz and .glb tell
/// who wrote them; a .bvh does not.
void refuse_foreign(const std::filesystem::path& path);

/// The same of a file that holds no weights that `import` wrote.
void refuse_foreign_weights(const std::filesystem::path& path);

/// The same of a file whose bytes are not what `is_own` takes for this program's; what it throws counts as that. `what` the file should hold
/// is in words, as in "scores".
void refuse_foreign(const std::filesystem::path& path, std::string_view what,
                    const std::function<bool(std::string_view)>& is_own);

}  // namespace actformer::ingest
