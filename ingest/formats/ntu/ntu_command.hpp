// The options of `actformer ingest ntu`.
#pragma once

#include "ingest/formats/format.hpp"
#include "ingest/formats/ntu/own_names.hpp"

namespace actformer::ingest {

struct NtuCommand : IngestCommand {
    std::string missing;  ///< the list of clips with missing skeletons; empty: none
    std::string bodies = "frames";
    bool join_tracks = false;
    OwnNamesOptions own;              ///< of files with other names than NTU's
    std::vector<std::string> splits;  ///< of those, as parse_splits takes them

    std::vector<Option> list() override;
    bool one_dataset() const override { return has_own_names(); }
    std::unique_ptr<Format> open(const std::string& dataset) const override;

  private:
    bool has_own_names() const { return !own.pattern.empty() || !own.labels.empty(); }
};

inline constexpr std::string_view ntu_examples =
    "  actformer ingest ntu nturgbd_skeletons_s001_to_s017.zip nturgbd_skeletons_s018_to_s032.zip \\\n"
    "      --missing NTU_RGBD120_samples_with_missing_skeletons.txt -o ntu\n"
    "  actformer ingest ntu raw/ -o ntu --strict\n"
    "  actformer ingest ntu raw/ -o ntu-mended --join-tracks --bodies motion\n"
    "  actformer ingest ntu kinect/ -o falls --name '{action}/{performer}_{take}' --split "
    "'test=performer:7,8'\n"
    "  actformer ingest ntu kinect/ -o fights --labels labels.csv --persons 2\n"
    "With --name or --labels, files may be called anything, and DIR is one dataset with the actions as its "
    "classes.\n"
    "A body or joint at 0 0 0 was not seen, and is filled from the frames around. Where the Kinect lost a "
    "person and numbered\n"
    "them anew, or a ghost was seen longer than the actor, the summary names the clips and the option that "
    "mends them.\n"
    "An interrupted run goes on where it was when the same command is given again.\n";

}  // namespace actformer::ingest
