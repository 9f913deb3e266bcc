#include "model/generators/actformer/settings.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/train/key_table.hpp"
#include "model/train/shared_keys.hpp"

namespace actformer::model {
namespace {

/// What a configuration says of both networks; `persons` and `classes` are 0 where it leaves them to the dataset.
struct Networks {
    ActFormerGeneratorSettings g;
    ActFormerDiscriminatorSettings d;
    std::uint32_t persons = 0, classes = 0;
    bool shared_z = true;
};

void add_token_keys(KeyTable<Networks>& keys) {
    keys.add([](auto& n) -> auto& { return n.g.frames; },
             {.name = "frames",
              .meaning = "frames a window, and the most that can be generated",
              .least = fewest_frames,
              .most = 4096})
        .add([](auto& n) -> auto& { return n.g.width; },
             {.name = "width", .meaning = "numbers a token of the generator", .least = 2, .most = 8192})
        .add([](auto& n) -> auto& { return n.g.heads; },
             {.name = "heads", .meaning = "of attention; they divide the width", .least = 1, .most = 1024})
        .add([](auto& n) -> auto& { return n.g.depth; },
             {.name = "depth",
              .meaning = "pairs of I-Former and T-Former; for one person: T-Formers",
              .least = 1,
              .most = 64})
        .add([](auto& n) -> auto& { return n.g.mlp_ratio; },
             {.name = "mlp_ratio",
              .meaning = "inner width of a block, times its width",
              .least = 0.01,
              .most = 16});
}

void add_prior_keys(KeyTable<Networks>& keys) {
    keys.add([](auto& n) -> auto& { return n.g.prior.channels; },
             {.name = "latent", .meaning = "channels of the prior", .least = 1, .most = 8192})
        .add([](auto& n) -> auto& { return n.g.prior.kind; },
             {.name = "prior",
              .meaning = "gp: Gaussian processes over frames; gaussian: one vector a motion",
              .choices = {"gp", "gaussian"}})
        .add([](auto& n) -> auto& { return n.g.prior.length_scale; },
             {.name = "length_scale",
              .meaning = "frames, of the last channel's process",
              .least = 0.001,
              .most = 1e6})
        .add(&Networks::shared_z, {.name = "shared_z", .meaning = "one draw of the prior for all persons"});
}

void add_structure_keys(KeyTable<Networks>& keys) {
    keys.add([](auto& n) -> auto& { return n.g.positions; },
             {.name = "pe",
              .meaning = "positions: concat [frames, persons], tiled, independent or fixed",
              .choices = {"concat", "tiled", "independent", "fixed"}})
        .add([](auto& n) -> auto& { return n.g.positions_start; },
             {.name = "pe_start",
              .meaning =
                  "trained positions begin at: normal (deviation 0.02), or sinusoids unless independent",
              .choices = {"normal", "sinusoids"}})
        .add([](auto& n) -> auto& { return n.g.interaction; },
             {.name = "interaction",
              .meaning = "between persons: iformer, or concat for one token",
              .choices = {"iformer", "concat"}})
        .add([](auto& n) -> auto& { return n.g.body; },
             {.name = "body",
              .meaning = "from token to pose: transformer (linear) or graphconv",
              .choices = {"transformer", "graphconv"}})
        .add([](auto& n) -> auto& { return n.g.smooth; },
             {.name = "smooth",
              .meaning = "frames: deviation of a Gaussian over the tokens before the head; 0 for none",
              .least = 0,
              .most = 60})
        .add([](auto& n) -> auto& { return n.g.smooth_root; },
             {.name = "smooth_root",
              .meaning = "frames: deviation of a Gaussian over where the body is; 0 for none",
              .least = 0,
              .most = 60});
}

void add_discriminator_keys(KeyTable<Networks>& keys) {
    keys.add([](auto& n) -> auto& { return n.d.width; },
             {.name = "d_width",
              .meaning = "channels of the discriminator's first layer",
              .least = 1,
              .most = 1024})
        .add([](auto& n) -> auto& { return n.d.differences; },
             {.name = "d_differences",
              .meaning = "over frames, that the discriminator sees: 1 velocities, 2 accelerations too",
              .least = 1,
              .most = 2})
        .add([](auto& n) -> auto& { return n.d.pose_gain; },
             {.name = "d_poses",
              .meaning = "times the poses that the discriminator sees",
              .least = 0.01,
              .most = 100})
        .add([](auto& n) -> auto& { return n.d.difference_gain; },
             {.name = "d_gain",
              .meaning = "times the differences that the discriminator sees (its square times accelerations)",
              .least = 0.01,
              .most = 100})
        .add([](auto& n) -> auto& { return n.d.joint_gain; },
             {.name = "d_joints",
              .meaning = "times the velocities of joints, for the discriminator to see; 0: it sees none",
              .least = 0,
              .most = 1000})
        .add([](auto& n) -> auto& { return n.d.persons_in; },
             {.name = "d_persons",
              .meaning = "persons in the discriminator: concat, or pooled features",
              .choices = {"concat", "avgpool", "maxpool", "selfatt"}});
}

const KeyTable<Networks>& network_table() {
    static const auto all = [] {
        KeyTable<Networks> keys;
        add_subject_keys(keys);
        add_token_keys(keys);
        add_prior_keys(keys);
        add_structure_keys(keys);
        add_discriminator_keys(keys);
        return keys;
    }();
    return all;
}

void check_motion(const char* network, std::uint32_t nodes, std::uint32_t persons, std::uint32_t classes) {
    if (nodes < 2 || persons == 0 || classes == 0)
        throw Error("{}: {} nodes, {} persons and {} classes are too few", network, nodes, persons, classes);
}

}  // namespace

std::uint32_t ActFormerGeneratorSettings::hidden() const {
    return static_cast<std::uint32_t>(std::lround(width * mlp_ratio));
}

void check(const ActFormerGeneratorSettings& s) {
    check_motion("generator", s.nodes(), s.persons, s.classes);
    if (s.heads == 0 || s.width == 0 || s.width % s.heads != 0)
        throw Error("generator: heads: {} do not divide width: {}; as in width: {}", s.heads, s.width,
                    std::max(1U, s.width / std::max(1U, s.heads)) * std::max(1U, s.heads));
    if (s.width % 2 != 0)
        throw Error("generator: width: {} is odd; half of it is for frames and half for persons", s.width);
    if (s.depth == 0 || s.hidden() == 0 || s.frames == 0 || s.prior.channels == 0)
        throw Error("generator: depth, mlp_ratio, frames and latent must not be 0");
    if (!(s.prior.length_scale > 0)) throw Error("generator: length_scale must be above 0 frames");
    if (s.prior.streams != 1 && s.prior.streams != s.persons)
        throw Error("generator: {} latents for {} persons", s.prior.streams, s.persons);
    if (!(s.smooth >= 0)) throw Error("generator: smooth: {} frames; 0 or more", s.smooth);
    if (!(s.smooth_root >= 0)) throw Error("generator: smooth_root: {} frames; 0 or more", s.smooth_root);
}

void check(const ActFormerDiscriminatorSettings& s) {
    check_motion("discriminator", s.nodes(), s.persons, s.classes);
    if (s.numbers == 0) throw Error("discriminator: a node must have numbers");
    if (s.width == 0) throw Error("discriminator: d_width must not be 0");
}

std::vector<Key> actformer_keys() {
    return network_table().keys();
}

ActFormerGeneratorSettings actformer_generator_settings(const Config& config, const MotionSpec& spec) {
    check_subjects(config, spec.persons, spec.classes, spec.where);
    const auto networks = network_table().read(config);
    auto s = networks.g;
    s.parents = spec.representation.node_parents(spec.topology);
    s.representation = spec.representation;
    s.persons = spec.persons;
    s.classes = spec.classes;
    s.prior.streams = networks.shared_z ? 1 : s.persons;
    check(s);
    return s;
}

ActFormerDiscriminatorSettings actformer_discriminator_settings(const Config& config,
                                                                const MotionSpec& spec) {
    check_subjects(config, spec.persons, spec.classes, spec.where);
    auto s = network_table().read(config).d;
    s.parents = spec.representation.node_parents(spec.topology);
    s.persons = spec.persons;
    s.classes = spec.classes;
    s.numbers = spec.numbers();
    if (s.joint_gain > 0) s.motions = spec;
    check(s);
    return s;
}

}  // namespace actformer::model
