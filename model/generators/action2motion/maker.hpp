// Motions out of Action2Motion's weights. Includes torch headers.
#pragma once

#include "model/generators/action2motion/motions.hpp"
#include "model/generators/action2motion/network.hpp"

namespace actformer::model::action2motion {

class MotionMaker : public Maker {
  public:
    /// Throws Error, beginning with `where`, for weights that are missing or of another shape.
    MotionMaker(const Settings& settings, const std::vector<Array>& weights, const std::string& device,
                const std::string& where);

    /// The time counter is at its end there.
    std::uint32_t most_frames() const override { return network_.settings().frames; }
    std::uint32_t batch() const override { return 50; }
    std::vector<float> make(std::uint64_t seed, std::uint32_t label, std::uint32_t index,
                            std::uint32_t frames) override;

  private:
    MotionNumbers motions_;
    at::Device device_;
    Network network_;
};

}  // namespace actformer::model::action2motion
