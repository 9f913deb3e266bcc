// Poses out of a GRU's states, frame by frame, and back into it (Action2Motion, section 3). T float or double.
#pragma once

#include "model/cpu/chain_kernel.hpp"
#include "model/cpu/gru_kernel.hpp"
#include "model/cpu/products.hpp"
#include "model/cpu/transformer_kernels.hpp"

namespace actformer::model::cpu {

/// Rotations in place of positions: behind a pose's first three numbers (the root's position) pi tanh(W tanh(the others) + b).
template <typename T>
struct ChainBody {
    LinearWeight<T> weight;  ///< (numbers - 3, numbers - 3)
    const Chains* chains = nullptr;
    const T* bones = nullptr;   ///< (frames, samples, joints)
    bool feeds_joints = false;  ///< in place of rotations
};

/// (frames, samples, numbers) each.
template <typename T>
struct PoseTrace {
    T* out;     ///< poses; of rotations along chains the root's position and rotations
    T* inner;   ///< of rotations along chains: tanh of the linear map's outputs; else null
    T* joints;  ///< of rotations along chains; else null
};

/// Gradients, (frames, samples, ...) each.
template <typename T>
struct PoseGradient {
    const T *out, *joints;  ///< given; null where there are none
    T* raw;                 ///< (numbers) to the linear map's outputs
    T* lie;                 ///< (numbers - 3) to those of the map to rotations along chains
};

template <typename T>
class PoseFeedback : public GruFeedback<T> {
  public:
    /// The last state's linear map `head` (numbers, hidden); `weight` (3*hidden, numbers). `body` and `gradient` may be null; all that
    /// is pointed to outlives this.
    PoseFeedback(const GruShape& shape, std::int64_t numbers, const T* weight, const LinearWeight<T>& head,
                 const ChainBody<T>* body, const PoseTrace<T>& trace, const PoseGradient<T>* gradient,
                 int threads);

    std::int64_t numbers() const override { return numbers_; }
    const T* weight() const override { return weight_; }
    void forward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* states,
                 T* fed) override;
    void backward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* grad_fed,
                  T* grad_states) override;

  private:
    std::int64_t at(std::int64_t frame, std::int64_t first) const { return frame * shape_.samples + first; }
    void place_joints(std::int64_t row, std::int64_t count);
    void place_joints_backward(std::int64_t row, std::int64_t count, const T* grad_fed);

    GruShape shape_;
    std::int64_t numbers_;
    const T* weight_;
    LinearWeight<T> head_;
    const ChainBody<T>* body_;
    PoseTrace<T> trace_;
    const PoseGradient<T>* gradient_;
    PackedMatrix<T> packed_head_, packed_lie_;  ///< forward's, or with a gradient backward's
    std::vector<T> head_bias_, lie_bias_;       ///< padded
};

}  // namespace actformer::model::cpu
