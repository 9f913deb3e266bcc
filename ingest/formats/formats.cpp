#include "ingest/formats/formats.hpp"

#include <array>

#include "ingest/formats/babel/babel_command.hpp"
#include "ingest/formats/bvh/bvh_command.hpp"
#include "ingest/formats/gta/gta_command.hpp"
#include "ingest/formats/humanact12/humanact12_command.hpp"
#include "ingest/formats/motions/motions_command.hpp"
#include "ingest/formats/ntu/ntu_command.hpp"
#include "ingest/formats/ntu13/ntu13_command.hpp"
#include "ingest/formats/nturecon/nturecon_command.hpp"
#include "ingest/formats/uestc/uestc_command.hpp"

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
    FormatEntry{"ntu13", "NTU-13: joblib files of VIBE and ntu_vibe_list.txt -> the dataset DIR",
                ntu13_examples, make<Ntu13Command>},
    FormatEntry{"nturecon", "NTURecon-1P: pickles with AIST++'s keys -> the dataset DIR", nturecon_examples,
                make<NtuReconCommand>},
    FormatEntry{"humanact12", "HumanAct12: humanact12poses.pkl, or a .npy a clip -> the dataset DIR",
                humanact12_examples, make<HumanAct12Command>},
    FormatEntry{"uestc", "UESTC: vibe_cache_refined.pkl and info/ -> the dataset DIR", uestc_examples,
                make<UestcCommand>},
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
