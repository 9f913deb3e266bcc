// A fixed tensor of a computation. Includes torch headers.
#pragma once

#include <ATen/core/Tensor.h>

#include <utility>

namespace actformer::model {

/// Stays where it was last used: copied from the host anew, it would keep every step waiting for the GPU. For one thread.
class Constant {
  public:
    Constant() = default;
    explicit Constant(at::Tensor values) : values_(std::move(values)) {}

    /// On the device of `x`; floating-point numbers in its type.
    at::Tensor beside(const at::Tensor& x) const {
        if (values_.device() != x.device()) values_ = values_.to(x.device());
        return values_.is_floating_point() ? values_.to(x.scalar_type()) : values_;
    }

  private:
    mutable at::Tensor values_;
};

}  // namespace actformer::model
