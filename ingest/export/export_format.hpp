// A kind of file that clips are exported to.
//
// To add one:
//   1. Give it a folder in ingest/export/ with what writes it, knowing nothing of clips.
//   2. Derive from ExportFile there: add() takes a clip, finish() makes the file appear, whole.
//   3. Add a line to export_formats() in export_format.cpp: the help of `export` and its tests go through that list.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/aside.hpp"
#include "ingest/export/clip_source.hpp"
#include "ingest/export/skeleton_motion.hpp"
#include "ingest/smpl/body_file.hpp"

namespace actformer::ingest {

/// What all clips of an export have in common.
struct ExportContext {
    Subjects subjects;                  ///< of as many persons as are exported
    std::vector<Point> pose;            ///< the rest pose of skeletons, as skeletons_of takes it
    std::string source;                 ///< fingerprint of what the clips come from
    std::optional<SmplBody> body = {};  ///< of a skin; only of formats that take one
    Sync sync = Sync::now;
    bool force = false;                  ///< files of others are replaced
    std::string public_names_note = {};  ///< as ClipSource has it
};

/// A file in the making, or for some formats a file a person. Nothing is left of it without finish().
class ExportFile {
  public:
    virtual ~ExportFile() = default;
    virtual void add(const ExportClip& clip) = 0;
    virtual std::vector<std::filesystem::path> finish() = 0;  ///< the files that there are now
    virtual std::string note() const { return {}; }  ///< what the user should know of it; empty: nothing
};

struct ExportFormat {
    std::string_view name;  ///< its files' ending, without the dot
    std::string_view holds;
    bool many_clips;  ///< in one file
    bool skeletons;   ///< needs a rest pose
    bool bodies;      ///< takes a body model to skin
    std::unique_ptr<ExportFile> (*open)(const std::filesystem::path& path, const ExportContext& context);
};

const std::vector<ExportFormat>& export_formats();

/// Nothing for a name that is none of theirs.
const ExportFormat* export_format(std::string_view name);

}  // namespace actformer::ingest
