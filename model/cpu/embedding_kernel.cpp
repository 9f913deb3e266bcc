// Latents to tokens.
#include "model/cpu/layer_support.hpp"
#include "model/cpu/motion_kernels.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct FrameGrad {};
struct LatentLayer {};

/// A latent's row of tokens, for the persons that share it.
template <typename T>
struct StoreTokens {
    const EmbeddingShape& shape;
    const T *bias, *positions;
    T* tokens;  ///< of the sample
    std::int64_t first, end;

    template <int R, int W>
    void operator()(std::ptrdiff_t row, std::ptrdiff_t first_column, const Lanes<T> (&sums)[R][W]) const {
        for_each_sum<T>(
            row, first_column, sums, [this](std::ptrdiff_t frame, std::ptrdiff_t column, Lanes<T> sum) {
                const auto here = std::min<std::ptrdiff_t>(lanes<T>, shape.width - column);
                sum += load(bias + column);
                for (std::int64_t p = first; p < end; ++p) {
                    const auto place =
                        load_part(positions + ((frame + 1) * shape.persons + p) * shape.width + column, here);
                    store_part(tokens + (p * shape.tokens() + frame + 1) * shape.width + column, sum + place,
                               here);
                }
            });
    }
};

}  // namespace

template <typename T>
void embed_forward(const EmbeddingShape& shape, const T* latent, const LinearWeight<T>& weight,
                   const T* classes, const T* positions, T* tokens, int threads) {
    const auto width = shape.width, sharing = shape.persons / shape.streams;
    const auto map = packed_forward(LatentLayer{}, weight, width, shape.channels, threads);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.samples; ++n) {
        T* to = tokens + n * shape.persons * shape.tokens() * width;
        for (std::int64_t s = 0; s < shape.streams; ++s)
            product<T>(
                EvenRows<T>{latent + (n * shape.streams + s) * shape.frames * shape.channels, shape.channels},
                shape.frames, map.weight, width,
                StoreTokens<T>{shape, map.bias, positions, to, s * sharing, (s + 1) * sharing});
        for (std::int64_t p = 0; p < shape.persons; ++p)
            for (std::int64_t c = 0; c < width; ++c)
                to[p * shape.tokens() * width + c] = classes[n * width + c] + positions[p * width + c];
    }
}

template <typename T>
void embed_backward(const EmbeddingShape& shape, const T* latent, const T* grad,
                    const EmbeddingGradients<T>& to, int threads) {
    const auto width = shape.width, tokens = shape.tokens(), persons = shape.persons,
               sharing = persons / shape.streams;
    LinearSums<T> sums(threads, width, shape.channels);
#pragma omp parallel num_threads(threads)
    {
        const auto own = sums.own(LatentLayer{});
        T* frames = scratch<T>(FrameGrad{}, shape.frames * width);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.samples; ++n) {
            const T* sample = grad + n * persons * tokens * width;
            std::fill_n(to.classes + n * width, width, T(0));
            for (std::int64_t p = 0; p < persons; ++p)
                add_row(sample + p * tokens * width, width, to.classes + n * width);
            for (std::int64_t s = 0; s < shape.streams; ++s) {
                std::fill_n(frames, shape.frames * width, T(0));
                for (std::int64_t p = s * sharing; p < (s + 1) * sharing; ++p)
                    add_row(sample + (p * tokens + 1) * width, shape.frames * width, frames);
                const T* seen = latent + (n * shape.streams + s) * shape.frames * shape.channels;
                own.add({frames, width}, {seen, shape.channels}, shape.frames);
            }
        }
        sums.write(to.weight);
#pragma omp for schedule(static) collapse(2)
        for (std::int64_t t = 0; t < tokens; ++t)
            for (std::int64_t p = 0; p < persons; ++p) {
                T* place = to.positions + (t * persons + p) * width;
                std::fill_n(place, width, T(0));
                for (std::int64_t n = 0; n < shape.samples; ++n)
                    add_row(grad + ((n * persons + p) * tokens + t) * width, width, place);
            }
    }
}

#define ACTFORMER_EMBED(T)                                                                                   \
    template void embed_forward<T>(const EmbeddingShape&, const T*, const LinearWeight<T>&, const T*,        \
                                   const T*, T*, int);                                                       \
    template void embed_backward<T>(const EmbeddingShape&, const T*, const T*, const EmbeddingGradients<T>&, \
                                    int);
ACTFORMER_EMBED(float)
ACTFORMER_EMBED(double)

}  // namespace actformer::model::cpu
