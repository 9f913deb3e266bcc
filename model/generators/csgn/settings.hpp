// What CSGN's generator and discriminator are made of, and the configuration's keys that say so. CSGN (Yan et al., Convolutional
// Sequence Generation for Skeleton-Based Action Synthesis, ICCV 2019) published neither sizes nor code: these networks are a
// reconstruction from its description, from what the ActFormer paper says of its own conditional variant, and from the tools
// that came with ActFormer.
#pragma once

#include <cstdint>
#include <vector>

#include "ingest/dataset/representation.hpp"
#include "model/generators/adversarial/prior_settings.hpp"
#include "model/generators/method.hpp"

namespace actformer::model {

enum class Partition {
    radial,  ///< weights of their own for a node itself, for neighbours nearer the body's centre and for those farther out
    none  ///< for a node itself and for its neighbours
};

struct CsgnSettings {
    std::uint32_t persons = 0, classes = 0, frames = 60;
    std::uint32_t width =
        32;  ///< channels of the generator's finest level; each of the three before it has twice as many
    std::uint32_t d_width =
        32;  ///< of the discriminator's first; each of the four behind it has twice as many
    std::uint32_t latent = 512;  ///< channels of the prior
    double length_scale = 5;     ///< latent frames, of the prior's last channel
    Partition partition = Partition::radial;

    std::vector<int> parents;  ///< of the nodes of the representation, -1 for the root
    ingest::Representation representation;

    std::uint32_t nodes() const { return static_cast<std::uint32_t>(parents.size()); }
    std::uint32_t channels() const { return persons * representation.numbers(); }  ///< of a motion
    std::uint32_t features() const { return 16 * d_width; }                        ///< of the discriminator
    PriorSettings prior() const;
    bool operator==(const CsgnSettings&) const = default;
};

/// The generator doubles its frames so often, beginning with the latent's.
constexpr std::uint32_t doublings = 4, frames_a_latent = 1U << doublings;

/// Frames of latents for motions of `frames` frames: what is generated beyond is cropped, half of it on either side.
constexpr std::uint32_t latent_frames(std::uint32_t frames) {
    return (frames + frames_a_latent - 1) / frames_a_latent;
}

/// Frames that leave at least one to the discriminator's last layer.
constexpr std::uint32_t csgn_fewest_frames = 16;

std::vector<Key> csgn_keys();

/// Throws Error, beginning with spec.where, where the configuration asks for other persons or classes.
CsgnSettings csgn_settings(const Config& config, const MotionSpec& spec);

/// Throws Error where the settings describe no network.
CsgnSettings checked(CsgnSettings settings);

}  // namespace actformer::model
