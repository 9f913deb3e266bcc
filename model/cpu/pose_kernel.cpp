// Tokens to motions. The head's rows are taken number by number, (3, joints), as motions lie: joints are the vectors.
#include <limits>

#include "model/cpu/kernel_support.hpp"
#include "model/cpu/motion_kernels.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

constexpr std::int64_t axes = 3;

/// What scratch memory is for.
struct TurnedWeight {};
struct TurnedBias {};
struct BiasRow {};
struct NormalRows {};
struct RawRows {};
struct RawGrad {};
struct NormalGrad {};
struct OuterPanel {};
struct SumsNormWeight {};
struct SumsNormBias {};
struct SumsHead {};
struct SumsHeadBias {};
struct HeadGrad {};
struct HeadBiasGrad {};
struct HeadWeight {};

constexpr double length_epsilon = 1e-4;

/// Rows (joints, axes) of `width` numbers to (axes, joints), or back.
template <typename T>
void turn(const T* from, std::int64_t joints, std::int64_t width, bool back, T* to) {
    for (std::int64_t k = 0; k < joints; ++k)
        for (std::int64_t d = 0; d < axes; ++d) {
            const auto by_joint = (k * axes + d) * width, by_axis = (d * joints + k) * width;
            std::copy_n(from + (back ? by_axis : by_joint), width, to + (back ? by_joint : by_axis));
        }
}

/// Some joints' limbs.
template <typename T>
struct Limbs {
    Lanes<T> bent[axes], length;

    /// `raw` (axes, joints) of one frame, from joint k on, `here` of them.
    Limbs(const T* raw, std::int64_t joints, std::int64_t k, std::int64_t here) {
        Lanes<T> square = {};
        for (std::int64_t d = 0; d < axes; ++d) {
            bent[d] = hyperbolic_tangent(load_part(raw + d * joints + k, here));
            square += bent[d] * bent[d];
        }
        length = root(square);
    }
};

/// One frame: `step` numbers lie between a motion's axes.
template <typename T>
void shape_frame(const T* raw, const PoseShape& shape, T* motion, std::int64_t step) {
    const auto joints = shape.joints;
    for (std::int64_t k = 0; k < joints; k += lanes<T>) {
        const auto here = std::min<std::int64_t>(lanes<T>, joints - k);
        const Limbs<T> limbs(raw, joints, k, here);
        const auto over = 1 / (limbs.length + static_cast<T>(length_epsilon));
        for (std::int64_t d = 0; d < axes; ++d) store_part(motion + d * step + k, limbs.bent[d] * over, here);
    }
    for (std::int64_t d = 0; d < axes; ++d)
        motion[d * step + shape.free_joint] = raw[d * joints + shape.free_joint];
}

/// With y = l / (s + e), s = |l|: dl = dy / (s + e) - l (l . dy) / (s (s + e)^2); the second term is 0 where l is.
template <typename T>
void shape_frame_backward(const T* raw, const PoseShape& shape, const T* grad, std::int64_t step, T* to) {
    const auto joints = shape.joints;
    for (std::int64_t k = 0; k < joints; k += lanes<T>) {
        const auto here = std::min<std::int64_t>(lanes<T>, joints - k);
        const Limbs<T> limbs(raw, joints, k, here);
        const auto over = 1 / (limbs.length + static_cast<T>(length_epsilon));
        Lanes<T> g[axes], along = {};
        for (std::int64_t d = 0; d < axes; ++d) {
            g[d] = load_part(grad + d * step + k, here);
            along += g[d] * limbs.bent[d];
        }
        const Lanes<T> still = Lanes<T>{} + std::numeric_limits<T>::min();
        const auto pull = along * over * over / (limbs.length > still ? limbs.length : still);
        for (std::int64_t d = 0; d < axes; ++d) {
            const auto slope = 1 - limbs.bent[d] * limbs.bent[d];
            store_part(to + d * joints + k, (g[d] * over - limbs.bent[d] * pull) * slope, here);
        }
    }
    for (std::int64_t d = 0; d < axes; ++d)
        to[d * joints + shape.free_joint] = grad[d * step + shape.free_joint];
}

}  // namespace

std::int64_t PoseShape::raw_pitch() const {
    return (axes * joints + 15) / 16 * 16;
}

