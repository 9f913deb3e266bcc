// Graph convolutions, their weights shared by the nodes or every node's own.
#include "model/cpu/kernel_support.hpp"
#include "model/cpu/leaky.hpp"
#include "model/cpu/node_kernels.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct MaskedGrad {};
struct GroupGrad {};
struct OuterPanel {};
struct WindowGrad {};
struct SumsWeight {};
struct SumsBias {};

/// About what a core's second-level cache holds beside the weights under way.
constexpr std::int64_t cache_bytes = 1 << 20;

/// Samples that are taken through all nodes at once: few where frames weigh more than weights, so that they stay in the
/// cache; many where the weights would be read over and over.
std::int64_t chunk_of(const NodeShape& shape, const NodeSums& sums, int threads, std::size_t number) {
    const auto bytes = static_cast<std::int64_t>(number);
    const auto weights = static_cast<std::int64_t>(sums.groups.size()) * shape.out * shape.window() * bytes;
    const auto sample = (shape.sample_in() + shape.sample_out()) * bytes;
    const auto chunk = std::max<std::int64_t>(1, std::max(cache_bytes, weights) / sample);
    const auto share = (shape.samples + threads - 1) / threads;
    const auto rounds = (share + chunk - 1) / chunk;  // chunks a thread takes, as even as can be
    return (share + rounds - 1) / rounds;
}

/// Rows under the taps: every frame of every sample of a chunk, for one node.
template <typename T>
void list_rows(const NodeShape& shape, const T* x, std::int64_t samples, std::int64_t node,
               std::vector<const T*>& rows) {
    rows.clear();
    for (std::int64_t n = 0; n < samples; ++n)
        for (std::int64_t t = 0; t < shape.out_frames(); ++t)
            rows.push_back(x + n * shape.sample_in() +
                           (node * shape.padded_frames() + t * shape.stride) * shape.in);
}

/// Adds sums to the same frames of several output nodes.
template <typename T>
struct AddToTargets {
    const std::vector<NodeSums::Target>& targets;
    T* const* rows;             ///< of output node 0
    std::int64_t node, column;  ///< numbers from one output node to the next; the panel's first
    std::int64_t out;

    template <int R, int W>
    void operator()(std::ptrdiff_t row, std::ptrdiff_t within, const Lanes<T> (&sums)[R][W]) const {
        const auto at = column + within;
        for (const auto& target : targets) {
            const auto shift = target.output * node + at;
            const auto strength = static_cast<T>(target.strength);
            if (out - at >= W * lanes<T>)
                add_whole(rows + row, shift, strength, sums);
            else
                add_exact(rows + row, shift, out - at, strength, sums);
        }
    }

  private:
    template <int R, int W>
    static void add_whole(T* const* to, std::ptrdiff_t shift, T strength, const Lanes<T> (&sums)[R][W]) {
#pragma GCC unroll 16
        for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
            for (int w = 0; w < W; ++w) {
                T* at = to[r] + shift + w * lanes<T>;
                store(at, load(at) + strength * sums[r][w]);
            }
    }

    template <int R, int W>
    static void add_exact(T* const* to, std::ptrdiff_t shift, std::ptrdiff_t columns, T strength,
                          const Lanes<T> (&sums)[R][W]) {
        for (int r = 0; r < R; ++r)
            for (int w = 0; w < W; ++w) {
                T* at = to[r] + shift + w * lanes<T>;
                const auto here = std::min<std::ptrdiff_t>(columns - w * lanes<T>, lanes<T>);
                if (here > 0) store_part(at, load_part(at, here) + strength * sums[r][w], here);
            }
    }
};

/// The frames start from the bias, the padding from zeros.
template <typename T>
void begin_outputs(const NodeShape& shape, const T* bias, T* y) {
    const auto frame = shape.out, padding = shape.out_padding * frame, frames = shape.out_frames();
    for (std::int64_t w = 0; w < shape.out_nodes; ++w) {
        std::fill_n(y, padding, T(0));
        y += padding;
        if (bias)
            for (std::int64_t t = 0; t < frames; ++t) {
                const T* from = bias + w * frame;
                T* to = y + t * frame;
#pragma omp simd
                for (std::int64_t c = 0; c < frame; ++c) to[c] = from[c];
            }
        else
            std::fill_n(y, frames * frame, T(0));
        y += frames * frame;
        std::fill_n(y, padding, T(0));
        y += padding;
    }
}

