// What a representation makes of numbers that a network gives for a node. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include "ingest/dataset/representation.hpp"

namespace actformer::model {

/// numbers (..., K, D): limbs divided by (length + 1e-4), rotations made orthonormal by Gram and Schmidt.
at::Tensor normalised(const at::Tensor& numbers, ingest::Finish finish);

/// `normal` with the free node's position as `numbers` have it, and 0 behind it; both (..., K, D).
at::Tensor with_position(const at::Tensor& normal, const at::Tensor& numbers,
                         ingest::Representation representation);

/// Both: a network's numbers (..., K, D) as a motion's.
inline at::Tensor finished(const at::Tensor& numbers, ingest::Representation representation) {
    return with_position(normalised(numbers, representation.finish()), numbers, representation);
}

}  // namespace actformer::model
