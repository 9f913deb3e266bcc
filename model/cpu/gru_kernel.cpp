#include "model/cpu/gru_kernel.hpp"

#include <algorithm>
#include <utility>

#include "model/cpu/kernel_support.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct GateRows {};
struct HiddenRows {};
struct FedRows {};
struct FedGrad {};
struct NoState {};
struct NoBias {};
struct StateGrad {};
struct CarriedGrad {};
struct FrameSums {};

inline Floats sigmoid(Floats x) {
    return reciprocal(exponential(-x) + 1.0F);
}

inline Doubles sigmoid(Doubles x) {
    return 1.0 / (exponential(-x) + 1.0);
}

/// The samples of the calling thread of a team.
struct Share {
    std::int64_t first, count;

    explicit Share(std::int64_t samples) {
        const std::int64_t thread = omp_get_thread_num(), team = omp_get_num_threads();
        first = samples * thread / team;
        count = samples * (thread + 1) / team - first;
    }
};

/// A stack's weights packed for products, a way.
template <typename T>
struct PackedStack {
    struct Cell {
        PackedMatrix<T> input, hidden;
    };
    std::vector<Cell> cells;
    PackedMatrix<T> feedback;
};

template <typename T>
PackedStack<T>& packed_forward(std::span<const GruCell<T>> cells, const GruFeedback<T>* feedback,
                               std::int64_t hidden, int threads) {
    thread_local PackedStack<T> packed;
    packed.cells.resize(std::max(packed.cells.size(), cells.size()));
    for (std::size_t l = 0; l < cells.size(); ++l) {
        pack_forward(packed.cells[l].hidden, cells[l].hidden_weight, 3 * hidden, hidden, threads);
        if (l > 0) pack_forward(packed.cells[l].input, cells[l].input_weight, 3 * hidden, hidden, threads);
    }
    if (feedback) pack_forward(packed.feedback, feedback->weight(), 3 * hidden, feedback->numbers(), threads);
    return packed;
}

/// Hidden weights with rows in the order n, r, z, as gradients lie.
template <typename T>
PackedStack<T>& packed_backward(std::span<const GruCell<T>> cells, const GruFeedback<T>* feedback,
                                std::int64_t hidden, int threads) {
    thread_local PackedStack<T> packed;
    packed.cells.resize(std::max(packed.cells.size(), cells.size()));
    const auto gate = hidden * hidden;
    std::vector<T> turned(static_cast<std::size_t>(3 * gate));
    for (std::size_t l = 0; l < cells.size(); ++l) {
        const T* weight = cells[l].hidden_weight;
        std::copy_n(weight + 2 * gate, gate, turned.data());
        std::copy_n(weight, 2 * gate, turned.data() + gate);
        pack_backward(packed.cells[l].hidden, turned.data(), 3 * hidden, hidden, threads);
        if (l > 0) pack_backward(packed.cells[l].input, cells[l].input_weight, 3 * hidden, hidden, threads);
    }
    if (feedback)
        pack_backward(packed.feedback, feedback->weight(), 3 * hidden, feedback->numbers(), threads);
    return packed;
}

/// One sample's new state out of what its gates are given, `in` (3*hidden), and its hidden products, `of_state` (3*hidden).
template <typename T>
void step_row(std::int64_t hidden, const T* in, const T* of_state, const T* before, T* state, T* gates) {
    for (std::int64_t i = 0; i < hidden; i += lanes<T>) {
        const auto u = load(of_state + 2 * hidden + i);
        const auto r = sigmoid(load(in + i) + load(of_state + i));
        const auto z = sigmoid(load(in + hidden + i) + load(of_state + hidden + i));
        const auto n = hyperbolic_tangent(load(in + 2 * hidden + i) + r * u);
        store(state + i, n + z * (load(before + i) - n));
        if (!gates) continue;
        store(gates + i, u);
        store(gates + hidden + i, r);
        store(gates + 2 * hidden + i, z);
        store(gates + 3 * hidden + i, n);
    }
}