template <typename T>
void apply_leaky(T* y, std::int64_t count, T leak) {
    if (leak == T(1)) return;
#pragma omp simd
    for (std::int64_t i = 0; i < count; ++i) y[i] = leaky(y[i], y[i], leak);
}

/// Packs every group's weights; `backward` as rows of outputs, else of inputs.
template <typename T>
std::vector<PackedMatrix<T>>& pack_groups(const NodeShape& shape, const NodeSums& sums, const T* weight,
                                          int threads) {
    thread_local std::vector<PackedMatrix<T>> packed;
    auto& all = packed;
    if (all.size() < sums.groups.size()) all.resize(sums.groups.size());
    for (std::size_t g = 0; g < sums.groups.size(); ++g) all[g].resize(shape.window(), shape.out);
    const auto panels = all[0].panels(), tasks = static_cast<std::int64_t>(sums.groups.size()) * panels;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t i = 0; i < tasks; ++i) {
        const auto& group = sums.groups[static_cast<std::size_t>(i / panels)];
        all[static_cast<std::size_t>(i / panels)].fill_transposed(
            i % panels, weight + group.input * shape.node_step + group.hop * shape.hop_step, shape.row_step,
            shape.out);
    }
    return all;
}

/// A node's groups one under the other, (groups * out, window), for the backward pass to x.
template <typename T>
std::vector<PackedMatrix<T>>& pack_nodes(const NodeShape& shape, const NodeSums& sums, const T* weight,
                                         int threads) {
    thread_local std::vector<PackedMatrix<T>> packed;
    auto& all = packed;
    const auto nodes = static_cast<std::size_t>(shape.in_nodes);
    if (all.size() < nodes) all.resize(nodes);
    for (std::size_t v = 0; v < nodes; ++v)
        all[v].resize((sums.first_of_node[v + 1] - sums.first_of_node[v]) * shape.out, shape.window());
    const auto panels = (shape.window() + panel_columns<T> - 1) / panel_columns<T>;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t i = 0; i < shape.in_nodes * panels; ++i) {
        const auto v = static_cast<std::size_t>(i / panels);
        const auto p = i % panels, first = p * panel_columns<T>,
                   here = std::min(panel_columns<T>, shape.window() - first);
        T* to = all[v].panel(p);
        for (auto g = sums.first_of_node[v]; g < sums.first_of_node[v + 1]; ++g) {
            const auto& group = sums.groups[static_cast<std::size_t>(g)];
            const T* from = weight + group.input * shape.node_step + group.hop * shape.hop_step + first;
            for (std::int64_t o = 0; o < shape.out; ++o, to += panel_columns<T>) {
                std::copy_n(from + o * shape.row_step, here, to);
                std::fill(to + here, to + panel_columns<T>, T(0));
            }
        }
    }
    return all;
}

/// One thread's backward pass, chunk by chunk.
template <typename T>
class Backward {
  public:
    Backward(const NodeShape& shape, const NodeSums& sums, std::vector<PackedMatrix<T>>* packed, T leak,
             T* weight_sums, T* bias_sums)
        : shape_(shape),
          sums_(sums),
          packed_(packed),
          leak_(leak),
          weight_sums_(weight_sums),
          bias_sums_(bias_sums) {}

