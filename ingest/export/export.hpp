// Clips of a dataset or of a motions file, written for other programs.
#pragma once

#include <functional>

#include "ingest/export/selection.hpp"

namespace actformer::ingest {

struct ExportRequest {
    std::filesystem::path input;  ///< a dataset's folder or a motions file
    std::filesystem::path
        out;  ///< a file, whose ending tells the format, or a folder to make and fill with a file a clip
    std::string format;           ///< of a folder's files: the name of an ExportFormat; empty: as `out` ends
    std::filesystem::path bones;  ///< as open_clips takes it
    std::filesystem::path body;  ///< SMPL's model file, for a skin on rotations of SMPL's joints; empty: none
    Selection selection;
    bool force = false;  ///< replaces files that this program did not write
};

struct ExportSummary {
    std::size_t clips = 0;
    std::uint64_t frames = 0;
    std::string representation, format;
    std::vector<std::filesystem::path> files;
    std::vector<std::string> notes;  ///< what the user should know
};

/// Calls `progress(clips done, of how many)` after every clip. A file appears whole or not at all; one clip is in memory at
/// a time. Throws Error for a format that there is none of, several clips where one fits a file, a body where none fits, an output that is
/// an input too, and as open_clips, selected, read_smpl_body, refuse_foreign and refuse_other_folder do.
ExportSummary export_clips(const ExportRequest& request,
                           const std::function<void(std::size_t, std::size_t)>& progress = {});

}  // namespace actformer::ingest