/// A cell's frame: see GruStep::run.
template <typename T>
void step_rows(std::int64_t hidden, const PackedMatrix<T>& weight, const T* bias, std::int64_t count,
               const T* in, const T* before, T* state, T* gates) {
    const auto width = 3 * hidden;
    T* of_state = scratch<T>(HiddenRows{}, count * width);
    product<T>(EvenRows<T>{before, hidden}, count, weight, width, StoreBiased<T>{of_state, width, bias});
    for (std::int64_t i = 0; i < count; ++i)
        step_row(hidden, in + i * width, of_state + i * width, before + i * hidden, state + i * hidden,
                 gates ? gates + i * 4 * hidden : nullptr);
}

/// Of the gradient to a state, `grad`: those to the gates (4*hidden), and in `carried` the part to the state before that does not go
/// through the gates. Sums of the gates' are added to `sums`, and to `of_sample` where there is one.
template <typename T>
void step_back_row(std::int64_t hidden, const T* grad, const T* gates, const T* before, T* to, T* carried,
                   T* sums, T* of_sample) {
    for (std::int64_t i = 0; i < hidden; i += lanes<T>) {
        const auto g = load(grad + i), u = load(gates + i), r = load(gates + hidden + i),
                   z = load(gates + 2 * hidden + i), n = load(gates + 3 * hidden + i);
        const auto to_n = g * (1 - z) * (1 - n * n), to_z = g * (load(before + i) - n) * z * (1 - z),
                   to_r = to_n * u * r * (1 - r), to_u = to_n * r;
        store(carried + i, g * z);
        const Lanes<T> all[4] = {to_u, to_r, to_z, to_n};
#pragma GCC unroll 4
        for (int gate = 0; gate < 4; ++gate) {
            const auto at = gate * hidden + i;
            store(to + at, all[gate]);
            store(sums + at, load(sums + at) + all[gate]);
            if (of_sample && gate > 0)
                store(of_sample + at - hidden, load(of_sample + at - hidden) + all[gate]);
        }
    }
}

/// A thread's samples on their way through the frames.
template <typename T>
class ForwardPass {
  public:
    ForwardPass(const GruShape& shape, std::span<const GruCell<T>> cells, GruFeedback<T>* feedback,
                std::span<const GruTrace<T>> traces, const PackedStack<T>& packed)
        : shape_(shape),
          share_(shape.samples),
          cells_(cells),
          feedback_(feedback),
          traces_(traces),
          packed_(packed),
          in_(scratch<T>(GateRows{}, share_.count * 3 * shape.hidden)),
          fed_(feedback ? scratch<T>(FedRows{}, share_.count * feedback->numbers()) : nullptr),
          zeros_(zeroed_scratch<T>(NoState{}, share_.count * shape.hidden)),
          no_bias_(zeroed_scratch<T>(NoBias{}, 3 * shape.hidden)) {
        if (feedback) feedback->begin(share_.first, share_.count);
    }

    void frame(std::int64_t t, const GruInput<T>& input) {
        if (share_.count == 0) return;
        const auto width = 3 * shape_.hidden;
        gru_input_rows(shape_, input, t, share_.first, share_.count, in_);
        if (feedback_ && t > 0)
            product<T>(EvenRows<T>{fed_, feedback_->numbers()}, share_.count, packed_.feedback, width,
                       StoreAdded<T>{in_, in_, width, width, no_bias_});
        for (std::size_t l = 0; l < cells_.size(); ++l) {
            if (l > 0)
                product<T>(EvenRows<T>{states(l - 1, t), shape_.hidden}, share_.count, packed_.cells[l].input,
                           width, StoreBiased<T>{in_, width, cells_[l].input_bias});
            cell(l, t);
        }
        if (feedback_) feedback_->forward(t, share_.first, share_.count, states(cells_.size() - 1, t), fed_);
    }

  private:
    T* states(std::size_t l, std::int64_t t) const {
        return traces_[l].states + (t * shape_.samples + share_.first) * shape_.hidden;
    }

    void cell(std::size_t l, std::int64_t t) {
        T* gates = traces_[l].gates;
        if (gates) gates += (t * shape_.samples + share_.first) * 4 * shape_.hidden;
        step_rows(shape_.hidden, packed_.cells[l].hidden, cells_[l].hidden_bias, share_.count, in_,
                  t > 0 ? states(l, t - 1) : zeros_, states(l, t), gates);
    }

