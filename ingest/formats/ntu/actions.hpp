// The 120 actions of NTU RGB+D, numbered from 1 as in the file names.
#pragma once

#include <string_view>

namespace actformer::ingest::ntu {

constexpr int actions = 120;

/// "drink water" for 1. Throws Error outside 1..120.
std::string_view action_name(int action);

/// Actions 50-60 and 106-120 show two persons.
bool two_persons(int action);

/// A performer whose clips the cross-subject protocol trains on.
bool xsub_train(int performer);

}  // namespace actformer::ingest::ntu
