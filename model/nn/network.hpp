// A network described without tensors: its weights in order and how they start, its layers and parameter counts. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::model {

/// How a weight is initialised.
enum class Init {
    uniform,     ///< in [-scale, scale]
    normal,      ///< of deviation `scale`
    orthogonal,  ///< rows or columns
    zeros,
    ones,
    tiling,  ///< (frames, persons, width): a normal table over frames beside one over persons, deviation `scale`
    sinusoids,        ///< the same of sines and cosines
    frame_sinusoids,  ///< its table over frames alone, (frames, width)
    person_sinusoids  ///< its table over persons alone, (persons, width)
};

struct NetworkWeight {
    std::string name;  ///< the layer's, a dot, "weight" or "bias"; or the name of a table
    std::vector<std::int64_t> shape;
    Init init = Init::uniform;
    double scale = 0;       ///< as its Init has it
    bool spectral = false;  ///< divided by its largest singular value as a matrix of `rows` rows
    std::int64_t rows = 0;
    bool trained = true;
    std::string same_as = {};  ///< a weight before it, of the same shape, of which it begins as a copy

    std::int64_t count() const {
        return std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>());
    }
};

/// Numbers that training moves, of weights whose names begin with `prefix`.
inline std::int64_t trained_count(const std::vector<NetworkWeight>& weights, std::string_view prefix = "") {
    std::int64_t sum = 0;
    for (const auto& weight : weights)
        if (weight.trained && weight.name.starts_with(prefix)) sum += weight.count();
    return sum;
}

/// A line of the summary that `actformer model` prints.
struct SummaryLine {
    std::string layer, kind;
    std::vector<std::int64_t> shape;  ///< of one sample's output
    std::int64_t parameters = 0;      ///< trained numbers
};

struct NetworkSummary {
    std::string name;  ///< as in "generator"
    std::vector<SummaryLine> lines;
};

}  // namespace actformer::model
