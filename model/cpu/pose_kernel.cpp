// Tokens to motions. The head's rows are taken number by number, (numbers, nodes), as motions lie: nodes are the vectors.
#include <limits>

#include "model/cpu/gram_schmidt.hpp"
#include "model/cpu/layer_support.hpp"
#include "model/cpu/motion_kernels.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct TurnedWeight {};
struct TurnedBias {};
struct NormalRows {};
struct RawRows {};
struct RawGrad {};
struct NormalGrad {};
struct HeadGrad {};
struct HeadBiasGrad {};
struct HeadLayer {};
struct NormLayer {};

constexpr double length_epsilon = 1e-4;

/// Rows (nodes, numbers) of `width` numbers to (numbers, nodes), or back.
template <typename T>
void turn(const T* from, std::int64_t nodes, std::int64_t numbers, std::int64_t width, bool back, T* to) {
    for (std::int64_t k = 0; k < nodes; ++k)
        for (std::int64_t d = 0; d < numbers; ++d) {
            const auto by_node = (k * numbers + d) * width, by_number = (d * nodes + k) * width;
            std::copy_n(from + (back ? by_number : by_node), width, to + (back ? by_node : by_number));
        }
}

/// From rows `step` apart, `here` numbers of each.
template <typename T>
Vectors<T> load_vectors(const T* from, std::int64_t step, std::int64_t here) {
    Vectors<T> out;
    for (std::int64_t d = 0; d < axes; ++d) out[d] = load_part(from + d * step, here);
    return out;
}

template <typename T>
void store_vectors(const Vectors<T>& vectors, T* to, std::int64_t step, std::int64_t here) {
    for (std::int64_t d = 0; d < axes; ++d) store_part(to + d * step, vectors[d], here);
}

/// tanh of what load_vectors gives.
template <typename T>
Vectors<T> bounded(const T* raw, std::int64_t step, std::int64_t here) {
    auto out = load_vectors(raw, step, here);
    for (std::int64_t d = 0; d < axes; ++d) out[d] = hyperbolic_tangent(out[d]);
    return out;
}

/// Back through bounded(): `grad` times 1 - tanh^2.
template <typename T>
Vectors<T> bounded_backward(const Vectors<T>& bounded, const Vectors<T>& grad) {
    Vectors<T> out;
    for (std::int64_t d = 0; d < axes; ++d) out[d] = grad[d] * (1 - bounded[d] * bounded[d]);
    return out;
}

/// Limb vectors y = l / (|l| + e), l = tanh(raw).
template <typename T>
struct UnitFinish {
    static constexpr std::int64_t numbers = axes;

    static void forward(const T* raw, std::int64_t nodes, T* motion, std::int64_t step, std::int64_t here) {
        const auto limbs = bounded(raw, nodes, here);
        const auto over = 1 / (root(dot(limbs, limbs)) + static_cast<T>(length_epsilon));
        for (std::int64_t d = 0; d < axes; ++d) store_part(motion + d * step, limbs[d] * over, here);
    }

    /// With s = |l|: dl = dy / (s + e) - l (l . dy) / (s (s + e)^2); the second term is 0 where l is.
    static void backward(const T* raw, std::int64_t nodes, const T* grad, std::int64_t step, T* to,
                         std::int64_t here) {
        const auto limbs = bounded(raw, nodes, here), g = load_vectors(grad, step, here);
        const auto length = root(dot(limbs, limbs)), over = 1 / (length + static_cast<T>(length_epsilon));
        const Lanes<T> still = Lanes<T>{} + std::numeric_limits<T>::min();
        const auto pull = dot(g, limbs) * over * over / (length > still ? length : still);
        Vectors<T> to_limbs;
        for (std::int64_t d = 0; d < axes; ++d) to_limbs[d] = g[d] * over - limbs[d] * pull;
        store_vectors(bounded_backward(limbs, to_limbs), to, nodes, here);
    }
};

/// The first two rows of rotations, of a and b = tanh(raw).
template <typename T>
struct OrthonormalFinish {
    static constexpr std::int64_t numbers = 2 * axes;

    static void forward(const T* raw, std::int64_t nodes, T* motion, std::int64_t step, std::int64_t here) {
        const Orthonormal<T> rows(bounded(raw, nodes, here), bounded(raw + axes * nodes, nodes, here));
        store_vectors(rows.first(), motion, step, here);
        store_vectors(rows.second(), motion + axes * step, step, here);
    }

