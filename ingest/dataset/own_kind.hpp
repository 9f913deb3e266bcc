// What this program wrote at a path, for messages where something else is expected there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace actformer::hdf5 {
class Reader;
}

namespace actformer::ingest {

namespace own {
inline constexpr std::string_view generator = "a generator's weights", recogniser = "a recogniser's weights",
                                  features = "features", shard = "a dataset's shard", dataset = "a dataset",
                                  training = "a training", sweep = "a sweep", raw = "synthetic raw data";
}  // namespace own

/// One of those; empty of motions, and of files of other programs.
std::string_view own_kind(const hdf5::Reader& file);

/// The same of a folder or file. Empty too where it cannot be read.
std::string_view own_kind(const std::filesystem::path& path);

/// The kind of what lies at `path` where it is none that is `wanted`; else empty. A training's folder has weights of either kind.
std::string_view other_kind(const std::filesystem::path& path, std::string_view wanted);

/// Throws Error, with the remedy, for a file that this program wrote and that holds no motions.
void refuse_other_than_motions(const hdf5::Reader& file, const std::string& where);

/// Throws Error, "m.h5: holds motions, not features; REMEDY", where the file holds motions or another kind than `wanted`. A file of other
/// contents is left to its reader.
void refuse_other_file(const hdf5::Reader& file, const std::string& where, std::string_view wanted,
                       std::string_view remedy);

/// Throws Error where the folder to write into is a file, or holds another kind than `wanted`.
void refuse_other_folder(const std::filesystem::path& out, std::string_view wanted);

}  // namespace actformer::ingest
