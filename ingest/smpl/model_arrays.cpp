#include "ingest/smpl/model_arrays.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/numpy/npz.hpp"
#include "base/pickle/pickle.hpp"

namespace actformer::ingest {
namespace {

/// Three times what the 300 shape directions of SMPL's largest file take in double.
constexpr std::uint64_t largest_array = std::uint64_t{150} << 20;

ModelArray in_c_order(const NumpyArray& array) {
    if (!array.numbers()) throw Error("an array of {}, not of numbers", array.type);
    const auto count = array.elements();
    if (count > largest_array / sizeof(double))
        throw Error("{} numbers, more than a body model has", array.shape_text());
    ModelArray out{array.shape, {}};
    if (!array.fortran_order || array.shape.size() < 2) {
        out.values = array.all_numbers();
        return out;
    }
    out.values.resize(count);
    const auto last = array.shape.back(), rows = last == 0 ? 0 : count / last;
    std::vector<std::uint64_t> index(array.shape.size() - 1, 0);
    for (std::uint64_t row = 0; row < rows; ++row) {
        std::uint64_t first = 0;  // of the row, in memory
        for (std::size_t d = index.size(); d-- > 0;) first = first * array.shape[d] + index[d];
        array.copy(first, rows, last, &out.values[row * last]);
        for (std::size_t d = index.size(); d-- > 0 && ++index[d] == array.shape[d];) index[d] = 0;
    }
    return out;
}

/// An array of whole numbers below `limit`.
std::vector<std::uint64_t> indices(const PickleValue& value, std::uint64_t limit) {
    std::vector<std::uint64_t> out;
    for (const double v : in_c_order(value.array()).values) {
        if (!(v >= 0 && v < static_cast<double>(limit)))
            throw Error("an index of {} into {} numbers: damaged", v, limit);
        out.push_back(static_cast<std::uint64_t>(v));
    }
    return out;
}

std::vector<std::uint64_t> lengths(const PickleValue& sequence) {
    std::vector<std::uint64_t> out;
    std::uint64_t all = 1;
    for (std::size_t i = 0; i < sequence.size(); ++i) {
        out.push_back(static_cast<std::uint64_t>(std::max<std::int64_t>(0, sequence[i].whole())));
        if (__builtin_mul_overflow(all, out.back(), &all) || all > largest_array / sizeof(double))
            throw Error("more numbers than a body model has");
    }
    return out;
}

/// Compressed sparse columns: column j holds data[i] in row indices[i] for i from indptr[j] to indptr[j + 1].
ModelArray dense(const PickleValue& csc) {
    const auto shape = csc.find("_shape");
    ModelArray out{lengths(shape ? *shape : csc.get("shape")), {}};
    if (out.shape.size() != 2) throw Error("a sparse matrix of {} axes: damaged", out.shape.size());
    const auto data = in_c_order(csc.get("data").array()).values;
    const auto rows = indices(csc.get("indices"), out.shape[0]),
               starts = indices(csc.get("indptr"), data.size() + 1);
    if (rows.size() != data.size() || starts.size() != out.shape[1] + 1 || !std::ranges::is_sorted(starts))
        throw Error("a sparse matrix whose parts do not fit: damaged");
    out.values.assign(out.shape[0] * out.shape[1], 0);
    for (std::size_t j = 0; j < out.shape[1]; ++j)
        for (auto i = starts[j]; i < starts[j + 1]; ++i) out.values[rows[i] * out.shape[1] + j] += data[i];
    return out;
}

ModelArray of_pickle(const PickleValue& value) {
    if (value.is_object("chumpy.ch Ch")) return in_c_order(value.get("x").array());
    if (value.is_object("chumpy.reordering Select")) {
        const auto of = value.get("a");
        const auto from = in_c_order((of.is_array() ? of : of.get("x")).array()).values;
        ModelArray out{lengths(value.get("preferred_shape")), {}};
        for (const auto i : indices(value.get("idxs"), from.size())) out.values.push_back(from[i]);
        std::uint64_t meant = 1;
        for (const auto n : out.shape) meant *= n;
        if (meant != out.values.size())
            throw Error("{} numbers selected for {}: damaged", out.values.size(), out.shape_text());
        return out;
    }
    for (const auto* name : {"scipy.sparse.csc csc_matrix", "scipy.sparse._csc csc_matrix"})
        if (value.is_object(name)) return dense(value);
    return in_c_order(value.array());
}

}  // namespace

std::string ModelArray::shape_text() const {
    NumpyArray as;
    as.shape = shape;
    return as.shape_text();
}

ModelArrays read_model_npz(std::string_view bytes, const std::vector<std::string>& wanted) {
    ModelArrays out;
    const auto is_wanted = [&](const std::string& name) {
        return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    };
    read_npz(bytes, {.largest = largest_array, .wanted = is_wanted},
             [&](const std::string& name, const NumpyArray& array) { out[name] = in_c_order(array); });
    return out;
}

ModelArrays read_model_pickle(std::string_view bytes, const std::vector<std::string>& wanted) {
    const Pickle pickle(bytes, {.unpacked = 4 * largest_array});
    ModelArrays out;
    for (const auto& name : wanted) try {
            if (const auto value = pickle.root().find(name)) out[name] = of_pickle(*value);
        } catch (const Error& e) {
            throw Error("'{}': {}", name, e.what());
        }
    return out;
}

}  // namespace actformer::ingest
