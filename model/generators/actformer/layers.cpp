#include "model/generators/actformer/layers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace actformer::model {
namespace {

/// Deviation that tables of positions start with.
constexpr double position_deviation = 0.02;

/// Collects weights layer by layer.
class List {
  public:
    void linear(const std::string& name, std::int64_t out, std::int64_t in) {
        spectral(name, {out, in}, out, in, true);
    }
    /// A weight whose last `inputs` numbers go into one output, and its bias of `out` where it has one.
    void spectral(const std::string& name, std::vector<std::int64_t> shape, std::int64_t rows,
                  std::int64_t inputs, bool bias) {
        const double bound = 1 / std::sqrt(static_cast<double>(inputs));
        list_.push_back({name + ".weight", std::move(shape), Init::uniform, bound, true, rows});
        if (bias) list_.push_back({name + ".bias", {rows}, Init::uniform, bound});
    }
    void norm(const std::string& name, std::int64_t width, bool spectral) {
        list_.push_back({name + ".weight", {width}, Init::ones, 0, spectral, width});
        list_.push_back({name + ".bias", {width}, Init::zeros});
    }
    void add(NetworkWeight weight) { list_.push_back(std::move(weight)); }
    std::vector<NetworkWeight> take() { return std::move(list_); }

  private:
    std::vector<NetworkWeight> list_;
};

void add_positions(List& list, const ActFormerGeneratorSettings& s) {
    const std::int64_t tokens = s.frames + 1, persons = s.tokens_a_frame(), width = s.width;
    const bool trained = s.positions != Positions::fixed;
    // Numbers that all start on their own are what `independent` is about.
    const bool smooth =
        !trained || (s.positions_start == PositionsStart::sinusoids && s.positions != Positions::independent);
    const auto table = [&](const char* name, std::vector<std::int64_t> shape, Init init) {
        list.add({name, std::move(shape), init, position_deviation, false, 0, trained});
    };
    if (s.positions == Positions::concat && persons > 1) {
        table("frame_positions", {tokens, width / 2}, smooth ? Init::frame_sinusoids : Init::normal);
        table("person_positions", {persons, width / 2}, smooth ? Init::person_sinusoids : Init::normal);
        return;
    }
    const auto init = smooth                                           ? Init::sinusoids
                      : s.positions == Positions::tiled && persons > 1 ? Init::tiling
                                                                       : Init::normal;
    table("positions", {tokens, persons, width}, init);
}

void add_block(List& list, const std::string& prefix, const ActFormerGeneratorSettings& s) {
    const std::int64_t width = s.width, hidden = s.hidden();
    list.norm(prefix + "norm1", width, false);
    list.linear(prefix + "qkv", 3 * width, width);
    list.linear(prefix + "proj", width, width);
    list.norm(prefix + "norm2", width, false);
    list.linear(prefix + "up", hidden, width);
    list.linear(prefix + "down", width, hidden);
}

std::int64_t persons_a_token(const ActFormerGeneratorSettings& s) {
    return s.persons / s.tokens_a_frame();
}

void add_head(List& list, const ActFormerGeneratorSettings& s) {
    const std::int64_t parting = persons_a_token(s);
    if (s.body == Body::transformer) return list.linear("head", parting * s.nodes() * s.numbers(), s.width);
    const GraphBody channels;
    const auto coarse = static_cast<std::int64_t>(skeleton_levels(s.parents).coarse_kept.size());
    list.linear("to_graph", parting * coarse * channels.coarse, s.width);
    list.linear("up1", 2 * std::int64_t{channels.middle}, channels.coarse);
    list.linear("up2", 2 * std::int64_t{channels.fine}, channels.middle);
    list.linear("graph", 2 * std::int64_t{channels.fine}, channels.fine);
    list.linear("head", s.nodes() * s.numbers(),
                channels.fine);  // each node its own: neighbours in the graph look alike
}

const char* head_kind(ingest::Finish finish) {
    switch (finish) {
        case ingest::Finish::unit:
            return "linear, tanh, unit limbs";
        case ingest::Finish::orthonormal:
            return "linear, tanh, Gram-Schmidt";
        case ingest::Finish::linear:
            break;
    }
    return "linear";
}

std::string layer_name(std::size_t i) {
    return fmt::format("convs.{}", i);
}

}  // namespace

std::vector<bool> interacting_blocks(const ActFormerGeneratorSettings& settings) {
    std::vector<bool> blocks;
    for (std::uint32_t i = 0; i < settings.depth; ++i) {
        if (settings.tokens_a_frame() > 1) blocks.push_back(true);
        blocks.push_back(false);
    }
    return blocks;
}

std::vector<NetworkWeight> actformer_generator_weights(const ActFormerGeneratorSettings& s) {
    List list;
    const auto streams = s.interaction == Interaction::concat ? s.prior.streams : 1;
    list.linear("input", s.width, std::int64_t{streams} * s.prior.channels);
    list.add({"classes.weight", {s.classes, s.width}, Init::orthogonal});
    add_positions(list, s);
    const auto blocks = interacting_blocks(s).size();
    for (std::size_t i = 0; i < blocks; ++i) add_block(list, fmt::format("blocks.{}.", i), s);
    list.norm("norm", s.width, true);
    add_head(list, s);
    return list.take();
}

