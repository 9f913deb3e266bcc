// GRU cells (Cho et al. 2014) in a stack, over frames, on processors, forward and backward. T float or double.
//
//   r = sigmoid(W_r x + b_r + U_r h + c_r)          frame t of cell l:  x the state of cell l - 1 in frame t,
//   z = sigmoid(W_z x + b_z + U_z h + c_z)                              h its own in frame t - 1, zeros in the first
//   n = tanh(W_n x + b_n + r * (U_n h + c_n))
//   state = (1 - z) * n + z * h
//
// The first cell's products W x come ready, all frames in one matrix product, for whoever has all inputs at hand. Where a frame's
// input is what came of the frame before, a GruFeedback makes it. Every thread takes its samples through all frames, so that none
// waits for another. States are multiples of 16 wide. A sample's results do not depend on the number of threads; sums over samples do.
#pragma once

#include <cstdint>
#include <span>

#include "model/cpu/products.hpp"

namespace actformer::model::cpu {

struct GruShape {
    std::int64_t frames, samples, hidden;
};

/// Rows in the order r, z, n: input_weight (3*hidden, hidden) and input_bias (3*hidden), null of the first cell; hidden_weight
/// (3*hidden, hidden), hidden_bias (3*hidden).
template <typename T>
struct GruCell {
    const T *input_weight, *input_bias, *hidden_weight, *hidden_bias;
};

/// What the first cell's gates are given: the sum of those that are not null.
template <typename T>
struct GruInput {
    const T* products;   ///< (frames, samples, 3*hidden)
    const T* of_sample;  ///< (samples, 3*hidden)
    const T* of_frame;   ///< (frames, 3*hidden)
};

/// What a cell leaves behind.
template <typename T>
struct GruTrace {
    T* states;  ///< (frames, samples, hidden)
    T* gates;  ///< (frames, samples, 4*hidden): U_n h + c_n, r, z, n; null where nothing is kept for the backward pass
};

/// Makes the first cell's further input out of the last cell's state a frame before. Called by several threads at once, for samples
/// of their own.
template <typename T>
class GruFeedback {
  public:
    virtual ~GruFeedback() = default;

    virtual std::int64_t numbers() const = 0;  ///< that are fed back
    virtual const T* weight() const = 0;  ///< (3*hidden, numbers), which the first cell's gates get of them

    /// Before the first frame, of samples from `first` on.
    virtual void begin(std::int64_t /*first*/, std::int64_t /*count*/) {}

    /// states (count, hidden) of frame `frame`, samples from `first` on -> fed (count, numbers), for the next frame.
    virtual void forward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* states,
                         T* fed) = 0;

    /// grad_fed (count, numbers), null behind the last frame -> grad_states (count, hidden), overwritten.
    virtual void backward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* grad_fed,
                          T* grad_states) = 0;
};

/// A frame of what the first cell's gates are given, but for what is fed back: to (count, 3*hidden), samples from `first` on.
template <typename T>
void gru_input_rows(const GruShape& shape, const GruInput<T>& input, std::int64_t frame, std::int64_t first,
                    std::int64_t count, T* to);

/// One cell by itself, a frame at a time.
template <typename T>
class GruStep {
  public:
    GruStep(std::int64_t hidden, const GruCell<T>& cell, int threads);

    /// in (count, 3*hidden) what the gates are given, before (count, hidden) -> state (count, hidden), which may be `before`; gates
    /// (count, 4*hidden) as in GruTrace, or null.
    void run(std::int64_t count, const T* in, const T* before, T* state, T* gates) const;

  private:
    std::int64_t hidden_;
    const T* bias_;
    PackedMatrix<T> weight_;
};

/// `feedback` may be null.
template <typename T>
void gru_forward(const GruShape& shape, const GruInput<T>& input, std::span<const GruCell<T>> cells,
                 GruFeedback<T>* feedback, std::span<const GruTrace<T>> traces, int threads);

/// A cell's gradients, overwritten.
template <typename T>
struct GruGradient {
    /// (frames, samples, 4*hidden): to U_n h + c_n, and to what the three gates r, z, n are given. Those to its other hidden products
    /// are those to r and z.
    T* gates;
    T* of_frame;  ///< (frames, 4*hidden): sums over the samples
};

/// `grad_states` (frames, samples, hidden) to the last cell's states; null where feedback.backward() gives them all. `of_sample`
/// (samples, 3*hidden): sums over frames of the first cell's gradients to r, z, n.
template <typename T>
void gru_backward(const GruShape& shape, std::span<const GruCell<T>> cells, GruFeedback<T>* feedback,
                  std::span<const GruTrace<T>> traces, const T* grad_states,
                  std::span<const GruGradient<T>> to, T* of_sample, int threads);

}  // namespace actformer::model::cpu
