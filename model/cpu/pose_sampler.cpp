#include "model/cpu/pose_sampler.hpp"

#include "model/cpu/kernel_support.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct PriorGates {};
struct HeadRows {};
struct NoGateBias {};

}  // namespace

template <typename T>
PoseSampler<T>::PoseSampler(const GruShape& shape, PoseFeedback<T>& poses, const PriorWeights<T>& prior,
                            T* products, int threads)
    : shape_(shape),
      poses_(poses),
      prior_(prior),
      products_(products),
      step_(shape.hidden, prior.cell, threads),
      states_(static_cast<std::size_t>(shape.samples * shape.hidden)) {
    pack_forward(pose_, prior.pose, 3 * shape.hidden, poses.numbers(), threads);
    pack_forward(head_, prior.head.weight, 2 * prior.latents, shape.hidden, threads);
    pack_forward(latent_, prior.latent, 3 * shape.hidden, prior.latents, threads);
    head_bias_.resize(static_cast<std::size_t>(panel_padded<T>(2 * prior.latents)));
    std::copy_n(prior.head.bias, 2 * prior.latents, head_bias_.begin());
}

template <typename T>
void PoseSampler<T>::begin(std::int64_t first, std::int64_t count) {
    draw(0, first, count, nullptr);
}

template <typename T>
void PoseSampler<T>::forward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* states,
                             T* fed) {
    poses_.forward(frame, first, count, states, fed);
    if (frame + 1 < shape_.frames) draw(frame + 1, first, count, fed);
}

/// The prior's step in a frame, having seen the last pose (nothing in the first), and what comes of its latent.
template <typename T>
void PoseSampler<T>::draw(std::int64_t frame, std::int64_t first, std::int64_t count, const T* seen) {
    const auto width = 3 * shape_.hidden, latents = prior_.latents, pitch = panel_padded<T>(2 * latents);
    T *gates = scratch<T>(PriorGates{}, count * width), *state = states_.data() + first * shape_.hidden,
      *head = scratch<T>(HeadRows{}, count * pitch);
    const T* no_bias = zeroed_scratch<T>(NoGateBias{}, width);
    gru_input_rows(shape_, prior_.input, frame, first, count, gates);
    if (seen)
        product<T>(EvenRows<T>{seen, poses_.numbers()}, count, pose_, width,
                   StoreAdded<T>{gates, gates, width, width, no_bias});
    step_.run(count, gates, state, state, nullptr);
    product<T>(EvenRows<T>{state, shape_.hidden}, count, head_, 2 * latents,
               StoreBiased<T>{head, pitch, head_bias_.data()});
    const auto row = frame * shape_.samples + first;
    for (std::int64_t i = 0; i < count; ++i) {
        T* mean = head + i * pitch;
        const T *variance = mean + latents, *noise = prior_.noise + (row + i) * latents;
        for (std::int64_t z = 0; z < latents; ++z) mean[z] += noise[z] * std::exp(T(0.5) * variance[z]);
    }
    product<T>(EvenRows<T>{head, pitch}, count, latent_, width,
               StorePlain<T>{products_ + row * width, width});
}

template class PoseSampler<float>;
template class PoseSampler<double>;

}  // namespace actformer::model::cpu
