// Motions out of a generator, each a function of the seed, its class and its number alone. Includes torch headers.
#pragma once

#include "model/generators/actformer/generator.hpp"
#include "model/generators/adversarial/prior.hpp"

namespace actformer::model {

class MotionMaker {
  public:
    /// `generator` must outlive the maker.
    MotionMaker(Generator& generator, std::uint64_t seed);

    /// Motions that go through the network together; see Maker::batch().
    static constexpr std::uint32_t chunk = 25;

    /// Motions `index` * chunk and on of class `label`: (chunk, P*D, T, K) float32 on the processor. The generator is in
    /// evaluation mode meanwhile.
    at::Tensor make(std::uint32_t label, std::uint32_t index, std::uint32_t frames) const;

    std::uint64_t seed() const { return seed_; }

  private:
    Generator& generator_;
    std::uint64_t seed_;
    Prior prior_;
};

}  // namespace actformer::model
