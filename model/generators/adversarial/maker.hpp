// Motions out of a GAN's generator, each a function of the seed, its class and its number alone. Includes torch headers.
#pragma once

#include <memory>

#include "model/generators/adversarial/networks.hpp"
#include "model/generators/method.hpp"

namespace actformer::model {

class MotionMaker {
  public:
    /// `generator` must outlive the maker.
    MotionMaker(GanGenerator& generator, std::uint64_t seed);

    /// Motions that go through the network together; see Maker::batch().
    static constexpr std::uint32_t chunk = 25;

    /// Motions `index` * chunk and on of class `label`: (chunk, P*D, T, K) float32 on the processor. The generator is in
    /// evaluation mode meanwhile.
    at::Tensor make(std::uint32_t label, std::uint32_t index, std::uint32_t frames) const;

    std::uint64_t seed() const { return seed_; }

  private:
    GanGenerator& generator_;
    std::uint64_t seed_;
    Prior prior_;
};

/// A maker of at most `most_frames` frames: gives `generator` its `weights` and moves it to `device`. Throws Error, beginning with
/// `where`, for weights that are missing or of another shape.
std::unique_ptr<Maker> gan_maker(std::shared_ptr<GanGenerator> generator, std::uint32_t most_frames,
                                 const std::vector<Array>& weights, const std::string& where,
                                 const std::string& device);

}  // namespace actformer::model
