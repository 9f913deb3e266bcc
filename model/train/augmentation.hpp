// Windows as other bodies could have moved: mirrored, and turned about the vertical. For small datasets. Includes torch headers.
//
// A discriminator that sees real and fake motions through the same random augmentation teaches the generator what is real without learning
// the few clips by heart (Zhao et al., "Differentiable Augmentation", NeurIPS 2020). As long as less than half of the windows are mirrored and
// less than all are turned, the generator still learns the motions as they were recorded (Karras et al., "Training Generative
// Adversarial Networks with Limited Data", NeurIPS 2020, section 3).
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/dataset/representation.hpp"
#include "ingest/dataset/topology.hpp"
#include "model/train/augmentation_settings.hpp"

namespace actformer::model {

class Augmentation {
  public:
    /// Does nothing.
    Augmentation() = default;
    /// Throws Error, beginning with `where`, where bodies of `topology` cannot be mirrored and the settings ask for it.
    Augmentation(const AugmentationSettings& settings, ingest::Representation representation,
                 const ingest::Topology& topology, const std::string& where);

    /// Motions (N, P*D, T, K), each augmented as the random numbers of `seed` decide, all persons of a motion alike. Gradients pass.
    at::Tensor operator()(const at::Tensor& motion, std::uint64_t seed) const;

  private:
    at::Tensor mirrored(const at::Tensor& motion) const;  ///< (N, P, D, T, K)
    at::Tensor turned(const at::Tensor& motion, const at::Tensor& sine,
                      const at::Tensor& cosine) const;  ///< the same

    AugmentationSettings settings_;
    ingest::Representation representation_;
    std::vector<std::int64_t> other_;  ///< node of the other side
};

}  // namespace actformer::model
