// Poses as the networks see them and motions as datasets have them. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include "model/generators/action2motion/settings.hpp"

namespace actformer::model::action2motion {

/// A pose is node after node, a node's numbers person after person. A Lie body's networks see joints whatever the motions are.
class MotionNumbers {
  public:
    /// Throws Error, beginning with `where`, where a Lie body's bone lengths are not known.
    MotionNumbers(const Settings& settings, const std::string& where);

    /// Motions (N, P*D, T, K) -> poses (T, N, K*P*D).
    at::Tensor poses(const at::Tensor& motions) const;

    /// Back, with what the representation makes of a network's numbers.
    at::Tensor motions(const at::Tensor& poses) const;

    /// (N, joints) of a Lie body: the dataset's mean lengths. Undefined for others.
    at::Tensor bones(std::int64_t motions) const;

  private:
    bool is_lie() const { return settings_.body == Body::lie; }

    Settings settings_;
};

}  // namespace actformer::model::action2motion