    static void backward(const T* raw, std::int64_t nodes, const T* grad, std::int64_t step, T* to,
                         std::int64_t here) {
        const auto a = bounded(raw, nodes, here), b = bounded(raw + axes * nodes, nodes, here);
        const auto back = Orthonormal<T>(a, b).backward(load_vectors(grad, step, here),
                                                        load_vectors(grad + axes * step, step, here));
        store_vectors(bounded_backward(a, back.a), to, nodes, here);
        store_vectors(bounded_backward(b, back.b), to + axes * nodes, nodes, here);
    }
};

/// One frame through a finish: `raw` (numbers, nodes), and `step` numbers between those of a motion's node.
template <typename Finish, typename T>
void finish_frame(const T* raw, std::int64_t nodes, T* motion, std::int64_t step) {
    for (std::int64_t k = 0; k < nodes; k += lanes<T>)
        Finish::forward(raw + k, nodes, motion + k, step, std::min<std::int64_t>(lanes<T>, nodes - k));
}

template <typename Finish, typename T>
void finish_frame_backward(const T* raw, std::int64_t nodes, const T* grad, std::int64_t step, T* to) {
    for (std::int64_t k = 0; k < nodes; k += lanes<T>)
        Finish::backward(raw + k, nodes, grad + k, step, to + k, std::min<std::int64_t>(lanes<T>, nodes - k));
}

/// Copies rows of `width` numbers.
template <typename T>
void copy_rows(const T* from, std::int64_t from_step, T* to, std::int64_t to_step, std::int64_t rows,
               std::int64_t width) {
    for (std::int64_t r = 0; r < rows; ++r) std::copy_n(from + r * from_step, width, to + r * to_step);
}

/// The free node's position as it is, and 0 behind it, in rows one number apart of `step` numbers.
template <typename T>
void free_position(const T* from, std::int64_t from_step, T* to, std::int64_t to_step, std::int64_t numbers) {
    for (std::int64_t d = 0; d < numbers; ++d) to[d * to_step] = d < axes ? from[d * from_step] : T(0);
}

/// One frame: `step` numbers lie between a motion's numbers of a node.
template <typename T>
void shape_frame(const T* raw, const PoseShape& shape, T* motion, std::int64_t step) {
    const auto nodes = shape.nodes;
    switch (shape.representation.finish()) {
        case ingest::Finish::unit:
            finish_frame<UnitFinish<T>>(raw, nodes, motion, step);
            break;
        case ingest::Finish::orthonormal:
            finish_frame<OrthonormalFinish<T>>(raw, nodes, motion, step);
            break;
        case ingest::Finish::linear:
            copy_rows(raw, nodes, motion, step, shape.numbers(), nodes);
            break;
    }
    if (const auto free = shape.representation.free_node(static_cast<std::uint32_t>(nodes)))
        free_position(raw + *free, nodes, motion + *free, step, shape.numbers());
}

template <typename T>
void shape_frame_backward(const T* raw, const PoseShape& shape, const T* grad, std::int64_t step, T* to) {
    const auto nodes = shape.nodes;
    switch (shape.representation.finish()) {
        case ingest::Finish::unit:
            finish_frame_backward<UnitFinish<T>>(raw, nodes, grad, step, to);
            break;
        case ingest::Finish::orthonormal:
            finish_frame_backward<OrthonormalFinish<T>>(raw, nodes, grad, step, to);
            break;
        case ingest::Finish::linear:
            copy_rows(grad, step, to, nodes, shape.numbers(), nodes);
            break;
    }
    if (const auto free = shape.representation.free_node(static_cast<std::uint32_t>(nodes)))
        free_position(grad + *free, step, to + *free, nodes, shape.numbers());
}

}  // namespace

std::int64_t PoseShape::raw_pitch() const {
    return (numbers() * nodes + 15) / 16 * 16;
}

