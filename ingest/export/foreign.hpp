// Files of others, which an output does not replace.
#pragma once

#include <filesystem>

namespace actformer::ingest {

/// Throws Error, with the remedy, where `path` is there and holds no motions that `export` or `generate` wrote: HDF5 files, .npz and .glb tell
/// who wrote them; a .bvh does not.
void refuse_foreign(const std::filesystem::path& path);

/// The same of a file that holds no weights that `import` wrote.
void refuse_foreign_weights(const std::filesystem::path& path);

}  // namespace actformer::ingest
