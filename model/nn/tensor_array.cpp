#include "model/nn/tensor_array.hpp"

#include <ATen/ATen.h>
#include <ATen/core/grad_mode.h>

#include "base/error.hpp"
#include "model/nn/tensor_numbers.hpp"

namespace actformer::model {

Array array_of(std::string name, const at::Tensor& tensor) {
    Array array{std::move(name), tensor.sizes().vec(), {}};
    by_type(tensor, [&](auto number) {
        using T = decltype(number);
        const auto values = tensor.detach().to(at::kCPU, c10::CppTypeToScalarType<T>::value).contiguous();
        const auto* first = values.template data_ptr<T>();
        array.values = std::vector<T>(first, first + values.numel());
    });
    return array;
}

void copy_into(const at::Tensor& tensor, const Array& array, const std::string& where) {
    const at::NoGradGuard no_gradients;
    const auto copy = [&]<typename T>(std::vector<T> values) {  // from_blob takes no const
        if (static_cast<std::int64_t>(values.size()) != tensor.numel())
            throw Error("{}: '{}' holds {} numbers where {} belong", where, array.name, values.size(),
                        tensor.numel());
        tensor.copy_(at::from_blob(values.data(), tensor.sizes(), c10::CppTypeToScalarType<T>::value));
    };
    std::visit(copy, array.values);
}

}  // namespace actformer::model
