#include "model/generators/action2motion/layers.hpp"

#include <cmath>

namespace actformer::model::action2motion {
namespace {

/// Collects weights layer by layer; all start uniform within one over the root of what goes into an output, those of a GRU's cell
/// within one over the root of its state.
class List {
  public:
    void linear(const std::string& name, std::int64_t out, std::int64_t in) {
        const double bound = 1 / std::sqrt(static_cast<double>(in));
        weights_.push_back({name + ".weight", {out, in}, Init::uniform, bound});
        weights_.push_back({name + ".bias", {out}, Init::uniform, bound});
    }
    void cell(const std::string& name, std::int64_t hidden) {
        const double bound = 1 / std::sqrt(static_cast<double>(hidden));
        for (const char* side : {"ih", "hh"}) {
            weights_.push_back({name + ".weight_" + side, {3 * hidden, hidden}, Init::uniform, bound});
            weights_.push_back({name + ".bias_" + side, {3 * hidden}, Init::uniform, bound});
        }
    }
    std::vector<NetworkWeight> take() { return std::move(weights_); }

  private:
    std::vector<NetworkWeight> weights_;
};

}  // namespace

std::vector<NetworkWeight> weights_of(const Settings& s) {
    List list;
    for (const std::string net : {"prior_net", "posterior_net"}) {
        list.linear(net + ".embed", s.hidden, s.inputs());
        list.cell(net + ".gru.0", s.hidden);
        list.linear(net + ".mu_net", s.latent, s.hidden);
        list.linear(net + ".logvar_net", s.latent, s.hidden);
    }
    list.linear("decoder.embed", s.hidden, s.inputs() + s.latent);
    list.cell("decoder.gru.0", s.hidden);
    list.cell("decoder.gru.1", s.hidden);
    list.linear("decoder.output", s.numbers(), s.hidden);
    if (s.body == Body::lie) list.linear("decoder.output_lie", s.numbers() - 3, s.numbers() - 3);
    return list.take();
}

std::vector<NetworkSummary> summary(const Settings& s) {
    const auto weights = weights_of(s);
    const std::int64_t frames = s.frames, hidden = s.hidden, latent = s.latent;
    const auto of_frames = [&](const std::string& net, std::vector<SummaryLine> lines) {
        for (auto& line : lines) {
            line.parameters = trained_count(weights, net + "." + line.layer + ".");
            line.shape.insert(line.shape.begin(), frames);
        }
        return NetworkSummary{net, std::move(lines)};
    };
    const auto distribution = [&](const std::string& net) {
        return of_frames(net, {{"embed", "linear", {hidden}},
                               {"gru.0", "GRU cell", {hidden}},
                               {"mu_net", "linear", {latent}},
                               {"logvar_net", "linear", {latent}}});
    };
    std::vector<SummaryLine> decoder{{"embed", "linear", {hidden}},
                                     {"gru.0", "GRU cell", {hidden}},
                                     {"gru.1", "GRU cell", {hidden}},
                                     {"output", "linear", {s.numbers()}}};
    if (s.body == Body::lie)
        decoder.push_back({"output_lie", "rotations along chains of bones", {s.numbers() - 3}});
    return {distribution("prior_net"), distribution("posterior_net"), of_frames("decoder", decoder)};
}

}  // namespace actformer::model::action2motion
