// What can be exported: the clips of a dataset or the motions of a file, told alike.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/subjects.hpp"

namespace actformer::ingest {

struct ClipEntry {
    std::string name;
    std::optional<std::uint32_t> label;  ///< from 0
};

struct ExportClip : ClipEntry {
    std::string
        public_name;  ///< as the public layout spells it, with a number where two would be spelt alike
    Motion motion;    ///< of finite numbers, at least one frame
    BodyModel body;   ///< with the clip's own bone lengths where they are known
};

/// Reads clips one at a time.
class ClipSource {
  public:
    explicit ClipSource(std::filesystem::path path) : path_(std::move(path)) {}
    virtual ~ClipSource() = default;

    const std::filesystem::path& path() const { return path_; }
    const std::vector<ClipEntry>& clips() const { return clips_; }
    const Subjects& subjects() const { return subjects_; }  ///< with mean bone lengths

    /// What the user should know of the clips' public names; empty: nothing.
    const std::string& public_names_note() const { return public_names_note_; }

    virtual std::string fingerprint() const = 0;  ///< of what the clips come from

    /// Indices of the clips in a split; "all" is every clip. Throws Error naming the splits there are.
    virtual std::vector<std::size_t> split(const std::string& name) const = 0;

    /// Throws Error naming the clip where it is damaged, holds a number that is not finite, or does not fit subjects().
    ExportClip read(std::size_t clip) const;

  protected:
    virtual ExportClip read_unchecked(std::size_t clip) const = 0;
    std::vector<ClipEntry> clips_;
    Subjects subjects_;
    std::string public_names_note_;

  private:
    std::filesystem::path path_;
};

/// The dataset in folder `path`, or the motions in file `path`. Skeleton and bone lengths of motions are those of the dataset
/// `bones` where it is given, else the file's own, else NTU's for 25 joints. Throws Error where nothing can be read, for a folder
/// of several datasets, and where no skeleton is known.
std::unique_ptr<ClipSource> open_clips(const std::filesystem::path& path,
                                       const std::filesystem::path& bones = {});

}  // namespace actformer::ingest
