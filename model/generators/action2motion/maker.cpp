#include "model/generators/action2motion/maker.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>

#include "model/cpu/random_kernel.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/train/torch_device.hpp"

namespace actformer::model::action2motion {
namespace {

constexpr std::uint8_t for_motions = 3;

}  // namespace

MotionMaker::MotionMaker(const Settings& settings, const std::vector<Array>& weights,
                         const std::string& device, const std::string& where)
    : motions_(settings, where), device_(torch_device(device)), network_(settings, 0) {
    load_arrays(network_, "", weights, where);
    network_.to(device_);
}

std::vector<float> MotionMaker::make(std::uint64_t seed, std::uint32_t label, std::uint32_t index,
                                     std::uint32_t frames) {
    const at::NoGradGuard no_gradients;
    const std::int64_t n = batch(), t = frames, latent = network_.settings().latent;
    auto normals = at::empty({n, t, latent}, at::kFloat);
    cpu::normal_numbers({seed, std::uint64_t{label} << 32U | index, for_motions}, 0, n, t * latent,
                        normals.data_ptr<float>(), at::get_num_threads());
    const auto labels = at::full({n}, static_cast<std::int64_t>(label), at::kLong).to(device_);
    auto bones = motions_.bones(n);
    if (bones.defined()) bones = bones.to(device_);
    const auto poses = network_.generate(labels, normals.transpose(0, 1).contiguous().to(device_), bones);
    const auto motions = motions_.motions(poses).to(at::kCPU).contiguous();
    const auto* first = motions.data_ptr<float>();
    return {first, first + motions.numel()};
}

}  // namespace actformer::model::action2motion
