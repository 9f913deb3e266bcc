// Motions out of a generator, each a function of the seed, its class and its number alone. Includes torch headers.
#pragma once

#include <vector>

#include "model/generators/actformer/generator.hpp"
#include "model/generators/actformer/prior.hpp"

namespace actformer::model {

class MotionMaker {
  public:
    /// `generator` must outlive the maker.
    MotionMaker(Generator& generator, std::uint64_t seed, std::uint32_t frames);

    /// Always so many go through the network together, wanted or not, and always in the same place: what is wanted beside
    /// a motion changes no bit of it.
    static constexpr std::uint32_t chunk = 25;

    /// Motions `index` * chunk and on of class `label`: (chunk, P*D, T, K) float32 on the processor. The generator is in
    /// evaluation mode meanwhile.
    at::Tensor make(std::uint32_t label, std::uint32_t index) const;

    std::uint32_t frames() const { return frames_; }

  private:
    Generator& generator_;
    Prior prior_;
    std::uint32_t frames_;
};

}  // namespace actformer::model
