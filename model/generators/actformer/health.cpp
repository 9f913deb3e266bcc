#include "model/generators/actformer/health.hpp"

#include <fmt/format.h>

#include <cmath>

namespace actformer::model {
namespace {

constexpr double certain = 1e-3;     // hinge: a loss under this leaves no gradient
constexpr double indistinct = 1e-7;  // float32 tells scores near 1 apart down to this
constexpr double runaway = 1e6;

std::string trouble_in(const Losses& l, Loss loss) {
    if (loss == Loss::hinge && l.discriminator < certain)
        return fmt::format(
            "the discriminator's loss is {:.2g}: it tells real from generated for certain, and "
            "nobody learns any more",
            l.discriminator);
    if (std::abs(l.real_score - l.made_score) < indistinct)
        return "the discriminator gives every motion the same score";
    if (std::abs(l.discriminator) > runaway)
        return fmt::format("the discriminator's loss has run away to {:.2g}", l.discriminator);
    return {};
}

}  // namespace

void Health::see(const Losses& losses, std::uint64_t steps) {
    const bool numbers = std::isfinite(losses.discriminator) && std::isfinite(losses.generator) &&
                         std::isfinite(losses.real_score) && std::isfinite(losses.made_score);
    at_once_ = at_once_ || !numbers;
    trouble_ = at_once_ ? "the losses are no numbers" : trouble_in(losses, loss_);
    steps_ = trouble_.empty() ? 0 : steps_ + steps;
}

std::string Health::verdict() const {
    if (at_once_) return trouble_;
    return steps_ >= patience ? fmt::format("for {} steps {}", steps_, trouble_) : std::string();
}

}  // namespace actformer::model