    /// `to_x` may be null.
    void chunk(const T* x, const T* y, const T* grad, std::int64_t samples, T* to_x) {
        T* masked = scratch<T>(MaskedGrad{}, samples * shape_.sample_out());
        mask(y, grad, samples, masked);
        if (to_x) std::fill_n(to_x, samples * shape_.sample_in(), T(0));
        for (std::int64_t v = 0; v < shape_.in_nodes; ++v) {
            const auto first = sums_.first_of_node[static_cast<std::size_t>(v)],
                       end = sums_.first_of_node[static_cast<std::size_t>(v) + 1];
            if (first == end) continue;
            list_rows(shape_, x, samples, v, rows_);
            const auto pitch = (end - first) * shape_.out;
            T* to_groups = scratch<T>(GroupGrad{}, static_cast<std::int64_t>(rows_.size()) * pitch);
            for (auto g = first; g < end; ++g)
                gather(sums_.groups[static_cast<std::size_t>(g)], masked, samples, pitch,
                       to_groups + (g - first) * shape_.out);
            if (weight_sums_) add_weights(first, to_groups, pitch);
            if (to_x) add_inputs(v, to_groups, pitch, samples, to_x);
        }
    }

  private:
    void mask(const T* y, const T* grad, std::int64_t samples, T* to) {
        for (std::int64_t i = 0; i < samples * shape_.sample_out(); i += shape_.out) {
            const T *out = y + i, *g = grad + i;
            T* masked = to + i;
            const T leak = leak_;
#pragma omp simd
            for (std::int64_t c = 0; c < shape_.out; ++c) masked[c] = leaky(out[c], g[c], leak);
        }
        if (!bias_sums_) return;
        for (std::int64_t n = 0; n < samples; ++n)
            for (std::int64_t w = 0; w < shape_.out_nodes; ++w)
                for (std::int64_t t = 0; t < shape_.out_frames(); ++t)
                    add_row(frame(to, n, w, t), shape_.out, bias_sums_ + w * shape_.out);
    }

    template <typename Number>
    Number* frame(Number* y, std::int64_t n, std::int64_t w, std::int64_t t) const {
        return y + n * shape_.sample_out() +
               (w * shape_.padded_out_frames() + shape_.out_padding + t) * shape_.out;
    }

    /// What of the outputs' gradient reaches a group.
    void gather(const NodeSums::Group& group, const T* masked, std::int64_t samples, std::int64_t pitch,
                T* to) const {
        for (std::int64_t n = 0; n < samples; ++n)
            for (std::int64_t t = 0; t < shape_.out_frames(); ++t, to += pitch) {
                bool first = true;
                for (const auto& target : group.targets) {
                    const T* from = frame(masked, n, target.output, t);
                    const T by = static_cast<T>(target.strength);
                    if (first)
#pragma omp simd
                        for (std::int64_t c = 0; c < shape_.out; ++c) to[c] = by * from[c];
                    else
#pragma omp simd
                        for (std::int64_t c = 0; c < shape_.out; ++c) to[c] += by * from[c];
                    first = false;
                }
            }
    }

    /// All groups of a node at once: they see the same windows.
    void add_weights(std::int64_t first_group, const T* to_groups, std::int64_t pitch) {
        const auto columns = panel_padded<T>(shape_.window()), rows = static_cast<std::int64_t>(rows_.size());
        T* panel = scratch<T>(OuterPanel{}, rows * panel_columns<T>);
        add_outer_products<T>(
            to_groups, pitch, pitch, [this](std::int64_t r) { return rows_[static_cast<std::size_t>(r)]; },
            shape_.window(), rows, panel, weight_sums_ + first_group * shape_.out * columns, columns);
    }

    /// Windows overlap: they are added frame after frame.
    void add_inputs(std::int64_t node, const T* to_groups, std::int64_t pitch, std::int64_t samples,
                    T* to_x) {
        const auto window = shape_.window(), wide = panel_padded<T>(window),
                   rows = static_cast<std::int64_t>(rows_.size());
        T* windows = scratch<T>(WindowGrad{}, rows * wide);
        product<T>(EvenRows<T>{to_groups, pitch}, rows, (*packed_)[static_cast<std::size_t>(node)], window,
                   StorePlain<T>{windows, wide});
        for (std::int64_t n = 0; n < samples; ++n)
            for (std::int64_t t = 0; t < shape_.out_frames(); ++t, windows += wide)
                add_row(windows, window,
                        to_x + n * shape_.sample_in() +
                            (node * shape_.padded_frames() + t * shape_.stride) * shape_.in);
    }

