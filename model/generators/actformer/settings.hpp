// What ActFormer's generator and discriminator are made of (Xu, Song et al., ICCV 2023), and the configuration's keys that say so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/dataset/representation.hpp"
#include "model/generators/adversarial/prior_settings.hpp"
#include "model/generators/method.hpp"
#include "model/train/config.hpp"

namespace actformer::model {

enum class Positions {
    concat,       ///< [one table over frames, one over persons]
    tiled,        ///< a table over both, started from such a tiling
    independent,  ///< a table over both, every number started on its own
    fixed         ///< sinusoids, [over frames, over persons]; not trained
};

enum class PositionsStart {
    normal,    ///< of deviation 0.02, as in the public tools
    sinusoids  ///< those of `fixed`: neighbouring frames are alike from the first step on
};

enum class Interaction {
    iformer,  ///< attention over the persons of a frame, before every attention over frames
    concat    ///< one token a frame for all persons; the persons part in the last layer
};

enum class Body {
    transformer,  ///< a frame's token gives its pose in one linear layer
    graphconv     ///< a frame's token becomes the coarse graph; graph convolutions upsample it to the nodes
};

struct ActFormerGeneratorSettings {
    std::vector<int> parents;  ///< of the nodes of the representation, -1 for the root
    ingest::Representation representation;
    std::uint32_t persons = 1, classes = 0;
    std::uint32_t frames = 60;  ///< of the table of positions: no motion can be longer
    std::uint32_t width = 200, heads = 8, depth = 2;
    double mlp_ratio = 2;
    PriorSettings prior;
    Positions positions = Positions::tiled;
    PositionsStart positions_start = PositionsStart::normal;  ///< of tables that are trained
    Interaction interaction = Interaction::iformer;
    Body body = Body::transformer;
    /// Frames: deviations of a Gaussian over the tokens before the head, and of one over where the body is; 0 for none, as
    /// published.
    double smooth = 0, smooth_root = 0;

    std::uint32_t nodes() const { return static_cast<std::uint32_t>(parents.size()); }
    std::uint32_t numbers() const { return representation.numbers(); }  ///< of a node
    std::uint32_t hidden() const;                                       ///< width of the blocks' inner layer
    /// Persons that have tokens of their own: 1 where all share one.
    std::uint32_t tokens_a_frame() const { return interaction == Interaction::concat ? 1 : persons; }
    bool operator==(const ActFormerGeneratorSettings&) const = default;
};

enum class PersonsInD {
    concat,   ///< side by side on the channels
    avgpool,  ///< each on its own, their features' mean
    maxpool,  ///< their features' maximum
    selfatt   ///< their features' mean behind an attention over the persons
};

struct ActFormerDiscriminatorSettings {
    std::vector<int> parents;  ///< as the generator's
    std::uint32_t persons = 1, classes = 0;
    std::uint32_t numbers = 3;  ///< of a node
    std::uint32_t width = 32;   ///< channels of the first layer; each of the four behind it doubles them
    std::uint32_t differences =
        1;  ///< the highest differences over frames behind the channels: 1 velocities, 2 accelerations too
    double pose_gain = 1;        ///< times the poses themselves
    double difference_gain = 1;  ///< times the first differences, its square times the second
    double joint_gain = 0;       ///< times the velocities of joints, behind the differences; 0: it sees none
    MotionSpec motions;          ///< where joint_gain is not 0: whose joints
    PersonsInD persons_in = PersonsInD::concat;

    std::uint32_t nodes() const { return static_cast<std::uint32_t>(parents.size()); }
    std::uint32_t features() const { return 16 * width; }
};

/// Frames that leave at least one to the discriminator's last layer.
constexpr std::uint32_t fewest_frames = 16;

/// Throw Error where the settings describe no network.
void check(const ActFormerGeneratorSettings& settings);
void check(const ActFormerDiscriminatorSettings& settings);

/// The configuration's keys that decide on the networks, with the paper's values.
std::vector<Key> actformer_keys();

/// The networks of a configuration that holds actformer_keys(). Throw Error where the configuration asks for other persons or classes, or
/// for what cannot be built (heads that do not divide the width).
ActFormerGeneratorSettings actformer_generator_settings(const Config& config, const MotionSpec& spec);
ActFormerDiscriminatorSettings actformer_discriminator_settings(const Config& config, const MotionSpec& spec);

}  // namespace actformer::model
