// The folder that a stand-in is written into.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace actformer::ingest::synth {

/// Makes it, with ORIGIN, which says that its files are stand-ins, and synth.json, which says what they were made from: those of another
/// stand-in, seed or version must not be mixed with them. `made_by` is the command, as in "actformer synth ntu"; `clips` is given where
/// what a file holds depends on how many clips there are. Throws Error where the folder holds such files, or any file without a
/// synth.json, or an ORIGIN of other clips, and where it cannot be made.
void claim_folder(const std::filesystem::path& folder, std::string_view made_by, std::uint64_t seed,
                  std::optional<std::uint64_t> clips = {});

/// A file whole or not at all, and the folders it lies in. The caller calls sync_all() after the last one. Throws Error naming it and the remedy.
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace actformer::ingest::synth