template <typename T>
void pose_forward(const PoseShape& shape, const T* x, const PoseWeights<T>& weights, T* kept, T* motion,
                  int threads) {
    const auto width = shape.tokens.width, frames = shape.frames(), joints = shape.joints,
               out = axes * joints, pitch = padded<T>(width), raw_pitch = shape.raw_pitch();
    T* turned = scratch<T>(TurnedWeight{}, out * width);
    T* turned_biases = scratch<T>(TurnedBias{}, out);
    turn(weights.head.weight, joints, width, false, turned);
    turn(weights.head.bias, joints, 1, false, turned_biases);
    auto& packed = packed_scratch<T>(HeadWeight{});
    pack_forward(packed, turned, out, width, threads);
    const T* bias = padded_copy(BiasRow{}, turned_biases, out);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t sequence = 0; sequence < shape.tokens.samples * shape.tokens.persons; ++sequence) {
        const T* from = x + (sequence * shape.tokens.tokens + 1) * width;  // behind the class
        T* normal = scratch<T>(NormalRows{}, frames * pitch);
        T* raw = kept ? kept + sequence * frames * raw_pitch : scratch<T>(RawRows{}, frames * raw_pitch);
        for (std::int64_t t = 0; t < frames; ++t)
            normalise_row(from + t * width, width, weights.norm.weight, weights.norm.bias,
                          normal + t * pitch);
        product<T>(EvenRows<T>{normal, pitch}, frames, packed, out, StoreBiased<T>{raw, raw_pitch, bias});
        for (std::int64_t t = 0; t < frames; ++t)
            shape_frame(raw + t * raw_pitch, shape, motion + (sequence * axes * frames + t) * joints,
                        frames * joints);
    }
}

template <typename T>
void pose_backward(const PoseShape& shape, const T* x, const PoseWeights<T>& weights, const T* kept,
                   const T* grad, const PoseGradients<T>& to, int threads) {
    const auto width = shape.tokens.width, frames = shape.frames(), joints = shape.joints,
               out = axes * joints, pitch = padded<T>(width), raw_pitch = shape.raw_pitch();
    T* turned = scratch<T>(TurnedWeight{}, out * width);
    turn(weights.head.weight, joints, width, false, turned);
    auto& packed = packed_scratch<T>(HeadWeight{});
    pack_backward(packed, turned, out, width, threads);
    T *to_head = scratch<T>(HeadGrad{}, out * width), *to_head_bias = scratch<T>(HeadBiasGrad{}, out);
    ThreadSums<T> norm_weight(threads, 1, width), norm_bias(threads, 1, width), head(threads, out, width),
        head_bias(threads, 1, out);
#pragma omp parallel num_threads(threads)
    {
        T *own_norm = norm_weight.own(SumsNormWeight{}), *own_norm_bias = norm_bias.own(SumsNormBias{}),
          *own_head = head.own(SumsHead{}), *own_bias = head_bias.own(SumsHeadBias{});
        T* normal = scratch<T>(NormalRows{}, frames * pitch);
        T* to_raw = scratch<T>(RawGrad{}, frames * raw_pitch);
        T* back = scratch<T>(NormalGrad{}, frames * pitch);
        T* panel = scratch<T>(OuterPanel{}, frames * panel_columns<T>);
#pragma omp for schedule(static)
        for (std::int64_t sequence = 0; sequence < shape.tokens.samples * shape.tokens.persons; ++sequence) {
            const auto first = (sequence * shape.tokens.tokens + 1) * width;
            const T* from = x + first;
            for (std::int64_t t = 0; t < frames; ++t) {
                shape_frame_backward(kept + (sequence * frames + t) * raw_pitch, shape,
                                     grad + (sequence * axes * frames + t) * joints, frames * joints,
                                     to_raw + t * raw_pitch);
                add_row(to_raw + t * raw_pitch, out, own_bias);
                normalise_row(from + t * width, width, weights.norm.weight, weights.norm.bias,
                              normal + t * pitch);
            }
            add_outer_products<T>(
                to_raw, raw_pitch, out, [=](std::int64_t t) { return normal + t * pitch; }, width, frames,
                panel, own_head, head.pitch());
            product<T>(EvenRows<T>{to_raw, raw_pitch}, frames, packed, width, StorePlain<T>{back, pitch});
            std::fill_n(to.x + first - width, width, T(0));
            for (std::int64_t t = 0; t < frames; ++t)
                normalise_row_backward<T>(from + t * width, back + t * pitch, width, weights.norm.weight,
                                          nullptr, to.x + first + t * width, own_norm, own_norm_bias);
        }
        norm_weight.write(to.norm.weight);
        norm_bias.write(to.norm.bias);
        head.write(to_head);
        head_bias.write(to_head_bias);
    }
    turn(to_head, joints, width, true, to.head.weight);
    turn(to_head_bias, joints, 1, true, to.head.bias);
}

#define ACTFORMER_POSE(T)                                                                                 \
    template void pose_forward<T>(const PoseShape&, const T*, const PoseWeights<T>&, T*, T*, int);        \
    template void pose_backward<T>(const PoseShape&, const T*, const PoseWeights<T>&, const T*, const T*, \
                                   const PoseGradients<T>&, int);
ACTFORMER_POSE(float)
ACTFORMER_POSE(double)

}  // namespace actformer::model::cpu
