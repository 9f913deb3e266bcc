// Where the joints of motions are, in any representation. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <optional>

#include "model/generators/method.hpp"
#include "model/generators/rest_joints.hpp"
#include "model/nn/constant.hpp"

namespace actformer::model {

class JointPositions {
  public:
    /// Bodies are all as large as the first of `spec`. Throws Error, beginning with spec.where, where limbs have no bone lengths or
    /// rotations no rest skeleton.
    explicit JointPositions(const MotionSpec& spec);

    /// motion (N, P*D, T, K), of any number of persons -> metres (N, P*3, T, joints), person by person; differentiable.
    at::Tensor of(const at::Tensor& motion) const;

  private:
    ingest::Representation representation_;
    Constant limbs_to_joints_;  ///< (K, joints) metres: what a limb adds to each joint's position
    std::optional<RestJoints> rest_;
};

}  // namespace actformer::model
