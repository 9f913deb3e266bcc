// Which clips a raw file holds, by its name and folders (a NamePattern), by a table of labels (a LabelsFile), or by both: the labels
// then tell the action and the pattern more fields.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/formats/labels_file.hpp"
#include "ingest/formats/name_pattern.hpp"

namespace actformer::ingest {

/// Where a file is, without its extension: from the top where it is on disk, from the archive's top where it is in one.
std::string path_for_names(const RawText& raw);

/// What a clip is called after its path: the last `folders` + 1 parts, joined by _, fit for print.
std::string name_of_path(const std::string& path, std::size_t folders);

/// A clip, before its file is read.
struct NamedClip {
    std::string name;
    std::string action;
    std::vector<std::string> fields;          ///< as ClipNames::fields() names them
    std::optional<std::uint32_t> start, end;  ///< frames of the file, where it holds more than the clip
};

class ClipNames {
  public:
    /// Either may be empty. Throws Error where both are, the pattern is none, or the labels cannot be read.
    ClipNames(const std::string& pattern, const std::filesystem::path& labels);

    const std::vector<std::string>& fields() const { return fields_; }

    /// True where files that differ in {person} alone are one clip.
    bool groups_files() const { return groups_; }

    /// All that decides names and labels, as text.
    std::string settings() const;

    /// Notes a file that will be asked for. One thread at a time.
    void note(const RawText& raw) { note(path_for_names(raw), raw.index); }

    /// The same for what lies in a file: `path` is that of the file, as path_for_names() has it, with the part's name behind.
    void note(std::string path, std::uint64_t index);

    /// After the last note(): clips are called after their files' names, with as many folders before them, joined by _, as tell all
    /// files apart. Throws Error where no file noted has a clip.
    void settle();

    /// The clips of a file, at least one, or why there is none.
    std::variant<std::vector<NamedClip>, Rejection> clips_of(const RawText& raw) const {
        return clips_of(path_for_names(raw));
    }
    std::variant<std::vector<NamedClip>, Rejection> clips_of(const std::string& path) const;

    /// The same for files that are persons of one clip: what their fields say but for {person}. Empty where there is no such field, or
    /// no clip.
    std::string group_of(const RawText& raw) const;

    /// Rows of the labels whose files are not there, in a line; empty where there are none.
    std::string unused_labels() const;

    /// What the user should know of the labels and of `classes`, a line each: rows whose files are not there, and all clips of one class.
    std::vector<std::string> remarks(const std::vector<std::string>& classes) const;

  private:
    /// What to do where `classes` are one, in a line; empty where they are several.
    std::string one_class(const std::vector<std::string>& classes) const;

    /// What is known of a file but for the names of its clips.
    struct Known {
        std::vector<std::string> fields;  ///< of the pattern, those kept
        std::vector<std::size_t> rows;    ///< of the labels
        std::string group;  ///< the pattern's fields but {person}; empty where it has no such field
    };
    std::variant<Known, Rejection> known(const std::string& path) const;
    std::string name_of(const std::string& path) const { return name_of_path(path, folders_); }

    std::optional<NamePattern> pattern_;
    std::vector<std::size_t> kept_;  ///< which of the pattern's fields are not in the labels, {person} apart
    std::optional<LabelsFile> labels_;
    std::optional<std::size_t> person_;  ///< {person} among the labels' fields; it is none of fields()
    std::string labels_path_, labels_checksum_;
    std::vector<std::string> fields_;
    std::vector<std::string> paths_;  ///< noted, of files with clips
    std::vector<bool> used_;          ///< (rows of the labels)
    std::string first_path_;
    std::uint64_t first_index_ = 0;
    bool any_noted_ = false, groups_ = false;
    std::size_t folders_ = 0;  ///< before a file's name
};

}  // namespace actformer::ingest
