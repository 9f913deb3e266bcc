// What ACTOR is made of and how it is trained (Petrovich et al., ICCV 2021), and the configuration's keys that say so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/sampler.hpp"
#include "model/generators/method.hpp"
#include "model/nn/adam_settings.hpp"

namespace actformer::model {

/// Frames that a motion may have at most: positions are sinusoids, so none was too long for training alone.
constexpr std::uint32_t most_actor_frames = 4096;

struct ActorSettings {
    ingest::Representation representation;
    std::uint32_t nodes = 0, persons = 1, classes = 0;
    std::uint32_t width = 256;  ///< of a token and of the latent vector
    std::uint32_t heads = 4, layers = 8, hidden = 1024;
    double dropout = 0.1;

    /// Numbers of a frame: a node's numbers of all persons, node after node.
    std::int64_t numbers() const { return std::int64_t{nodes} * persons * representation.numbers(); }
    bool operator==(const ActorSettings&) const = default;
};

enum class PointLoss {
    automatic,  ///< joints where motions are rotations
    joints,     ///< of the rest skeleton, turned by forward kinematics
    none
};

struct ActorTraining {
    std::uint32_t frames = 60, batch = 20;
    std::uint64_t seed = 0;
    double rate = 1e-4, weight_decay = 0.01;
    double kl_weight = 1e-5;  ///< of the sum over a batch of 20; others as much a motion
    PointLoss points = PointLoss::automatic;
    kernels::Padding padding = kernels::Padding::back_and_forth;
    double average = 0;  ///< decay a step of the EMA; 0 keeps none

    AdamSettings adam() const { return {rate, 0.9, 0.999, 1e-8, weight_decay}; }

    /// By which the sum over a batch of the divergences is multiplied.
    double kl_factor() const;
};

std::vector<Key> actor_keys();

/// Throw Error where the configuration asks for other persons or classes than the motions have, or for what cannot be built:
/// heads that do not divide the width, points of motions that are no rotations.
ActorSettings actor_settings(const Config& config, const MotionSpec& spec);
ActorTraining actor_training(const Config& config, const MotionSpec& spec);

}  // namespace actformer::model