template <typename T>
void pose_forward(const PoseShape& shape, const T* x, const PoseWeights<T>& weights, T* kept, T* motion,
                  int threads) {
    const auto width = shape.tokens.width, frames = shape.frames(), nodes = shape.nodes,
               numbers = shape.numbers(), out = numbers * nodes, pitch = padded<T>(width),
               raw_pitch = shape.raw_pitch();
    T* turned = scratch<T>(TurnedWeight{}, out * width);
    T* turned_biases = scratch<T>(TurnedBias{}, out);
    turn(weights.head.weight, nodes, numbers, width, false, turned);
    turn(weights.head.bias, nodes, numbers, 1, false, turned_biases);
    const auto head = packed_forward<T>(HeadLayer{}, {turned, turned_biases}, out, width, threads);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t sequence = 0; sequence < shape.tokens.samples * shape.tokens.persons; ++sequence) {
        const T* from = x + (sequence * shape.tokens.tokens + 1) * width;  // behind the class
        T* normal = scratch<T>(NormalRows{}, frames * pitch);
        T* raw = kept ? kept + sequence * frames * raw_pitch : scratch<T>(RawRows{}, frames * raw_pitch);
        normalise_rows(from, frames, width, weights.norm, normal, pitch);
        product<T>(EvenRows<T>{normal, pitch}, frames, head.weight, out,
                   StoreBiased<T>{raw, raw_pitch, head.bias});
        for (std::int64_t t = 0; t < frames; ++t)
            shape_frame(raw + t * raw_pitch, shape, motion + (sequence * numbers * frames + t) * nodes,
                        frames * nodes);
    }
}

template <typename T>
void pose_backward(const PoseShape& shape, const T* x, const PoseWeights<T>& weights, const T* kept,
                   const T* grad, const PoseGradients<T>& to, int threads) {
    const auto width = shape.tokens.width, frames = shape.frames(), nodes = shape.nodes,
               numbers = shape.numbers(), out = numbers * nodes, pitch = padded<T>(width),
               raw_pitch = shape.raw_pitch();
    T* turned = scratch<T>(TurnedWeight{}, out * width);
    turn(weights.head.weight, nodes, numbers, width, false, turned);
    const auto& head = packed_backward<T>(HeadLayer{}, {turned, nullptr}, out, width, threads);
    const ParameterGradient<T> to_head{scratch<T>(HeadGrad{}, out * width), scratch<T>(HeadBiasGrad{}, out)};
    NormSums<T> norm_sums(threads, width);
    LinearSums<T> head_sums(threads, out, width);
#pragma omp parallel num_threads(threads)
    {
        const auto own_norm = norm_sums.own(NormLayer{});
        const auto own_head = head_sums.own(HeadLayer{});
        T* normal = scratch<T>(NormalRows{}, frames * pitch);
        T* to_raw = scratch<T>(RawGrad{}, frames * raw_pitch);
        T* back = scratch<T>(NormalGrad{}, frames * pitch);
#pragma omp for schedule(static)
        for (std::int64_t sequence = 0; sequence < shape.tokens.samples * shape.tokens.persons; ++sequence) {
            const auto first = (sequence * shape.tokens.tokens + 1) * width;
            const T* from = x + first;
            for (std::int64_t t = 0; t < frames; ++t)
                shape_frame_backward(kept + (sequence * frames + t) * raw_pitch, shape,
                                     grad + (sequence * numbers * frames + t) * nodes, frames * nodes,
                                     to_raw + t * raw_pitch);
            normalise_rows(from, frames, width, weights.norm, normal, pitch);
            own_head.add({to_raw, raw_pitch}, {normal, pitch}, frames);
            product<T>(EvenRows<T>{to_raw, raw_pitch}, frames, head, width, StorePlain<T>{back, pitch});
            std::fill_n(to.x + first - width, width, T(0));
            normalise_rows_backward<T>(from, back, pitch, frames, width, weights.norm, nullptr, to.x + first,
                                       own_norm);
        }
        norm_sums.write(to.norm);
        head_sums.write(to_head);
    }
    turn(to_head.weight, nodes, numbers, width, true, to.head.weight);
    turn(to_head.bias, nodes, numbers, 1, true, to.head.bias);
}

#define ACTFORMER_POSE(T)                                                                                 \
    template void pose_forward<T>(const PoseShape&, const T*, const PoseWeights<T>&, T*, T*, int);        \
    template void pose_backward<T>(const PoseShape&, const T*, const PoseWeights<T>&, const T*, const T*, \
                                   const PoseGradients<T>&, int);
ACTFORMER_POSE(float)
ACTFORMER_POSE(double)

}  // namespace actformer::model::cpu