    const NodeShape& shape_;
    const NodeSums& sums_;
    std::vector<PackedMatrix<T>>* packed_;
    T leak_;
    T *weight_sums_, *bias_sums_;
    std::vector<const T*> rows_;
};

/// The threads' weight sums (groups, out, padded window) added up into the weight's own layout, zeros so far. Groups of several
/// nodes may share their weights.
template <typename T>
void write_weights(const NodeShape& shape, const NodeSums& sums, const std::vector<T*>& own, T* to) {
    const auto wide = panel_padded<T>(shape.window());
#pragma omp for schedule(static)
    for (std::int64_t o = 0; o < shape.out; ++o)
        for (std::size_t g = 0; g < sums.groups.size(); ++g) {
            const auto& group = sums.groups[g];
            T* row = to + group.input * shape.node_step + group.hop * shape.hop_step + o * shape.row_step;
            const auto at = (static_cast<std::int64_t>(g) * shape.out + o) * wide;
            for (const T* sum : own)
                if (sum)
                    add_row(sum + at, shape.window(), row);  // fewer threads may have come than asked for
        }
}

}  // namespace

NodeSums::NodeSums(std::int64_t hops, std::int64_t outputs, std::int64_t inputs,
                   std::span<const float> strengths) {
    for (std::int64_t input = 0; input < inputs; ++input) {
        first_of_node.push_back(static_cast<std::int64_t>(groups.size()));
        for (std::int64_t hop = 0; hop < hops; ++hop) {
            Group group{hop, input, {}};
            for (std::int64_t output = 0; output < outputs; ++output)
                if (const float strength =
                        strengths[static_cast<std::size_t>((hop * outputs + output) * inputs + input)];
                    strength != 0)
                    group.targets.push_back({output, strength});
            if (!group.targets.empty()) groups.push_back(std::move(group));
        }
    }
    first_of_node.push_back(static_cast<std::int64_t>(groups.size()));
}

template <typename T>
void node_forward(const NodeShape& shape, const NodeSums& sums, const T* x, const T* weight, const T* bias,
                  T leak, T* y, int threads) {
    const auto& packed = pack_groups(shape, sums, weight, threads);
    const auto chunk = chunk_of(shape, sums, threads, sizeof(T));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t from = 0; from < shape.samples; from += chunk) {
        const auto samples = std::min(chunk, shape.samples - from);
        T* out = y + from * shape.sample_out();
        thread_local std::vector<const T*> rows;
        thread_local std::vector<T*> out_rows;
        out_rows.clear();
        for (std::int64_t n = 0; n < samples; ++n) {
            begin_outputs(shape, bias, out + n * shape.sample_out());
            for (std::int64_t t = 0; t < shape.out_frames(); ++t)
                out_rows.push_back(out + n * shape.sample_out() + (shape.out_padding + t) * shape.out);
        }
        for (std::int64_t v = 0; v < shape.in_nodes; ++v) {
            list_rows(shape, x + from * shape.sample_in(), samples, v, rows);
            for (auto g = sums.first_of_node[static_cast<std::size_t>(v)];
                 g < sums.first_of_node[static_cast<std::size_t>(v) + 1]; ++g) {
                const auto& matrix = packed[static_cast<std::size_t>(g)];
                for (std::int64_t p = 0; p < matrix.panels(); ++p) {
                    const auto first = p * panel_columns<T>;
                    panel_product<T>(
                        ListedRows<T>{rows.data()}, static_cast<std::int64_t>(rows.size()), matrix.panel(p),
                        matrix.depth(), shape.out - first > lanes<T> ? panel_vectors : 1,
                        AddToTargets<T>{sums.groups[static_cast<std::size_t>(g)].targets, out_rows.data(),
                                        shape.padded_out_frames() * shape.out, first, shape.out});
                }
            }
        }
        apply_leaky(out, samples * shape.sample_out(), leak);
    }
}

