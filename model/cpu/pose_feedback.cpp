#include "model/cpu/pose_feedback.hpp"

#include "model/cpu/kernel_support.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

constexpr double widest = 3.1415926;  ///< radians about each axis, as published

/// What scratch memory is for.
struct OutRows {};
struct JointRows {};
struct AngleRows {};

/// to = scale * tanh(from), `count` numbers; to may be from.
template <typename T>
void tanh_row(const T* from, std::int64_t count, T scale, T* to) {
    std::int64_t i = 0;
    for (; i + lanes<T> <= count; i += lanes<T>) store(to + i, scale * hyperbolic_tangent(load(from + i)));
    if (i < count) store_part(to + i, scale * hyperbolic_tangent(load_part(from + i, count - i)), count - i);
}

template <typename T>
std::vector<T> padded_bias(const T* bias, std::int64_t count) {
    std::vector<T> out(static_cast<std::size_t>(panel_padded<T>(count)));
    std::copy_n(bias, count, out.begin());
    return out;
}

/// Stores sums with a bias in rows of exactly `columns` numbers.
template <typename T>
struct StoreExactBiased {
    T* to;
    std::ptrdiff_t pitch, columns;
    const T* bias;  ///< padded

    template <int R, int W>
    void operator()(std::ptrdiff_t row, std::ptrdiff_t column, const Lanes<T> (&sums)[R][W]) const {
        for_each_sum<T>(row, column, sums, [this](std::ptrdiff_t r, std::ptrdiff_t c, Lanes<T> sum) {
            T* at = to + r * pitch + c;
            sum += load(bias + c);
            columns - c >= lanes<T> ? store(at, sum) : store_part(at, sum, columns - c);
        });
    }
};

}  // namespace

template <typename T>
PoseFeedback<T>::PoseFeedback(const GruShape& shape, std::int64_t numbers, const T* weight,
                              const LinearWeight<T>& head, const ChainBody<T>* body,
                              const PoseTrace<T>& trace, const PoseGradient<T>* gradient, int threads)
    : shape_(shape),
      numbers_(numbers),
      weight_(weight),
      head_(head),
      body_(body),
      trace_(trace),
      gradient_(gradient) {
    const auto pack = gradient ? pack_backward<T> : pack_forward<T>;
    pack(packed_head_, head.weight, numbers, shape.hidden, threads);
    head_bias_ = padded_bias(head.bias, numbers);
    if (!body) return;
    pack(packed_lie_, body->weight.weight, numbers - 3, numbers - 3, threads);
    lie_bias_ = padded_bias(body->weight.bias, numbers - 3);
}

template <typename T>
void PoseFeedback<T>::forward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* states,
                              T* fed) {
    const auto row = at(frame, first);
    T* out = trace_.out + row * numbers_;
    product<T>(EvenRows<T>{states, shape_.hidden}, count, packed_head_, numbers_,
               StoreExactBiased<T>{out, numbers_, numbers_, head_bias_.data()});
    if (body_) place_joints(row, count);
    const T* seen = body_ && body_->feeds_joints ? trace_.joints + row * numbers_ : out;
    std::copy_n(seen, count * numbers_, fed);
}

template <typename T>
void PoseFeedback<T>::place_joints(std::int64_t row, std::int64_t count) {
    T *out = trace_.out + row * numbers_, *inner = trace_.inner + row * numbers_;
    for (std::int64_t i = 0; i < count; ++i) {
        std::copy_n(out + i * numbers_, 3, inner + i * numbers_);
        tanh_row(out + i * numbers_ + 3, numbers_ - 3, T(1), inner + i * numbers_ + 3);
    }
    product<T>(EvenRows<T>{inner + 3, numbers_}, count, packed_lie_, numbers_ - 3,
               StoreExactBiased<T>{out + 3, numbers_, numbers_ - 3, lie_bias_.data()});
    for (std::int64_t i = 0; i < count; ++i)
        tanh_row(out + i * numbers_ + 3, numbers_ - 3, static_cast<T>(widest), out + i * numbers_ + 3);
    chain_kinematics(*body_->chains, count, out, body_->bones + row * numbers_ / 3,
                     trace_.joints + row * numbers_);
}

template <typename T>
void PoseFeedback<T>::backward(std::int64_t frame, std::int64_t first, std::int64_t count, const T* grad_fed,
                               T* grad_states) {
    const auto row = at(frame, first);
    T* raw = gradient_->raw + row * numbers_;
    if (body_) {
        place_joints_backward(row, count, grad_fed);
    } else {
        std::copy_n(gradient_->out + row * numbers_, count * numbers_, raw);
        if (grad_fed) add_row(grad_fed, count * numbers_, raw);
    }
    product<T>(EvenRows<T>{raw, numbers_}, count, packed_head_, shape_.hidden,
               StorePlain<T>{grad_states, shape_.hidden});
}

/// The gradient to the linear map's outputs of that to joints and to what was fed back.
template <typename T>
void PoseFeedback<T>::place_joints_backward(std::int64_t row, std::int64_t count, const T* grad_fed) {
    const auto all = count * numbers_, angles = numbers_ - 3;
    const auto offset = row * numbers_;
    const T *out = trace_.out + offset, *inner = trace_.inner + offset;
    T *to_joints = scratch<T>(JointRows{}, all), *to_out = scratch<T>(OutRows{}, all),
      *raw = gradient_->raw + offset, *lie = gradient_->lie + row * angles;
    std::copy_n(gradient_->joints + offset, all, to_joints);
    if (grad_fed && body_->feeds_joints) add_row(grad_fed, all, to_joints);
    chain_kinematics_backward(*body_->chains, count, out, body_->bones + row * numbers_ / 3, to_joints,
                              to_out);
    if (gradient_->out) add_row(gradient_->out + offset, all, to_out);
    if (grad_fed && !body_->feeds_joints) add_row(grad_fed, all, to_out);
    constexpr T full = static_cast<T>(widest), share = 1 / full;
    for (std::int64_t i = 0; i < count; ++i)
        for (std::int64_t c = 0; c < angles; ++c) {
            const T bounded = out[i * numbers_ + 3 + c] * share;
            lie[i * angles + c] = to_out[i * numbers_ + 3 + c] * full * (1 - bounded * bounded);
        }
    T* to_inner = scratch<T>(AngleRows{}, count * angles);
    product<T>(EvenRows<T>{lie, angles}, count, packed_lie_, angles, StoreExact<T>{to_inner, angles, angles});
    for (std::int64_t i = 0; i < count; ++i) {
        std::copy_n(to_out + i * numbers_, 3, raw + i * numbers_);
        for (std::int64_t c = 0; c < angles; ++c) {
            const T bounded = inner[i * numbers_ + 3 + c];
            raw[i * numbers_ + 3 + c] = to_inner[i * angles + c] * (1 - bounded * bounded);
        }
    }
}

template class PoseFeedback<float>;
template class PoseFeedback<double>;

}  // namespace actformer::model::cpu
