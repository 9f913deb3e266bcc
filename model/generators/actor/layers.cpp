#include "model/generators/actor/layers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace actformer::model {
namespace {

/// Collects weights layer by layer.
class List {
  public:
    void linear(const std::string& name, std::int64_t out, std::int64_t in, Init bias = Init::uniform) {
        const double bound = 1 / std::sqrt(static_cast<double>(in));
        add(name + ".weight", {out, in}, Init::uniform, bound);
        add(name + ".bias", {out}, bias, bound);
    }
    void norm(const std::string& name, std::int64_t width) {
        add(name + ".weight", {width}, Init::ones);
        add(name + ".bias", {width}, Init::zeros);
    }
    void attention(const std::string& name, std::int64_t width) {
        add(name + ".in_proj_weight", {3 * width, width}, Init::uniform,
            std::sqrt(6 / static_cast<double>(4 * width)));
        add(name + ".in_proj_bias", {3 * width}, Init::zeros);
        linear(name + ".out_proj", width, width, Init::zeros);
    }
    void table(const std::string& name, std::int64_t rows, std::int64_t width) {
        add(name, {rows, width}, Init::normal, 1);
    }

    /// Names from now on stand behind `prefix`, and begin as those behind `like` where it is not empty.
    void behind(std::string prefix, std::string like) {
        prefix_ = std::move(prefix);
        like_ = std::move(like);
    }
    std::vector<NetworkWeight> take() { return std::move(list_); }

  private:
    void add(const std::string& name, std::vector<std::int64_t> shape, Init init, double scale = 0) {
        NetworkWeight weight{prefix_ + name, std::move(shape), init, scale};
        if (!like_.empty()) weight.same_as = like_ + name;
        list_.push_back(std::move(weight));
    }

    std::string prefix_, like_;
    std::vector<NetworkWeight> list_;
};

void add_layers(List& list, const ActorSettings& s, std::string (*name)(std::uint32_t), bool crosses) {
    for (std::uint32_t i = 0; i < s.layers; ++i) {
        list.behind(name(i), i > 0 ? name(0) : "");
        list.attention("self_attn", s.width);
        if (crosses) list.attention("multihead_attn", s.width);
        list.linear("linear1", s.hidden, s.width);
        list.linear("linear2", s.width, s.hidden);
        list.norm("norm1", s.width);
        list.norm("norm2", s.width);
        if (crosses) list.norm("norm3", s.width);
    }
    list.behind("", "");
}

NetworkSummary summary_of(const char* name, std::vector<SummaryLine> lines,
                          const std::vector<NetworkWeight>& weights) {
    for (auto& line : lines) {
        line.parameters = trained_count(weights, line.layer);
        if (line.layer.ends_with('.')) line.layer.pop_back();
    }
    return {name, std::move(lines)};
}

}  // namespace

std::string encoder_layer(std::uint32_t layer) {
    return fmt::format("encoder.seqTransEncoder.layers.{}.", layer);
}

std::string decoder_layer(std::uint32_t layer) {
    return fmt::format("decoder.seqTransDecoder.layers.{}.", layer);
}

std::vector<NetworkWeight> actor_weights(const ActorSettings& s) {
    List list;
    list.table("encoder.muQuery", s.classes, s.width);
    list.table("encoder.sigmaQuery", s.classes, s.width);
    list.linear("encoder.skelEmbedding", s.width, s.numbers());
    add_layers(list, s, encoder_layer, false);
    list.table("decoder.actionBiases", s.classes, s.width);
    add_layers(list, s, decoder_layer, true);
    list.linear("decoder.finallayer", s.numbers(), s.width);
    return list.take();
}

std::vector<NetworkSummary> actor_summary(const ActorSettings& s, std::uint32_t frames) {
    const auto weights = actor_weights(s);
    const std::int64_t t = frames, width = s.width;
    std::vector<SummaryLine> encoder{{"encoder.muQuery", "table, the first token", {1, width}},
                                     {"encoder.sigmaQuery", "table, the second token", {1, width}},
                                     {"encoder.skelEmbedding", "linear, a token a frame", {t, width}}};
    std::vector<SummaryLine> decoder{{"decoder.actionBiases", "table, added to the latent vector", {width}}};
    for (std::uint32_t i = 0; i < s.layers; ++i) {
        encoder.push_back(
            {encoder_layer(i), fmt::format("attention, {} heads, and MLP", s.heads), {t + 2, width}});
        decoder.push_back({decoder_layer(i),
                           fmt::format("attention to frames and latent vector, {} heads, and MLP", s.heads),
                           {t, width}});
    }
    const std::int64_t channels = std::int64_t{s.persons} * s.representation.numbers();
    decoder.push_back({"decoder.finallayer", "linear", {channels, t, s.nodes}});
    return {summary_of("encoder", std::move(encoder), weights),
            summary_of("decoder", std::move(decoder), weights)};
}

}  // namespace actformer::model