template <typename T>
void node_backward(const NodeShape& shape, const NodeSums& sums, const T* x, const T* weight, T leak,
                   const T* y, const T* grad, std::int64_t weights, const NodeGradients<T>& to, int threads) {
    auto* packed = to.x ? &pack_nodes(shape, sums, weight, threads) : nullptr;
    const auto chunk = chunk_of(shape, sums, threads, sizeof(T));
    const auto groups = static_cast<std::int64_t>(sums.groups.size());
    std::vector<T*> weight_sums(static_cast<std::size_t>(threads)), bias_sums(weight_sums.size());
#pragma omp parallel num_threads(threads)
    {
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        if (to.weight)
            weight_sums[thread] =
                zeroed_scratch<T>(SumsWeight{}, groups * shape.out * panel_padded<T>(shape.window()));
        if (to.bias) bias_sums[thread] = zeroed_scratch<T>(SumsBias{}, shape.out_nodes * shape.out);
        Backward<T> backward(shape, sums, packed, leak, weight_sums[thread], bias_sums[thread]);
#pragma omp for schedule(static)
        for (std::int64_t from = 0; from < shape.samples; from += chunk)
            backward.chunk(x + from * shape.sample_in(), y + from * shape.sample_out(),
                           grad + from * shape.sample_out(), std::min(chunk, shape.samples - from),
                           to.x ? to.x + from * shape.sample_in() : nullptr);
        if (to.weight) {
#pragma omp for schedule(static)
            for (std::int64_t i = 0; i < weights; ++i) to.weight[i] = 0;
            write_weights(shape, sums, weight_sums, to.weight);
        }
    }
    if (!to.bias) return;
    std::fill_n(to.bias, shape.out_nodes * shape.out, T(0));
    for (const T* own : bias_sums)
        if (own) add_row(own, shape.out_nodes * shape.out, to.bias);
}

template <typename T>
void motion_input(const MotionInputShape& shape, const T* motion, T* to, int threads) {
    const auto channels = shape.channels, frames = shape.frames, nodes = shape.nodes,
               step = (frames + 2 * shape.padding) * 2 * channels;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.samples; ++n) {
        T* sample = to + n * nodes * step;
        std::fill_n(sample, nodes * step, T(0));
        for (std::int64_t c = 0; c < channels; ++c)
            for (std::int64_t t = 0; t < frames; ++t) {
                const T* now = motion + ((n * channels + c) * frames + t) * nodes;
                const T* before = t > 0 ? now - nodes : now;
                T* at = sample + (shape.padding + t) * 2 * channels + c;
                for (std::int64_t k = 0; k < nodes; ++k, at += step) {
                    at[0] = now[k];
                    at[channels] = now[k] - before[k];
                }
            }
    }
}

template <typename T>
void motion_input_backward(const MotionInputShape& shape, const T* grad, T* to, int threads) {
    const auto channels = shape.channels, frames = shape.frames, nodes = shape.nodes, frame = 2 * channels,
               step = (frames + 2 * shape.padding) * frame;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.samples; ++n)
        for (std::int64_t c = 0; c < channels; ++c)
            for (std::int64_t t = 0; t < frames; ++t) {
                const T* at = grad + n * nodes * step + (shape.padding + t) * frame + c;
                T* out = to + ((n * channels + c) * frames + t) * nodes;
                for (std::int64_t k = 0; k < nodes; ++k, at += step) {
                    const T arrived = t > 0 ? at[channels] : T(0);
                    const T left = t + 1 < frames ? at[frame + channels] : T(0);
                    out[k] = at[0] + arrived - left;
                }
            }
}

#define ACTFORMER_NODES(T)                                                                                \
    template void node_forward<T>(const NodeShape&, const NodeSums&, const T*, const T*, const T*, T, T*, \
                                  int);                                                                   \
    template void node_backward<T>(const NodeShape&, const NodeSums&, const T*, const T*, T, const T*,    \
                                   const T*, std::int64_t, const NodeGradients<T>&, int);                 \
    template void motion_input<T>(const MotionInputShape&, const T*, T*, int);                            \
    template void motion_input_backward<T>(const MotionInputShape&, const T*, T*, int);
ACTFORMER_NODES(float)
ACTFORMER_NODES(double)

}  // namespace actformer::model::cpu
