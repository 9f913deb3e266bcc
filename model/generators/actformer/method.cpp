#include "model/generators/actformer/method.hpp"

#include <optional>

#include "model/generators/actformer/layers.hpp"
#include "model/generators/adversarial/learner.hpp"
#include "model/generators/adversarial/maker.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

std::vector<Key> keys() {
    auto all = network_keys();
    for (auto& key : gan_keys()) all.push_back(std::move(key));
    return all;
}

GeneratorSettings generator_of(const Config& config, const MotionSpec& spec) {
    return generator_settings(config, spec.representation, spec.topology, spec.persons, spec.classes,
                              spec.where);
}

DiscriminatorSettings discriminator_of(const Config& config, const MotionSpec& spec) {
    return discriminator_settings(config, spec.representation, spec.topology, spec.persons, spec.classes,
                                  spec.where);
}

std::vector<NetworkSummary> networks(const Config& config, const MotionSpec& spec) {
    const auto frames = static_cast<std::uint32_t>(config.get<std::int64_t>("frames"));
    return {{"generator", generator_summary(generator_of(config, spec), frames)},
            {"discriminator", discriminator_summary(discriminator_of(config, spec), frames)}};
}

std::unique_ptr<Learner> learner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup) {
    return std::make_unique<ActformerLearner>(config, generator_of(config, spec),
                                              discriminator_of(config, spec), setup);
}

class ActformerMaker : public Maker {
  public:
    ActformerMaker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
                   const std::string& device)
        : generator_(generator_of(config, spec), 0) {
        load_arrays(generator_, "", weights, spec.where);
        generator_.to(torch_device(device));
        generator_.eval();
    }

    std::uint32_t most_frames() const override { return generator_.settings().frames; }
    std::uint32_t batch() const override { return MotionMaker::chunk; }

    std::vector<float> make(std::uint64_t seed, std::uint32_t label, std::uint32_t index,
                            std::uint32_t frames) override {
        if (!maker_ || maker_->seed() != seed) maker_.emplace(generator_, seed);
        const auto motions = maker_->make(label, index, frames);
        const auto* first = motions.data_ptr<float>();
        return {first, first + motions.numel()};
    }

  private:
    Generator generator_;
    std::optional<MotionMaker> maker_;
};

std::unique_ptr<Maker> maker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
                             const std::string& device) {
    return std::make_unique<ActformerMaker>(config, spec, weights, device);
}

}  // namespace

Method actformer_method() {
    return {"actformer", "ActFormer (Xu, Song et al., ICCV 2023)", keys, networks, learner, maker};
}

}  // namespace actformer::model