    GruShape shape_;
    Share share_;
    std::span<const GruCell<T>> cells_;
    GruFeedback<T>* feedback_;
    std::span<const GruTrace<T>> traces_;
    const PackedStack<T>& packed_;
    T *in_, *fed_, *zeros_, *no_bias_;
};

/// The same backward.
template <typename T>
class BackwardPass {
  public:
    BackwardPass(const GruShape& shape, std::size_t cells, GruFeedback<T>* feedback,
                 std::span<const GruTrace<T>> traces, std::span<const GruGradient<T>> to, T* of_sample,
                 const PackedStack<T>& packed, T* sums)
        : shape_(shape),
          share_(shape.samples),
          cells_(cells),
          feedback_(feedback),
          traces_(traces),
          to_(to),
          packed_(packed),
          sums_(sums),
          of_sample_(of_sample + share_.first * 3 * shape.hidden),
          rows_(share_.count * shape.hidden),
          grad_(scratch<T>(StateGrad{}, rows_)),
          carried_(zeroed_scratch<T>(CarriedGrad{}, rows_ * static_cast<std::int64_t>(cells))),
          fed_(feedback ? scratch<T>(FedGrad{}, share_.count * feedback->numbers()) : nullptr),
          zeros_(zeroed_scratch<T>(NoState{}, rows_)),
          no_bias_(zeroed_scratch<T>(NoBias{}, shape.hidden)) {
        std::fill_n(of_sample_, share_.count * 3 * shape.hidden, T(0));
    }

    void frame(std::int64_t t, const T* grad_states) {
        if (share_.count == 0) return;
        last_state(t, grad_states);
        for (std::size_t l = cells_; l-- > 0;) {
            cell(l, t);
            const auto added = [&](const T* from, const PackedMatrix<T>& weight, T* onto, T* result) {
                product<T>(EvenRows<T>{from, 4 * shape_.hidden}, share_.count, weight, shape_.hidden,
                           StoreAdded<T>{onto, result, shape_.hidden, shape_.hidden, no_bias_});
            };
            if (t > 0) added(gates(l, t), packed_.cells[l].hidden, carried(l), carried(l));
            if (l > 0) added(gates(l, t) + shape_.hidden, packed_.cells[l].input, carried(l - 1), grad_);
        }
    }

  private:
    T* carried(std::size_t l) const { return carried_ + static_cast<std::int64_t>(l) * rows_; }
    T* gates(std::size_t l, std::int64_t t) const {
        return to_[l].gates + (t * shape_.samples + share_.first) * 4 * shape_.hidden;
    }

    /// All that reaches the last cell's state in frame t.
    void last_state(std::int64_t t, const T* grad_states) {
        const auto hidden = shape_.hidden;
        if (feedback_) {
            const bool fed = t + 1 < shape_.frames;
            const auto numbers = feedback_->numbers();
            if (fed)
                product<T>(EvenRows<T>{gates(0, t + 1) + hidden, 4 * hidden}, share_.count, packed_.feedback,
                           numbers, StoreExact<T>{fed_, numbers, numbers});
            feedback_->backward(t, share_.first, share_.count, fed ? fed_ : nullptr, grad_);
        } else {
            std::fill_n(grad_, rows_, T(0));
        }
        add_row(carried(cells_ - 1), rows_, grad_);
        if (grad_states) add_row(grad_states + (t * shape_.samples + share_.first) * hidden, rows_, grad_);
    }

    void cell(std::size_t l, std::int64_t t) {
        const auto hidden = shape_.hidden;
        const auto at = (t * shape_.samples + share_.first) * hidden;
        const T* before = t > 0 ? traces_[l].states + at - shape_.samples * hidden : zeros_;
        T* sums = sums_ + (static_cast<std::int64_t>(l) * shape_.frames + t) * 4 * hidden;
        for (std::int64_t i = 0; i < share_.count; ++i)
            step_back_row(hidden, grad_ + i * hidden, traces_[l].gates + 4 * (at + i * hidden),
                          before + i * hidden, gates(l, t) + i * 4 * hidden, carried(l) + i * hidden, sums,
                          l == 0 ? of_sample_ + i * 3 * hidden : nullptr);
    }

