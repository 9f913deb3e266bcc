#include "model/generators/adversarial/collapse.hpp"

#include <fmt/format.h>

#include <cmath>

namespace actformer::model {
namespace {

constexpr double certain = 1e-3;     // hinge: a loss under this leaves no gradient
constexpr double indistinct = 1e-7;  // float32 tells scores near 1 apart down to this
constexpr double runaway = 1e6;

}  // namespace

std::string collapse_in(const GanLosses& l, Loss loss) {
    if (loss == Loss::hinge && l.discriminator < certain)
        return fmt::format(
            "the discriminator's loss is {:.2g}: it tells real from generated for certain, and its gradient "
            "has vanished",
            l.discriminator);
    if (std::abs(l.real_score - l.fake_score) < indistinct)
        return "the discriminator gives every motion the same score";
    if (std::abs(l.discriminator) > runaway)
        return fmt::format("the discriminator's loss has run away to {:.2g}", l.discriminator);
    return {};
}

}  // namespace actformer::model
