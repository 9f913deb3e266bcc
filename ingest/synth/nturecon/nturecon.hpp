// A stand-in for NTURecon-1P: SMPL fits of AIST++'s tools to the one-person actions of NTU RGB+D, a pickle a clip.
#pragma once

#include <string>

#include "ingest/synth/ntu/naming.hpp"
#include "ingest/synth/stand_in.hpp"

namespace actformer::ingest::synth {

/// Writes motions/Ssss/NAME_body0.pkl.
StandInSummary synthesise_nturecon(const StandInOptions& options);

/// A clip's file: smpl_poses (T, 72) rad, smpl_trans (T, 3) and smpl_scaling (1), units a metre; y is down. `frames` becomes T.
std::string nturecon_pickle(const ClipId& clip, std::uint64_t seed, std::uint64_t& frames);

}  // namespace actformer::ingest::synth
