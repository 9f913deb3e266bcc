// The 120 actions of NTU RGB+D, numbered from 1 as in the file names.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest::ntu {

constexpr int actions = 120;

/// "drink water" for 1. Throws Error outside 1..120.
std::string_view action_name(int action);

/// Actions 50-60 and 106-120 show two persons.
bool two_persons(int action);

/// The names of all actions of one person, or of two, in the order of their numbers: the classes of a dataset of `persons`.
std::vector<std::string> class_names(int persons);

/// The place of an action among those of as many persons, from 0.
std::uint32_t label_of(int action);

/// A performer whose clips the cross-subject protocol trains on.
bool xsub_train(int performer);

}  // namespace actformer::ingest::ntu
