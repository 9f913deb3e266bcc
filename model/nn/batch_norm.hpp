// What the batch normalisations share. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

namespace actformer::model {

/// 1 / sqrt(variance + 1e-5), worked out in double: PyTorch's rounding.
inline at::Tensor inverse_deviation(const at::Tensor& variance) {
    return (variance.to(at::kDouble) + 1e-5).rsqrt().to(variance.scalar_type());
}

}  // namespace actformer::model
