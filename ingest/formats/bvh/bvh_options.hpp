// The options of a dataset of BVH or ASF/AMC files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/split.hpp"
#include "ingest/formats/skeletal/positions.hpp"
#include "ingest/formats/skeletal/up.hpp"

namespace actformer::ingest {

/// A place in a clip: a frame, or a time.
struct ClipPlace {
    double value = 0;
    bool in_seconds = false;
};

struct BvhOptions {
    std::string dataset;  ///< the dataset's name
    std::string pattern;  ///< of file names, as NamePattern takes it; may be empty where there are labels
    std::string labels;   ///< path of a LabelsFile, or empty
    std::string asf;      ///< path of the skeleton of .amc files that have none of their own, or empty
    std::string scale = "0.01";  ///< metres a unit of the files, or "auto"; most are in centimetres
    std::string up = "y";        ///< the files' axis that points up
    std::string positions;    ///< as positions_named takes them; empty: replace, and refuse limbs that vanish
    double recorded_fps = 0;  ///< frames a second that the files were recorded at; 0: as they say
    double fps = 0;           ///< frames a second to resample to; 0: as recorded
    unsigned skip_first = 0;  ///< frames of every file to leave out
    std::string start, end;   ///< of every file: "30" frames or "1.5s", the end not included; empty: all
    unsigned persons = 0;     ///< persons a clip; 0: as in most clips
    float smooth = 0;         ///< sigma of a Gaussian over frames; 0: none
    bool end_sites = false;   ///< keep end sites as joints
    bool centre_windows = false;  ///< see DatasetHeader
    std::string root;  ///< joint to take as root; empty: the one that carries the motion in all files
    std::vector<std::string> classes;  ///< actions in the order of their labels; empty: all, sorted
    std::vector<Split> splits;         ///< over the clips' fields
};

/// The options once understood.
struct BvhSettings {
    /// Throws Error where an option makes no sense. `fields` are the clips'.
    BvhSettings(const BvhOptions& options, const std::vector<std::string>& fields);

    std::optional<float> scale;  ///< none: to be found
    Up up = Up::y;
    Positions positions = Positions::told;
    ClipPlace start;
    std::optional<ClipPlace> end;
};

}  // namespace actformer::ingest
