#include "model/generators/actformer/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "model/generators/generator_settings.hpp"

namespace actformer::model {
namespace {

/// The names of an enumeration's values, in their order.
const std::vector<std::string> prior_names{"gp", "gaussian"};
const std::vector<std::string> position_names{"concat", "tiled", "independent", "fixed"};
const std::vector<std::string> start_names{"normal", "sinusoids"};
const std::vector<std::string> interaction_names{"iformer", "concat"};
const std::vector<std::string> body_names{"transformer", "graphconv"};
const std::vector<std::string> persons_names{"concat", "avgpool", "maxpool", "selfatt"};

template <typename Enum>
Enum named(const Config& config, const char* key, const std::vector<std::string>& names) {
    const auto found = std::find(names.begin(), names.end(), config.get<std::string>(key));
    return static_cast<Enum>(found - names.begin());
}

std::uint32_t whole(const Config& config, const char* key) {
    return static_cast<std::uint32_t>(config.get<std::int64_t>(key));
}

void check_motion(const char* network, std::uint32_t nodes, std::uint32_t persons, std::uint32_t classes) {
    if (nodes < 2 || persons == 0 || classes == 0)
        throw Error("{}: {} nodes, {} persons and {} classes are too few", network, nodes, persons, classes);
}

}  // namespace

std::uint32_t GeneratorSettings::hidden() const {
    return static_cast<std::uint32_t>(std::lround(width * mlp_ratio));
}

void check(const GeneratorSettings& s) {
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

void check(const DiscriminatorSettings& s) {
    check_motion("discriminator", s.nodes(), s.persons, s.classes);
    if (s.numbers == 0) throw Error("discriminator: a node must have numbers");
    if (s.width == 0) throw Error("discriminator: d_width must not be 0");
}

std::vector<Key> network_keys() {
    using Number = std::int64_t;
    return {
        {"persons", Number{0}, "persons a clip; 0 takes the dataset's", 0, 16},
        {"classes", Number{0}, "classes; 0 takes the dataset's", 0, 100000},
        {"frames", Number{60}, "frames a window, and the most that can be generated", fewest_frames, 4096},
        {"width", Number{200}, "numbers a token of the generator", 2, 8192},
        {"heads", Number{8}, "of attention; they divide the width", 1, 1024},
        {"depth", Number{2}, "pairs of I-Former and T-Former; for one person: T-Formers", 1, 64},
        {"mlp_ratio", 2.0, "inner width of a block, times its width", 0.01, 16},
        {"latent", Number{120}, "channels of the prior", 1, 8192},
        {"prior", std::string("gp"), "gp: Gaussian processes over frames; gaussian: one vector a motion", 0,
         0, prior_names},
        {"length_scale", 100.0, "frames, of the last channel's process", 0.001, 1e6},
        {"shared_z", true, "one draw of the prior for all persons"},
        {"pe", std::string("tiled"), "positions: concat [frames, persons], tiled, independent or fixed", 0, 0,
         position_names},
        {"pe_start", std::string("normal"),
         "trained positions begin at: normal (deviation 0.02), or sinusoids unless independent", 0, 0,
         start_names},
        {"interaction", std::string("iformer"), "between persons: iformer, or concat for one token", 0, 0,
         interaction_names},
        {"body", std::string("transformer"), "from token to pose: transformer (linear) or graphconv", 0, 0,
         body_names},
        {"smooth", 0.0, "frames: deviation of a Gaussian over the tokens before the head; 0 for none", 0, 60},
        {"smooth_root", 0.0, "frames: deviation of a Gaussian over where the body is; 0 for none", 0, 60},
        {"d_width", Number{32}, "channels of the discriminator's first layer", 1, 1024},
        {"d_differences", Number{1},
         "over frames, that the discriminator sees: 1 velocities, 2 accelerations too", 1, 2},
        {"d_poses", 1.0, "times the poses that the discriminator sees", 0.01, 100},
        {"d_gain", 1.0, "times the differences that the discriminator sees (its square times accelerations)",
         0.01, 100},
        {"d_joints", 0.0, "times the velocities of joints, for the discriminator to see; 0: it sees none", 0,
         1000},
        {"d_persons", std::string("concat"), "persons in the discriminator: concat, or pooled features", 0, 0,
         persons_names}};
}

GeneratorSettings generator_settings(const Config& config, const MotionSpec& spec) {
    check_subjects(config, spec.persons, spec.classes, spec.where);
    GeneratorSettings s;
    s.parents = spec.representation.node_parents(spec.topology);
    s.persons = spec.persons;
    s.classes = spec.classes;
    s.representation = spec.representation;
    s.frames = whole(config, "frames");
    s.width = whole(config, "width");
    s.heads = whole(config, "heads");
    s.depth = whole(config, "depth");
    s.mlp_ratio = config.get<double>("mlp_ratio");
    s.prior.kind = named<PriorKind>(config, "prior", prior_names);
    s.prior.channels = whole(config, "latent");
    s.prior.length_scale = config.get<double>("length_scale");
    s.prior.streams = config.get<bool>("shared_z") ? 1 : s.persons;
    s.positions = named<Positions>(config, "pe", position_names);
    s.positions_start = named<PositionsStart>(config, "pe_start", start_names);
    s.interaction = named<Interaction>(config, "interaction", interaction_names);
    s.body = named<Body>(config, "body", body_names);
    s.smooth = config.get<double>("smooth");
    s.smooth_root = config.get<double>("smooth_root");
    check(s);
    return s;
}

DiscriminatorSettings discriminator_settings(const Config& config, const MotionSpec& spec) {
    check_subjects(config, spec.persons, spec.classes, spec.where);
    DiscriminatorSettings s;
    s.parents = spec.representation.node_parents(spec.topology);
    s.persons = spec.persons;
    s.classes = spec.classes;
    s.numbers = spec.numbers();
    s.width = whole(config, "d_width");
    s.differences = whole(config, "d_differences");
    s.pose_gain = config.get<double>("d_poses");
    s.difference_gain = config.get<double>("d_gain");
    s.joint_gain = config.get<double>("d_joints");
    if (s.joint_gain > 0) s.motions = spec;
    s.persons_in = named<PersonsInD>(config, "d_persons", persons_names);
    check(s);
    return s;
}

}  // namespace actformer::model
