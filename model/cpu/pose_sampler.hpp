// Poses out of a learnt prior, frame by frame (Action2Motion, section 3): a prior of one GRU cell sees the last pose and says how the
// latent is distributed, a decoder of two makes the next pose of it. T float or double.
#pragma once

#include "model/cpu/gru_kernel.hpp"
#include "model/cpu/pose_feedback.hpp"

namespace actformer::model::cpu {

/// The prior's weights.
template <typename T>
struct PriorWeights {
    GruInput<T> input;  ///< without products
    GruCell<T> cell;
    const T* pose;         ///< (3*hidden, numbers), which its gates get of the last pose
    LinearWeight<T> head;  ///< (2*latent, hidden): means, then logarithms of variances
    const T* latent;       ///< (3*hidden, latent), which the decoder's gates get of what is drawn
    const T* noise;        ///< (frames, samples, latent) normal numbers
    std::int64_t latents;  ///< numbers of a latent
};

/// Feeds poses back through the prior: behind each frame it writes the decoder's products (frames, samples, 3*hidden) of the next.
template <typename T>
class PoseSampler : public GruFeedback<T> {
  public:
    /// All that is pointed to outlives this.
    PoseSampler(const GruShape& shape, PoseFeedback<T>& poses, const PriorWeights<T>& prior, T* products,
                int threads);

    std::int64_t numbers() const override { return poses_.numbers(); }
    const T* weight() const override { return poses_.weight(); }
    void begin(std::int64_t first, std::int64_t count) override;
    void forward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* states,
                 T* fed) override;
    void backward(std::int64_t /*frame*/, std::int64_t /*first*/, std::int64_t /*count*/,
                  const T* /*grad_fed*/, T* /*grad_states*/) override {}  // nothing is kept for it

  private:
    void draw(std::int64_t frame, std::int64_t first, std::int64_t count, const T* seen);

    GruShape shape_;
    PoseFeedback<T>& poses_;
    PriorWeights<T> prior_;
    T* products_;
    GruStep<T> step_;
    PackedMatrix<T> pose_, head_, latent_;
    std::vector<T> head_bias_, states_;  ///< padded; (samples, hidden)
};

}  // namespace actformer::model::cpu
