#include "model/generators/actformer/motion_maker.hpp"

namespace actformer::model {

MotionMaker::MotionMaker(Generator& generator, std::uint64_t seed, std::uint32_t frames)
    : generator_(generator), prior_(generator.settings().prior, seed), frames_(frames) {}

at::Tensor MotionMaker::make(std::uint32_t label, std::uint32_t index) const {
    const at::NoGradGuard no_gradients;
    const bool training = generator_.is_training();
    generator_.eval();
    const auto device = generator_.parameters().front().device();
    const auto draw = std::uint64_t{label} << 32U | index;
    const auto labels = at::full({chunk}, static_cast<std::int64_t>(label), at::kLong);
    const auto made =
        generator_.forward(prior_.draw(draw, chunk, frames_).to(device), labels.to(device)).to(at::kCPU);
    generator_.train(training);
    return made.contiguous();
}

}  // namespace actformer::model
