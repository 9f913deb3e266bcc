// The GRU classifier on an OpenCL device. It sees a dataset's own numbers, without what the root's first frame says: of joints'
// positions what Action2Motion's sees, of limbs and rotations their numbers.
#pragma once

#include <optional>

#include "eval/gru/weights.hpp"
#include "eval/recogniser.hpp"
#include "kernels/gru.hpp"

namespace actformer::eval {

class GruRecogniser final : public Recogniser {
  public:
    /// States begin at 0, or with `initial_noise` as published: at normal numbers, a function of that seed, of the set's name and of the
    /// sequence's place in it. At most `batch` sequences go to the device at once.
    GruRecogniser(kernels::Device& device, const GruFile& weights, std::uint32_t batch,
                  std::optional<std::uint64_t> initial_noise);

    using Recogniser::recognise;
    Recognised recognise(const cl::Buffer& motions, std::uint32_t sequences, std::uint32_t frames) override;
    void begin_set(const std::string& name) override;

  private:
    void run(const cl::Buffer& motions, std::uint32_t begin, std::uint32_t count, std::uint32_t frames,
             const kernels::Buffer<float>& features);
    kernels::Buffer<float> initial(std::uint32_t begin, std::uint32_t count, std::size_t layer) const;

    GruNetwork network_;
    std::uint32_t batch_;
    std::optional<std::uint64_t> noise_;
    std::uint64_t next_ =
        0;  ///< number of the next sequence; a set's are counted from a number of its name's
    kernels::Gru kernels_;
    std::vector<kernels::GruWeights> layers_;
    kernels::Buffer<float> feature_weight_, feature_bias_, class_weight_, class_bias_;
};

/// As open_recogniser() does.
std::unique_ptr<Recogniser> open_gru(kernels::Device& device, const std::filesystem::path& weights,
                                     std::uint32_t batch, std::optional<std::uint64_t> initial_noise);

}  // namespace actformer::eval
