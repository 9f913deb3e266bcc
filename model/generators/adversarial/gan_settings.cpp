#include "model/generators/adversarial/gan_settings.hpp"

#include "base/error.hpp"
#include "model/train/shared_keys.hpp"

namespace actformer::model {
namespace {

const KeyTable<GanSettings>& table() {
    static const auto all = [] {
        using Settings = GanSettings;
        KeyTable<Settings> keys;
        keys.add(&Settings::discriminator_steps, {.name = "discriminator_steps",
                                                  .meaning = "for each of the generator's",
                                                  .least = 1,
                                                  .most = 1000})
            .add(&Settings::loss, {.name = "loss",
                                   .meaning = "hinge (public tools) or wasserstein (equation 1 of ActFormer)",
                                   .choices = {"wasserstein", "hinge"}})
            .add(&Settings::spread,
                 {.name = "spread",
                  .meaning =
                      "weight of a loss that keeps motions of a class as far apart as real ones; 0 for none",
                  .least = 0,
                  .most = 1000})
            .add(&Settings::generator_rate,
                 {.name = "generator_rate", .meaning = "learning rate", .least = 0, .most = 1})
            .add(&Settings::discriminator_rate,
                 {.name = "discriminator_rate", .meaning = "learning rate", .least = 0, .most = 1});
        add_adam_keys(keys);
        add_ema_key(keys);
        keys.add(&Settings::bf16,
                 {.name = "bf16", .meaning = "on CUDA: matrix products and convolutions in bfloat16"})
            .add(&Settings::cuda_graphs,
                 {.name = "cuda_graphs",
                  .meaning = "on CUDA: forward and backward passes are captured as graphs",
                  .free = true});
        add_augmentation_keys(keys);
        return keys;
    }();
    return all;
}

void expect_below(double bound, const char* key, double share) {
    if (share >= bound)
        throw Error("{}: {} leaves nothing to tell how motions were recorded; less than {} does", key, share,
                    bound);
}

}  // namespace

std::vector<Key> gan_keys() {
    return table().keys();
}

GanSettings gan_settings(const Config& config) {
    auto settings = table().read(config);
    settings.frames = static_cast<std::uint32_t>(config.get<std::int64_t>("frames"));
    settings.seed = static_cast<std::uint64_t>(config.get<std::int64_t>("seed"));
    expect_below(0.5, "mirror", settings.mirror);
    expect_below(1, "turn", settings.turn);
    const auto& device = config.get<std::string>("device");
    if (settings.bf16 && !device.starts_with("cuda"))
        throw Error("bf16: true is for CUDA; with device: {}, leave it out", device);
    return settings;
}

}  // namespace actformer::model
