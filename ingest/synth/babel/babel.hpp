// A stand-in for BABEL on AMASS: long recordings of several actions each, at AMASS's rates, with BABEL's labels.
#pragma once

#include "ingest/synth/stand_in.hpp"

namespace actformer::ingest::synth {

/// amass/SET/SUBJECT/TRIAL_poses.npz in the layout of AMASS's package SMPL+H G: poses (N, 156) rad, trans (N, 3) metres, z up, and
/// babel_v1.0_release/{train,val}.json. `options.clips` are the labelled actions: frequent categories have many, all have some in both
/// files where there are 960 or more. Labels overlap, are not sorted, and some end behind their recording.
StandInSummary synthesise_babel(const StandInOptions& options);

}  // namespace actformer::ingest::synth
