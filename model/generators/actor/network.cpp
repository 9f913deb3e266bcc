#include "model/generators/actor/network.hpp"

#include "base/error.hpp"
#include "model/generators/actor/layers.hpp"
#include "model/nn/fused_post_norm.hpp"

namespace actformer::model {
namespace {

constexpr double norm_epsilon = 1e-5;

/// Of cpu::Dropout's place: what else is random in training has purposes of its own.
constexpr std::uint8_t for_dropout = 2;
constexpr std::uint64_t site_bits = 11;

/// Places where numbers are dropped: of the two stacks' tokens, and of each layer.
constexpr std::uint64_t encoder_tokens = 0, decoder_tokens = 1;
enum Site : std::uint64_t { weights, branch, hidden, mapped_branch, cross_weights, cross_branch };

std::uint64_t site_of(bool decoder, std::uint64_t layer) {
    constexpr std::uint64_t places = 8, most_layers = 64;
    return places * (1 + layer + (decoder ? most_layers : 0));
}

/// Sines and cosines of `count` positions in turn, (count, width): float32 as in the public code, whatever the type.
at::Tensor sinusoids(std::int64_t count, std::int64_t width, const at::TensorOptions& like) {
    const auto position = at::arange(count, at::kFloat).unsqueeze(1);
    const auto pace =
        at::exp(at::arange(0, width, 2, at::kFloat) * (-std::log(10000.0) / static_cast<double>(width)));
    const auto angle = position * pace;
    return at::stack({angle.sin(), angle.cos()}, 2).view({count, width}).to(like);
}

/// x (N, rows, columns) without what is dropped.
at::Tensor dropped(const at::Tensor& x, const cpu::Dropout& dropout) {
    if (!dropout.drops()) return x;
    if (x.is_cpu()) return x * kept_numbers(x, dropout);
    at::manual_seed(dropout.seed());
    return at::dropout(x, dropout.rate, true);
}

}  // namespace

cpu::Dropout ActorDropout::at(std::uint64_t site) const {
    return {rate, {seed, step << site_bits | site, for_dropout}, first_sample};
}

ActorNet::ActorNet(const ActorSettings& settings, std::uint64_t seed, at::ScalarType type)
    : settings_(settings), weights_(*this, actor_weights(settings), seed, type) {}

LinearTensors ActorNet::linear(const std::string& name) const {
    return {weights_.at(name + ".weight"), weights_.at(name + ".bias")};
}

/// `count` of an attention's maps to queries, keys and values, from number `first` on.
LinearTensors ActorNet::projections(const std::string& name, std::int64_t first, std::int64_t count) const {
    const std::int64_t width = settings_.width;
    return {weights_.at(name + ".in_proj_weight").narrow(0, first * width, count * width),
            weights_.at(name + ".in_proj_bias").narrow(0, first * width, count * width)};
}

at::Tensor ActorNet::norm(const at::Tensor& x, const std::string& name) const {
    const auto of = linear(name);
    return at::layer_norm(x, {settings_.width}, of.weight, of.bias, norm_epsilon);
}

/// queries (N, Q, W) to tokens (N, T, W).
at::Tensor ActorNet::attention(const at::Tensor& queries, const at::Tensor& tokens, const std::string& name,
                               const cpu::Dropout& dropout) const {
    const auto n = tokens.size(0), heads = std::int64_t{settings_.heads}, each = settings_.width / heads;
    const auto by_head = [&](const at::Tensor& x) { return x.view({n, -1, heads, each}).transpose(1, 2); };
    const auto to_queries = projections(name, 0, 1), to_both = projections(name, 1, 2);
    const auto q = by_head(at::linear(queries, to_queries.weight, to_queries.bias));
    const auto both = at::linear(tokens, to_both.weight, to_both.bias).chunk(2, -1);
    const auto k = by_head(both[0].contiguous()), v = by_head(both[1].contiguous());
    const auto scores = q.matmul(k.transpose(2, 3)) / std::sqrt(static_cast<double>(each));
    auto weights = scores.softmax(-1);
    if (dropout.drops()) {  // random numbers lie key by key, as in the fused path
        const auto by_key = weights.transpose(2, 3).reshape({n, heads * tokens.size(1), queries.size(1)});
        weights = dropped(by_key, dropout).view({n, heads, tokens.size(1), queries.size(1)}).transpose(2, 3);
    }
    const auto seen = weights.matmul(v).transpose(1, 2).reshape({n, queries.size(1), settings_.width});
    const auto out = linear(name + ".out_proj");
    return at::linear(seen, out.weight, out.bias);
}

/// The norm of queries plus what they see of tokens.
at::Tensor ActorNet::attended(const at::Tensor& queries, const at::Tensor& tokens, const std::string& layer,
                              std::uint64_t site, const ActorDropout& dropout) const {
    const auto seen = attention(queries, tokens, layer + "self_attn", dropout.at(site + Site::weights));
    return norm(queries + dropped(seen, dropout.at(site + Site::branch)), layer + "norm1");
}

at::Tensor ActorNet::fused_attended(const at::Tensor& x, const std::string& layer, std::uint64_t site,
                                    const ActorDropout& dropout) const {
    return fused_attention_norm(x, projections(layer + "self_attn", 0, 3),
                                linear(layer + "self_attn.out_proj"), {linear(layer + "norm1"), norm_epsilon},
                                settings_.heads,
                                {dropout.at(site + Site::weights), dropout.at(site + Site::branch)});
}

/// The norm of x plus its MLP.
at::Tensor ActorNet::mapped(const at::Tensor& x, const std::string& layer, const char* norm,
                            std::uint64_t site, const ActorDropout& dropout) const {
    const auto up = linear(layer + "linear1"), down = linear(layer + "linear2");
    const auto active = dropped(at::gelu(at::linear(x, up.weight, up.bias)), dropout.at(site + Site::hidden));
    const auto out = at::linear(active, down.weight, down.bias);
    return this->norm(x + dropped(out, dropout.at(site + Site::mapped_branch)), layer + norm);
}

at::Tensor ActorNet::fused_mapped(const at::Tensor& x, const std::string& layer, const char* norm,
                                  std::uint64_t site, const ActorDropout& dropout) const {
    return fused_mlp_norm(x, linear(layer + "linear1"), linear(layer + "linear2"),
                          {linear(layer + norm), norm_epsilon},
                          {dropout.at(site + Site::hidden), dropout.at(site + Site::mapped_branch)});
}

/// What every query sees of a single token (N, W): its value alone, whatever the query, for the softmax of one score is 1. The
/// output map of the values, without its bias: (N, heads, W) by head, else their sum (N, 1, W).
at::Tensor ActorNet::seen_of(const at::Tensor& memory, const std::string& name, bool by_head) const {
    const auto to_value = projections(name, 2, 1);
    const auto value = at::linear(memory, to_value.weight, to_value.bias);
    const auto& out = weights_.at(name + ".out_proj.weight");
    if (!by_head) return at::linear(value, out).unsqueeze(1);
    const auto n = memory.size(0), heads = std::int64_t{settings_.heads}, each = settings_.width / heads;
    const auto maps = out.view({-1, heads, each}).permute({1, 2, 0});
    return at::bmm(value.view({n, heads, each}).transpose(0, 1), maps).transpose(0, 1).contiguous();
}

/// The norm of x plus the attention to `memory` (N, W). With dropout a query misses some heads of it.
at::Tensor ActorNet::crossed(const at::Tensor& x, const at::Tensor& memory, const std::string& layer,
                             std::uint64_t site, const ActorDropout& dropout) const {
    const auto name = layer + "multihead_attn";
    const bool drops = dropout.rate > 0;
    auto seen = seen_of(memory, name, drops);
    if (drops) {
        const auto all = at::ones({x.size(0), x.size(1), std::int64_t{settings_.heads}}, x.options());
        seen = dropped(all, dropout.at(site + Site::cross_weights)).matmul(seen);
    }
    const auto out = seen + weights_.at(name + ".out_proj.bias");
    return norm(x + dropped(out, dropout.at(site + Site::cross_branch)), layer + "norm2");
}

at::Tensor ActorNet::fused_crossed(const at::Tensor& x, const at::Tensor& memory, const std::string& layer,
                                   std::uint64_t site, const ActorDropout& dropout) const {
    const auto name = layer + "multihead_attn";
    return fused_sum_norm(x, seen_of(memory, name, dropout.rate > 0), weights_.at(name + ".out_proj.bias"),
                          {linear(layer + "norm2"), norm_epsilon},
                          {dropout.at(site + Site::cross_weights), dropout.at(site + Site::cross_branch)});
}

ActorNet::Latent ActorNet::encode(const at::Tensor& motion, const at::Tensor& labels,
                                  const ActorDropout& dropout) const {
    const auto n = motion.size(0), t = motion.size(2);
    const auto embedding = linear("encoder.skelEmbedding");
    const auto frames =
        at::linear(motion.permute({0, 2, 3, 1}).reshape({n, t, -1}), embedding.weight, embedding.bias);
    const auto token = [&](const char* name) {
        return weights_.at(name).index_select(0, labels).unsqueeze(1);
    };
    auto x = at::cat({token("encoder.muQuery"), token("encoder.sigmaQuery"), frames}, 1);
    x = dropped(x + sinusoids(t + 2, settings_.width, x.options()), dropout.at(encoder_tokens));
    for (std::uint32_t i = 0; i + 1 < settings_.layers; ++i) {
        const auto layer = encoder_layer(i);
        const auto site = site_of(false, i);
        if (takes_fused_path(x))
            x = fused_mapped(fused_attended(x, layer, site, dropout), layer, "norm2", site, dropout);
        else
            x = mapped(attended(x, x, layer, site, dropout), layer, "norm2", site, dropout);
    }
    // Behind the last layer only the first two tokens are looked at.
    const auto layer = encoder_layer(settings_.layers - 1);
    const auto site = site_of(false, settings_.layers - 1);
    const auto both =
        mapped(attended(x.slice(1, 0, 2), x, layer, site, dropout), layer, "norm2", site, dropout);
    return {both.select(1, 0), both.select(1, 1)};
}

at::Tensor ActorNet::decode(const at::Tensor& latent, const at::Tensor& labels, std::int64_t frames,
                            const ActorDropout& dropout) const {
    const auto n = latent.size(0), width = std::int64_t{settings_.width};
    if (latent.dim() != 2 || latent.size(1) != width || labels.dim() != 1 || labels.size(0) != n)
        throw Error("the decoder takes latent vectors (N, {}) and N labels", width);
    if (frames < 1 || frames > most_actor_frames)
        throw Error("{} frames: the decoder makes 1 to {}", frames, most_actor_frames);
    const auto memory = latent + weights_.at("decoder.actionBiases").index_select(0, labels);
    auto x = dropped(sinusoids(frames, width, latent.options()).expand({n, frames, width}),
                     dropout.at(decoder_tokens))
                 .contiguous();
    for (std::uint32_t i = 0; i < settings_.layers; ++i) {
        const auto layer = decoder_layer(i);
        const auto site = site_of(true, i);
        if (takes_fused_path(x)) {
            x = fused_crossed(fused_attended(x, layer, site, dropout), memory, layer, site, dropout);
            x = fused_mapped(x, layer, "norm3", site, dropout);
        } else {
            x = crossed(attended(x, x, layer, site, dropout), memory, layer, site, dropout);
            x = mapped(x, layer, "norm3", site, dropout);
        }
    }
    const auto last = linear("decoder.finallayer");
    return at::linear(x, last.weight, last.bias).view({n, frames, settings_.nodes, -1}).permute({0, 3, 1, 2});
}

}  // namespace actformer::model
