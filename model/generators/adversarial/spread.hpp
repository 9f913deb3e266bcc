// How far apart the motions of a class are. A generator that gives one motion for a class, whatever its latent, satisfies a
// discriminator that looks at one motion at a time. Mode-seeking losses (Mao et al., "Mode Seeking Generative Adversarial Networks for
// Diverse Image Synthesis", 2019) keep what two latents give apart without end; here real motions say how far.
#pragma once

#include <ATen/core/Tensor.h>

namespace actformer::model {

/// Mean distances between motions of one class, for each of their numbers: motion (batch, D, T, K), labels (batch) int64; (D, K), in
/// the motion's units. Each motion is compared with the next of its class in the batch; 0 where no class has two.
at::Tensor class_spread(const at::Tensor& motion, const at::Tensor& labels);

/// Mean over a motion's numbers of max(0, log of real over fake spread): 0 where fake motions of a class are as far apart as real
/// ones. Same shapes and labels. A scalar, float32.
at::Tensor spread_loss(const at::Tensor& real, const at::Tensor& fake, const at::Tensor& labels);

}  // namespace actformer::model
