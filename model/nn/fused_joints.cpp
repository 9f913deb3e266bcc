#include "model/nn/fused_joints.hpp"

#include <torch/csrc/autograd/custom_function.h>

#include "model/nn/function_support.hpp"

namespace actformer::model {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

cpu::RotationsShape rotations_shape(const at::Tensor& motion) {
    return {motion.size(0), motion.size(1) / cpu::rotation_numbers, motion.size(2)};
}

void check_fits(const cpu::RestSkeleton& skeleton, const at::Tensor& motion) {
    TORCH_CHECK(motion.dim() == 4 && motion.size(1) % cpu::rotation_numbers == 0 &&
                    motion.size(3) == static_cast<std::int64_t>(skeleton.parents.size()) + 1,
                "rotations of another skeleton: ", motion.sizes());
}

/// What the backward pass needs beside tensors.
struct HeldSkeleton : torch::CustomClassHolder {
    std::shared_ptr<const cpu::RestSkeleton> skeleton;

    explicit HeldSkeleton(std::shared_ptr<const cpu::RestSkeleton> of) : skeleton(std::move(of)) {}
};

struct ForwardKinematics : Function<ForwardKinematics> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& rotations,
                              const c10::intrusive_ptr<HeldSkeleton>& held) {
        const auto shape = rotations_shape(rotations);
        auto positions = at::empty({shape.samples, shape.persons * 3, shape.frames, rotations.size(3) - 1},
                                   rotations.options());
        timed("joints", false, rotations, [&](auto number) {
            using T = decltype(number);
            cpu::forward_kinematics<T>(*held->skeleton, shape, in<T>(rotations), in<T>(positions), threads());
        });
        context->save_for_backward({rotations});
        context->saved_data["skeleton"] = c10::IValue::make_capsule(held);
        return positions;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto rotations = context->get_saved_variables()[0], from = grads[0].contiguous();
        const auto capsule = context->saved_data["skeleton"].toCapsule();
        const auto& skeleton = *static_cast<const HeldSkeleton&>(*capsule).skeleton;
        auto gradient = at::empty_like(rotations);
        timed("joints", true, rotations, [&](auto number) {
            using T = decltype(number);
            cpu::forward_kinematics_backward<T>(skeleton, rotations_shape(rotations), in<T>(rotations),
                                                in<T>(from), in<T>(gradient), threads());
        });
        return {gradient, {}};
    }
};

/// The gradient comes with the value, for little more than the value alone.
struct JointError : Function<JointError> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& made, const at::Tensor& real,
                              const cpu::RestSkeleton* skeleton) {
        const auto shape = rotations_shape(made);
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

at::Tensor fused_joint_positions(const std::shared_ptr<const cpu::RestSkeleton>& skeleton,
                                 const at::Tensor& rotations) {
    check_fits(*skeleton, rotations);
    return ForwardKinematics::apply(rotations.contiguous(), c10::make_intrusive<HeldSkeleton>(skeleton));
}

at::Tensor fused_joint_error(const cpu::RestSkeleton& skeleton, const at::Tensor& made,
                             const at::Tensor& real) {
    check_fits(skeleton, made);
    TORCH_CHECK(made.sizes() == real.sizes(), "motions of different sizes: ", made.sizes(), " and ",
                real.sizes());
    return JointError::apply(made.contiguous(), real.contiguous(), &skeleton);
}

}  // namespace actformer::model
