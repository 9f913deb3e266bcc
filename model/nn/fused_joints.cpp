#include "model/nn/fused_joints.hpp"

#include <torch/csrc/autograd/custom_function.h>

#include "model/nn/function_support.hpp"

namespace actformer::model {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

/// The gradient comes with the value, for little more than the value alone.
struct JointError : Function<JointError> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& made, const at::Tensor& real,
                              const cpu::RestSkeleton* skeleton) {
        const cpu::RotationsShape shape{made.size(0), made.size(1) / cpu::rotation_numbers, made.size(2)};
        auto gradient = at::empty_like(made);
        double sum = 0;
        timed("joints", false, made, [&](auto number) {
            using T = decltype(number);
            sum = cpu::joint_differences<T>(*skeleton, shape, in<T>(made), in<T>(real), in<T>(gradient),
                                            threads());
        });
        const auto count = static_cast<double>(shape.samples * shape.persons * shape.frames * 3) *
                           static_cast<double>(skeleton->parents.size());
        context->save_for_backward({gradient.div_(count)});
        return at::full({}, sum / count, made.options());
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        return {context->get_saved_variables()[0] * grads[0], {}, {}};
    }
};

}  // namespace

at::Tensor fused_joint_error(const cpu::RestSkeleton& skeleton, const at::Tensor& made,
                             const at::Tensor& real) {
    TORCH_CHECK(made.sizes() == real.sizes() && made.dim() == 4 &&
                    made.size(1) % cpu::rotation_numbers == 0 &&
                    made.size(3) == static_cast<std::int64_t>(skeleton.parents.size()) + 1,
                "rotations of another skeleton: ", made.sizes(), " and ", real.sizes());
    return JointError::apply(made.contiguous(), real.contiguous(), &skeleton);
}

}  // namespace actformer::model
