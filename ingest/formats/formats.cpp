#include "ingest/formats/formats.hpp"

#include <array>

#include "ingest/formats/babel/babel_command.hpp"
#include "ingest/formats/bvh/bvh_command.hpp"
#include "ingest/formats/gta/gta_command.hpp"
#include "ingest/formats/motions/motions_command.hpp"
#include "ingest/formats/ntu/ntu_command.hpp"

namespace actformer::ingest {
namespace {

template <typename Command>
std::unique_ptr<IngestCommand> make() {
    return std::make_unique<Command>();
}

constexpr std::array entries{
    FormatEntry{"ntu", "NTU RGB+D .skeleton files -> DIR/ntu-1p and DIR/ntu-2p", ntu_examples,
                make<NtuCommand>},
    FormatEntry{"bvh", "BVH and ASF/AMC files of one skeleton -> the dataset DIR", bvh_examples,
                make<BvhCommand>},
    FormatEntry{"babel", "AMASS archives, cut into clips by BABEL's labels -> the dataset DIR",
                babel_examples, make<BabelCommand>},
    FormatEntry{"gta", "GTA Combat's .h5 files and JTA's annotations -> DIR/gta-2p, DIR/gta-3p, ...",
                gta_examples, make<GtaCommand>},
    FormatEntry{
        "motions",
        "Arrays of joints (.npy, .npz, .csv, .h5) and motions in the public layout -> the dataset DIR",
        motions_examples, make<MotionsCommand>},
};

}  // namespace

std::span<const FormatEntry> formats() {
    return entries;
}

}  // namespace actformer::ingest
