// What Action2Motion's networks are made of and how they train (Guo et al., ACM Multimedia 2020), and the configuration's keys that
// say so.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/sampler.hpp"
#include "model/generators/method.hpp"
#include "model/nn/adam_settings.hpp"

namespace actformer::model::action2motion {

enum class Body {
    plain,  ///< the decoder gives a pose's numbers
    lie  ///< it gives the root's position and the joints' rotations along chains of bones (the paper's section 3.3)
};

enum class Feedback {
    raw,    ///< the decoder's own output is the next frame's input: with a Lie body rotations, as published
    joints  ///< with a Lie body the joints' positions are
};

struct Settings {
    std::uint32_t persons = 0, classes = 0, frames = 60;
    std::uint32_t hidden = 128, latent = 30;
    bool time_counter = true;  ///< a frame's share of the motion is among the inputs
    Body body = Body::plain;
    Feedback feedback = Feedback::raw;
    double tf_ratio = 0.6;     ///< share of batches whose inputs are the decoder's own outputs
    double lambda_kl = 0.001;  ///< of the Kullback-Leibler divergence in the loss
    double rate = 2e-4, beta1 = 0.9, beta2 = 0.999;
    double weight_decay = 1e-5;  ///< added to the gradient, times the weight
    kernels::Padding padding = kernels::Padding::back_and_forth;
    double average = 0;  ///< decay a step of the EMA; 0 keeps none
    std::uint64_t seed = 0;

    ingest::Representation representation;
    ingest::Topology topology;
    std::vector<float> bone_length;  ///< (joints) of a Lie body, metres

    std::int64_t nodes() const { return representation.nodes(topology); }
    std::int64_t channels() const { return std::int64_t{persons} * representation.numbers(); }
    std::int64_t numbers() const { return nodes() * channels(); }  ///< of a pose, D
    /// Numbers of a pose, a class and a time.
    std::int64_t inputs() const { return numbers() + classes + (time_counter ? 1 : 0); }
    AdamSettings adam() const { return {rate, beta1, beta2}; }
};

std::vector<Key> keys();

/// Of a configuration that holds the keys and `seed`, for what `spec` says. Throws Error, beginning with spec.where, where the
/// configuration asks for other persons or classes, or for a Lie body on motions that have no chains.
Settings settings_of(const Config& config, const MotionSpec& spec);

}  // namespace actformer::model::action2motion