    GruShape shape_;
    Share share_;
    std::size_t cells_;
    GruFeedback<T>* feedback_;
    std::span<const GruTrace<T>> traces_;
    std::span<const GruGradient<T>> to_;
    const PackedStack<T>& packed_;
    T *sums_, *of_sample_;
    std::int64_t rows_;
    T *grad_, *carried_, *fed_, *zeros_, *no_bias_;
};

}  // namespace

template <typename T>
void gru_input_rows(const GruShape& shape, const GruInput<T>& input, std::int64_t frame, std::int64_t first,
                    std::int64_t count, T* to) {
    const auto width = 3 * shape.hidden;
    for (std::int64_t i = 0; i < count; ++i, to += width) {
        const auto sample = first + i;
        std::fill_n(to, width, T(0));
        if (input.products) add_row(input.products + (frame * shape.samples + sample) * width, width, to);
        if (input.of_sample) add_row(input.of_sample + sample * width, width, to);
        if (input.of_frame) add_row(input.of_frame + frame * width, width, to);
    }
}

template <typename T>
GruStep<T>::GruStep(std::int64_t hidden, const GruCell<T>& cell, int threads)
    : hidden_(hidden), bias_(cell.hidden_bias) {
    pack_forward(weight_, cell.hidden_weight, 3 * hidden, hidden, threads);
}

template <typename T>
void GruStep<T>::run(std::int64_t count, const T* in, const T* before, T* state, T* gates) const {
    step_rows(hidden_, weight_, bias_, count, in, before, state, gates);
}

template <typename T>
void gru_forward(const GruShape& shape, const GruInput<T>& input, std::span<const GruCell<T>> cells,
                 GruFeedback<T>* feedback, std::span<const GruTrace<T>> traces, int threads) {
    const auto& packed = packed_forward(cells, feedback, shape.hidden, threads);
#pragma omp parallel num_threads(threads)
    {
        ForwardPass<T> pass(shape, cells, feedback, traces, packed);
        for (std::int64_t t = 0; t < shape.frames; ++t) pass.frame(t, input);
    }
}

template <typename T>
void gru_backward(const GruShape& shape, std::span<const GruCell<T>> cells, GruFeedback<T>* feedback,
                  std::span<const GruTrace<T>> traces, const T* grad_states,
                  std::span<const GruGradient<T>> to, T* of_sample, int threads) {
    const auto& packed = packed_backward(cells, feedback, shape.hidden, threads);
    const auto frame_sums = shape.frames * 4 * shape.hidden;
    std::vector<T*> sums(static_cast<std::size_t>(threads));
#pragma omp parallel num_threads(threads)
    {
        T* own = sums[static_cast<std::size_t>(omp_get_thread_num())] =
            zeroed_scratch<T>(FrameSums{}, frame_sums * static_cast<std::int64_t>(cells.size()));
        BackwardPass<T> pass(shape, cells.size(), feedback, traces, to, of_sample, packed, own);
        for (std::int64_t t = shape.frames; t-- > 0;) pass.frame(t, grad_states);
#pragma omp barrier
#pragma omp for schedule(static)
        for (std::size_t l = 0; l < cells.size(); ++l) {
            std::fill_n(to[l].of_frame, frame_sums, T(0));
            for (const T* of_thread : sums)
                if (of_thread)  // fewer threads may have come than were asked for
                    add_row(of_thread + static_cast<std::int64_t>(l) * frame_sums, frame_sums,
                            to[l].of_frame);
        }
    }
}

#define ACTFORMER_GRU(T)                                                                                   \
    template void gru_input_rows<T>(const GruShape&, const GruInput<T>&, std::int64_t, std::int64_t,       \
                                    std::int64_t, T*);                                                     \
    template void gru_forward<T>(const GruShape&, const GruInput<T>&, std::span<const GruCell<T>>,         \
                                 GruFeedback<T>*, std::span<const GruTrace<T>>, int);                      \
    template void gru_backward<T>(const GruShape&, std::span<const GruCell<T>>, GruFeedback<T>*,           \
                                  std::span<const GruTrace<T>>, const T*, std::span<const GruGradient<T>>, \
                                  T*, int);
template class GruStep<float>;
template class GruStep<double>;
ACTFORMER_GRU(float)
ACTFORMER_GRU(double)

}  // namespace actformer::model::cpu
