#include "base/numpy/rows.hpp"

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer {

NumpyRows::NumpyRows(const NumpyArray& array, std::string_view name, const std::vector<std::uint64_t>& inner)
    : array_(&array), columns_(inner.back()) {
    if (inner.size() > 1) outer_ = inner.front();
    const auto& shape = array.shape;
    if (!array.numbers() || shape.size() != inner.size() + 1 ||
        !std::equal(inner.begin(), inner.end(), shape.begin() + 1))
        throw Error("{} is an array of {} {}, where numbers (rows, {}) are meant", in_quotes(name),
                    array.type, array.shape_text(), fmt::join(inner, ", "));
    count_ = rows_ = shape[0];
}

void NumpyRows::read(std::uint64_t i, double* to) const {
    if (!array_->fortran_order) return array_->copy(i * size(), 1, size(), to);
    for (std::uint64_t j = 0; j < outer_; ++j, to += columns_)
        array_->copy(i + rows_ * j, rows_ * outer_, columns_, to);
}

}  // namespace actformer
