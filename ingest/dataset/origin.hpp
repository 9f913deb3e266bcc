// Where a dataset's motion comes from: tables and captions say it with every figure that was measured on it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace actformer::ingest {

struct DataOrigin {
    enum class Kind {
        recorded,   ///< by motion capture, or out of videos
        synthetic,  ///< made by a program and published so, as GTA Combat is
        stand_in  ///< made in the place of a dataset that is not at hand: no figure is comparable with one of that dataset
    };
    static constexpr Kind kinds[] = {Kind::recorded, Kind::synthetic, Kind::stand_in};

    std::optional<Kind> kind;  ///< none: not told, as in datasets of earlier versions
    std::string
        skeleton;  ///< that rotations turn: "generic", or the name of the model file; empty: the motion's own
    std::string part{};  ///< what it has of the published classes, as in "20 categories"; empty: all of them

    bool operator==(const DataOrigin&) const = default;

    /// For captions: "stand-in, generic skeleton", "recorded, skeleton of SMPL_NEUTRAL.pkl, 20 categories"; empty where nothing is told.
    std::string text() const;
};

/// "recorded", "synthetic", "stand-in"
std::string_view name_of(DataOrigin::Kind kind);

/// Throws Error, beginning with `where`, for a name that is none of these.
DataOrigin::Kind origin_named(std::string_view name, const std::string& where);

/// Raw data tell it in a file ORIGIN of one of these names, in the folder that is ingested or the one around it: what `synth` writes is a stand-in.
/// None where there is no such file. Throws Error where it says something else.
std::optional<DataOrigin::Kind> read_origin(const std::filesystem::path& folder);
void write_origin(const std::filesystem::path& folder, DataOrigin::Kind kind);

}  // namespace actformer::ingest
