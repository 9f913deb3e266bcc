#include "model/generators/adversarial/spread.hpp"

#include <ATen/ATen.h>

namespace actformer::model {
namespace {

/// Below it a number stands still: in metres, or in parts of a unit limb vector or of a row of a rotation matrix.
constexpr double least_spread = 1e-3;

}  // namespace

at::Tensor class_spread(const at::Tensor& motion, const at::Tensor& labels) {
    const auto order = std::get<1>(at::sort(labels, c10::optional<bool>(true), 0, false));
    const auto sorted = motion.index_select(0, order), classes = labels.index_select(0, order);
    const auto pairs = motion.size(0) - 1;
    const auto alike = (classes.narrow(0, 1, pairs) == classes.narrow(0, 0, pairs)).to(motion.scalar_type());
    const auto apart = (sorted.narrow(0, 1, pairs) - sorted.narrow(0, 0, pairs)).abs().mean(2);
    return at::tensordot(alike, apart, {0}, {0}) / alike.sum().clamp_min(1);
}

at::Tensor spread_loss(const at::Tensor& real, const at::Tensor& fake, const at::Tensor& labels) {
    const auto wanted = class_spread(real.to(at::kFloat), labels) + least_spread;
    return at::relu((wanted / (class_spread(fake.to(at::kFloat), labels) + least_spread)).log()).mean();
}

}  // namespace actformer::model
