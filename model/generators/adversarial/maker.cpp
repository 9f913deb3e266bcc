#include "model/generators/adversarial/maker.hpp"

#include <ATen/core/grad_mode.h>
#include <optional>

#include "model/nn/module_arrays.hpp"
#include "model/train/torch_device.hpp"

namespace actformer::model {

MotionMaker::MotionMaker(GanGenerator& generator, std::uint64_t seed)
    : generator_(generator), seed_(seed), prior_(generator.prior(), seed) {}

at::Tensor MotionMaker::make(std::uint32_t label, std::uint32_t index, std::uint32_t frames) const {
    const at::NoGradGuard no_gradients;
    const bool training = generator_.is_training();
    generator_.eval();
    const auto device = generator_.parameters().front().device();
    const auto draw = std::uint64_t{label} << 32U | index;
    const auto labels = at::full({chunk}, static_cast<std::int64_t>(label), at::kLong);
    const auto latent = prior_.draw(draw, chunk, generator_.latent_frames(frames));
    const auto motions = generator_.generate(latent.to(device), labels.to(device), frames).to(at::kCPU);
    generator_.train(training);
    return motions.contiguous();
}

namespace {

class GanMaker : public Maker {
  public:
    GanMaker(std::shared_ptr<GanGenerator> generator, std::uint32_t most_frames)
        : generator_(std::move(generator)), most_frames_(most_frames) {}

    std::uint32_t most_frames() const override { return most_frames_; }
    std::uint32_t batch() const override { return MotionMaker::chunk; }

    std::vector<float> make(std::uint64_t seed, std::uint32_t label, std::uint32_t index,
                            std::uint32_t frames) override {
        if (!maker_ || maker_->seed() != seed) maker_.emplace(*generator_, seed);
        const auto motions = maker_->make(label, index, frames);
        const auto* first = motions.data_ptr<float>();
        return {first, first + motions.numel()};
    }

  private:
    std::shared_ptr<GanGenerator> generator_;
    std::uint32_t most_frames_;
    std::optional<MotionMaker> maker_;
};

}  // namespace

std::unique_ptr<Maker> gan_maker(std::shared_ptr<GanGenerator> generator, std::uint32_t most_frames,
                                 const std::vector<Array>& weights, const std::string& where,
                                 const std::string& device) {
    load_arrays(*generator, "", weights, where);
    generator->to(torch_device(device));
    generator->eval();
    return std::make_unique<GanMaker>(std::move(generator), most_frames);
}

}  // namespace actformer::model
