// Chains of bones for forward kinematics (Action2Motion, section 3.3), and how a bone points where nothing is rotated.
// Knows nothing of torch.
#pragma once

#include <optional>
#include <vector>

#include "model/cpu/chain_kernel.hpp"

namespace actformer::model::action2motion {

using cpu::Chains;

/// Those of a tree; none where it is neither NTU RGB+D's of 25 joints, SMPL's of 24 nor NTU-13's of 18.
std::optional<Chains> chains_of(const std::vector<int>& parents);

}  // namespace actformer::model::action2motion