std::vector<NodeConvolution> node_convolutions(const ActFormerDiscriminatorSettings& s) {
    const auto levels = skeleton_levels(s.parents);
    const auto seen = s.persons_in == PersonsInD::concat ? s.persons : 1;
    const auto c = s.width;
    const auto axes_of_joints = s.joint_gain > 0 ? 3U : 0U;
    return {{((1 + s.differences) * s.numbers + axes_of_joints) * seen, c, 5, 1, 2, true,
             hop_matrix(levels.fine, all_nodes(levels.fine))},
            {c, 2 * c, 4, 2, 1, false, hop_matrix(levels.fine, levels.middle_kept)},
            {2 * c, 4 * c, 4, 2, 1, false, hop_matrix(levels.middle, levels.coarse_kept)},
            {4 * c, 8 * c, 4, 2, 1, false, hop_matrix(levels.coarse, all_nodes(levels.coarse))}};
}

std::vector<NetworkWeight> actformer_discriminator_weights(const ActFormerDiscriminatorSettings& s) {
    List list;
    const auto convolutions = node_convolutions(s);
    for (std::size_t i = 0; i < convolutions.size(); ++i) {
        const auto& conv = convolutions[i];
        const std::int64_t nodes = conv.sums.inputs, hops = conv.sums.hops;
        list.spectral(layer_name(i), {nodes, hops, conv.out, conv.taps, conv.in}, nodes * hops * conv.out,
                      std::int64_t{conv.in} * conv.taps, conv.bias);
    }
    const std::int64_t coarse = convolutions.back().sums.outputs, features = s.features();
    list.spectral("last", {features, coarse, last_taps, features / 2}, features,
                  features / 2 * coarse * last_taps, true);
    if (s.persons_in == PersonsInD::selfatt) {
        list.linear("persons.qkv", 3 * features, features);
        list.linear("persons.proj", features, features);
    }
    list.linear("score", 1, features);
    list.add({"classes.weight", {s.classes, features}, Init::orthogonal, 0, true, s.classes});
    return list.take();
}

std::vector<SummaryLine> actformer_generator_summary(const ActFormerGeneratorSettings& s,
                                                     std::uint32_t frames) {
    const auto weights = actformer_generator_weights(s);
    const std::int64_t t = frames, persons = s.tokens_a_frame();
    const std::vector<std::int64_t> tokens{persons, t + 1, s.width};
    std::vector<SummaryLine> lines;
    const auto under = [&](const std::string& name) { return trained_count(weights, name); };
    lines.push_back({"prior",
                     s.prior.kind == PriorKind::gp ? "Gaussian processes" : "one normal vector",
                     {s.prior.streams, t, s.prior.channels},
                     0});
    lines.push_back({"input", "linear, spectral norm", {1, t, s.width}, under("input.")});
    lines.push_back({"classes", "embedding, the first token", {1, 1, s.width}, under("classes.")});
    lines.push_back({"positions", s.positions == Positions::fixed ? "sinusoids" : "learned", tokens,
                     under("positions") + under("frame_positions") + under("person_positions")});
    const auto blocks = interacting_blocks(s);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const auto prefix = fmt::format("blocks.{}", i);
        lines.push_back({prefix, fmt::format("{}-Former, {} heads", blocks[i] ? "I" : "T", s.heads), tokens,
                         under(prefix + ".")});
    }
    lines.push_back({"norm", "layer norm, spectral norm", tokens, under("norm.")});
    const std::vector<std::int64_t> motion{std::int64_t{s.persons} * s.numbers(), t, s.nodes()};
    if (s.body == Body::graphconv) {
        const auto levels = skeleton_levels(s.parents);
        const GraphBody c;
        const auto graph = [&](const char* name, const char* kind, std::int64_t channels, std::size_t nodes) {
            lines.push_back({name,
                             kind,
                             {s.persons, t, static_cast<std::int64_t>(nodes), channels},
                             under(std::string(name) + ".")});
        };
        graph("to_graph", "linear, spectral norm", c.coarse, levels.coarse.nodes());
        graph("up1", "graph convolution, upsampling", c.middle, levels.middle.nodes());
        graph("up2", "graph convolution, upsampling", c.fine, levels.fine.nodes());
        graph("graph", "graph convolution", c.fine, levels.fine.nodes());
    }
    lines.push_back({"head", head_kind(s.representation.finish()), motion, under("head.")});
    return lines;
}

std::vector<SummaryLine> actformer_discriminator_summary(const ActFormerDiscriminatorSettings& s,
                                                         std::uint32_t frames) {
    const auto weights = actformer_discriminator_weights(s);
    const auto under = [&](const std::string& name) { return trained_count(weights, name + "."); };
    const auto convolutions = node_convolutions(s);
    std::vector<SummaryLine> lines;
    std::uint32_t t = frames;
    const std::int64_t seen = s.persons_in == PersonsInD::concat ? 1 : s.persons;
    const auto shape = [&](std::int64_t channels, std::int64_t nodes) {
        std::vector<std::int64_t> out{channels, t, nodes};
        if (seen > 1) out.insert(out.begin(), seen);
        return out;
    };
    lines.push_back({"input", "with differences over time", shape(convolutions[0].in, s.nodes()), 0});
    for (std::size_t i = 0; i < convolutions.size(); ++i) {
        const auto& conv = convolutions[i];
        t = conv.frames_out(t);
        lines.push_back({layer_name(i),
                         fmt::format("graph convolution {} to {} nodes, {} frames", conv.sums.inputs,
                                     conv.sums.outputs, conv.taps),
                         shape(conv.out, conv.sums.outputs), under(layer_name(i))});
    }
    t = (t + 2 - last_taps) / 2 + 1;
    lines.push_back({"last", "convolution over nodes and 4 frames", shape(s.features(), 1), under("last")});
    if (s.persons_in == PersonsInD::selfatt)
        lines.push_back({"persons", "attention over persons", {s.persons, s.features()}, under("persons")});
    lines.push_back({"score", "of the features' sums", {1}, under("score")});
    lines.push_back({"classes", "embedding times features", {1}, under("classes")});
    return lines;
}

}  // namespace actformer::model
