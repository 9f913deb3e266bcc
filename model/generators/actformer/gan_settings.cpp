#include "model/generators/actformer/gan_settings.hpp"

#include "base/error.hpp"
#include "model/generators/actformer/settings.hpp"

namespace actformer::model {
namespace {

using Number = std::int64_t;
using Numbers = std::vector<Number>;

std::vector<Key> training_keys() {
    return {
        {"data", std::string(), "dataset folder"},
        {"train_split", std::string("all"), "clips to train on"},
        {"batch", Number{64}, "real windows a discriminator's step, of each process", 1, 65536},
        {"epochs", Number{500}, "of as many real windows as there are clips", 1, 1e9},
        {"discriminator_steps", Number{4}, "for each of the generator's", 1, 1000},
        {"loss",
         std::string("hinge"),
         "hinge (public tools) or wasserstein (the paper's equation 1)",
         0,
         0,
         {"wasserstein", "hinge"}},
        {"generator_rate", 2e-4, "learning rate", 0, 1},
        {"discriminator_rate", 2e-4, "learning rate", 0, 1},
        {"rate_drops", Numbers{}, "epochs at whose start both rates are multiplied by rate_factor", 0, 1e9},
        {"rate_factor", 0.25, "see rate_drops", 0, 1},
        {"beta1", 0.0, "of Adam: decay of the mean gradient", 0, 0.9999},
        {"beta2", 0.999, "of Adam: decay of the mean squared gradient", 0, 0.999999},
        {"average", 0.0, "decay a step of the mean of the generator's weights, as in 0.999; 0 keeps none", 0,
         0.999999},
        {"recogniser", std::string(), "weights (.h5) or training of a recogniser to score with; empty: none"},
        {"score_every", Number{10}, "epochs between scores", 1, 1e9},
        {"score_per_class", Number{100}, "motions of every class to score", 2, 100000},
        {"checkpoint_minutes", 5.0, "between checkpoints; 0 keeps every step", 0, 1e6},
        {"seed", Number{0}, "of weights, windows and latents", 0, 9e15},
        {"device", std::string("cpu"), "where libtorch trains: cpu, cuda or cuda:N"},
        {"bf16", false, "on CUDA: matrix products and convolutions in bfloat16"},
        {"opencl", std::string(), "OpenCL device that draws windows and scores; empty for the usual one"},
        {"threads", Number{0}, "processor threads; 0 takes all", 0, 4096}};
}

AdamSettings adam_of(const Config& config, const char* rate) {
    return {config.get<double>(rate), config.get<double>("beta1"), config.get<double>("beta2")};
}

}  // namespace

Config generator_config() {
    auto keys = network_keys();
    for (auto& key : training_keys()) keys.push_back(std::move(key));
    return Config("generator", std::move(keys));
}

GanSettings gan_settings(const Config& config) {
    const auto text = [&](const char* key) { return config.get<std::string>(key); };
    const auto whole = [&](const char* key) { return static_cast<std::uint32_t>(config.get<Number>(key)); };
    GanSettings s;
    s.data = text("data");
    s.train_split = text("train_split");
    s.frames = whole("frames");
    s.batch = whole("batch");
    s.epochs = whole("epochs");
    s.discriminator_steps = whole("discriminator_steps");
    s.loss = text("loss") == "wasserstein" ? Loss::wasserstein : Loss::hinge;
    s.generator = adam_of(config, "generator_rate");
    s.discriminator = adam_of(config, "discriminator_rate");
    s.rate_drops = config.get<Numbers>("rate_drops");
    s.rate_factor = config.get<double>("rate_factor");
    s.average = config.get<double>("average");
    s.recogniser = text("recogniser");
    s.score_every = whole("score_every");
    s.score_per_class = whole("score_per_class");
    s.checkpoint_minutes = config.get<double>("checkpoint_minutes");
    s.seed = static_cast<std::uint64_t>(config.get<Number>("seed"));
    s.device = text("device");
    s.opencl = text("opencl");
    s.bf16 = config.get<bool>("bf16");
    s.threads = static_cast<int>(config.get<Number>("threads"));
    if (s.bf16 && !s.device.starts_with("cuda"))
        throw Error("bf16: true is for CUDA; with device: {}, leave it out", s.device);
    return s;
}

const std::vector<std::string>& generator_keys_free_to_change() {
    static const std::vector<std::string> keys{"data",        "epochs",          "recogniser",
                                               "score_every", "score_per_class", "checkpoint_minutes",
                                               "device",      "opencl",          "threads"};
    return keys;
}

}  // namespace actformer::model
