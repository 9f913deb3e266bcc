// A tensor's numbers for kernels of our own. Includes torch headers.
#pragma once

#include <ATen/core/Tensor.h>

namespace actformer::model {

/// Calls `run` with a number of the tensor's type.
template <typename Run>
void by_type(const at::Tensor& x, const Run& run) {
    if (x.scalar_type() == at::kDouble)
        run(double{});
    else
        run(float{});
}

/// The tensor's numbers; null where it is undefined.
template <typename T>
T* in(const at::Tensor& x) {
    return x.defined() ? x.data_ptr<T>() : nullptr;
}

}  // namespace actformer::model
