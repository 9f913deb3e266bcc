#include "model/train/divergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace actformer::model {

void DivergenceWatch::see(const Measures& losses, const std::string& trouble, std::uint64_t steps) {
    at_once_ = at_once_ ||
               !std::ranges::all_of(losses, [](const Measure& loss) { return std::isfinite(loss.value); });
    trouble_ = at_once_ ? "losses are NaN or infinite" : trouble;
    steps_ = trouble_.empty() ? 0 : steps_ + steps;
}

std::string DivergenceWatch::verdict() const {
    if (at_once_) return trouble_;
    return steps_ >= patience ? fmt::format("for {} steps {}", steps_, trouble_) : std::string();
}

}  // namespace actformer::model
