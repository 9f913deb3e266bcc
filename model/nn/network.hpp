// A network on paper: its weights in order and how they start, its layers and parameter counts. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

namespace actformer::model {

/// How a weight starts.
enum class Begin {
    uniform,     ///< within one over the root of the inputs to an output, `reach`
    normal,      ///< of deviation `reach`
    orthogonal,  ///< rows or columns
    zeros,
    ones,
    tiling,  ///< (frames, persons, width): a normal table over frames beside one over persons, deviation `reach`
    sinusoids  ///< the same of sines and cosines
};

struct NetworkWeight {
    std::string name;  ///< the layer's, a dot, "weight" or "bias"; or the name of a table
    std::vector<std::int64_t> shape;
    Begin begin = Begin::uniform;
    double reach = 0;
    bool spectral = false;  ///< divided by its largest singular value as a matrix of `rows` rows
    std::int64_t rows = 0;
    bool trained = true;

    std::int64_t count() const {
        return std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>());
    }
};

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
