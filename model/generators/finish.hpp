// What a representation makes of numbers that a network gives for a node. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include "ingest/dataset/representation.hpp"

namespace actformer::model {

/// numbers (..., K, D): limbs divided by (length + 1e-4), rotations made orthonormal by Gram and Schmidt.
at::Tensor normalised(const at::Tensor& numbers, ingest::Finish finish);

/// A network's numbers (..., K, D) as a motion's: normalised, but the free node has its position as they are, and 0 behind it.
at::Tensor finished(const at::Tensor& numbers, ingest::Representation representation);

/// The same of tanh of the numbers, the free node's apart; where nothing is normalised, the numbers as they are.
at::Tensor bounded_finish(const at::Tensor& numbers, ingest::Representation representation);

/// poses (N, P, T, K, D) -> motion (N, P*D, T, K).
at::Tensor motion_layout(const at::Tensor& poses);

}  // namespace actformer::model
