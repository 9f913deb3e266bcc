// Which clips are exported.
#pragma once

#include <string>
#include <vector>

#include "ingest/export/clip_source.hpp"

namespace actformer::ingest {

/// What every condition lets pass.
struct Selection {
    std::string split = "all";
    std::vector<std::string> clips;  ///< by name; empty: any
    std::string label;               ///< a class, as label_called takes it; empty: any
    std::size_t count = 0;           ///< so many of these, evenly spaced; 0: all
    std::uint32_t person = 0;        ///< from 1; 0: all
};

/// Indices into source.clips(), rising. Throws Error for a clip, a class or a split that is not there, and where nothing passes.
std::vector<std::size_t> selected(const ClipSource& source, const Selection& selection);

/// The clip with person number `person`, from 1, alone; the whole clip for 0. Throws Error where it has fewer persons.
ExportClip with_person(ExportClip clip, std::uint32_t person, const std::string& where);

}  // namespace actformer::ingest
