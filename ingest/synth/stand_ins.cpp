#include <array>

#include "ingest/synth/babel/babel.hpp"
#include "ingest/synth/gta/gta.hpp"
#include "ingest/synth/humanact12/humanact12.hpp"
#include "ingest/synth/ntu13/ntu13.hpp"
#include "ingest/synth/nturecon/nturecon.hpp"
#include "ingest/synth/stand_in.hpp"
#include "ingest/synth/uestc/uestc.hpp"

namespace actformer::ingest::synth {

std::span<const StandIn> stand_ins() {
    static constexpr std::array all{
        StandIn{"babel",
                "AMASS recordings (.npz) with BABEL's labels: 120 categories, frequent and rare ones", 1800,
                "labelled actions, two to five a recording", synthesise_babel,
                "  actformer synth babel -o raw && actformer ingest babel raw -o babel\n"},
        StandIn{"ntu13", "VIBE's output (.pkl) for 13 actions of NTU RGB+D", 520, "the classes taking turns",
                synthesise_ntu13, "  actformer synth ntu13 -o raw && actformer ingest ntu13 raw -o ntu13\n"},
        StandIn{"humanact12", "humanact12poses.pkl, as ACTOR reads it: 12 classes", 480,
                "the classes taking turns", synthesise_humanact12,
                "  actformer synth humanact12 -o raw && actformer ingest humanact12 raw -o humanact12\n"},
        StandIn{"nturecon", "SMPL fits to NTU RGB+D (AIST++'s .pkl): 94 actions of one person", 2820,
                "the actions taking turns", synthesise_nturecon,
                "  actformer synth nturecon -o raw && actformer ingest nturecon raw -o nturecon-1p\n"},
        StandIn{"uestc", "VIBE's output (vibe_cache_refined.pkl) for 40 exercises, seen from eight sides",
                1200, "the classes taking turns", synthesise_uestc,
                "  actformer synth uestc -o raw && actformer ingest uestc raw -o uestc\n"},
        StandIn{"gta", "Groups of 2 to 5 who fight, in the layout of GTA Combat (.h5)", 640,
                "groups of two the most", synthesise_gta,
                "  actformer synth gta -o raw && actformer ingest gta raw -o gta\n"}};
    return all;
}

}  // namespace actformer::ingest::synth
