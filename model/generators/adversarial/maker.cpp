#include "model/generators/adversarial/maker.hpp"

namespace actformer::model {

MotionMaker::MotionMaker(Generator& generator, std::uint64_t seed)
    : generator_(generator), seed_(seed), prior_(generator.settings().prior, seed) {}

at::Tensor MotionMaker::make(std::uint32_t label, std::uint32_t index, std::uint32_t frames) const {
    const at::NoGradGuard no_gradients;
    const bool training = generator_.is_training();
    generator_.eval();
    const auto device = generator_.parameters().front().device();
    const auto draw = std::uint64_t{label} << 32U | index;
    const auto labels = at::full({chunk}, static_cast<std::int64_t>(label), at::kLong);
    const auto motions =
        generator_.forward(prior_.draw(draw, chunk, frames).to(device), labels.to(device)).to(at::kCPU);
    generator_.train(training);
    return motions.contiguous();
}

}  // namespace actformer::model
