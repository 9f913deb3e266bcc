#include "model/nn/fused_gru.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <torch/csrc/autograd/custom_function.h>

#include <algorithm>

#include "model/cpu/gru_kernel.hpp"
#include "model/cpu/layer_clock.hpp"
#include "model/cpu/pose_feedback.hpp"
#include "model/cpu/pose_sampler.hpp"
#include "model/nn/tensor_numbers.hpp"

namespace actformer::model {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

/// Places of a stack's tensors as Function takes them: products, of_sample, of_frame, then four a cell. An empty tensor stands for one
/// that is not there.
constexpr std::size_t of_sample_at = 1, of_frame_at = 2, first_cell = 3, a_cell = 4;

variable_list tensors_of(const GruInputs& inputs, const std::vector<GruTensors>& cells) {
    const auto here = [&](const at::Tensor& x) {
        return x.defined() ? x.contiguous() : at::empty({0}, inputs.of_sample.options());
    };
    variable_list all{here(inputs.products), here(inputs.of_sample), here(inputs.of_frame)};
    for (const auto& cell : cells)
        for (const auto* x : {&cell.input.weight, &cell.input.bias, &cell.hidden.weight, &cell.hidden.bias})
            all.push_back(here(*x));
    return all;
}

template <typename T>
const T* if_there(const at::Tensor& x) {
    return x.defined() && x.numel() > 0 ? x.data_ptr<T>() : nullptr;
}

/// A stack's tensors and what its cells leave behind.
struct Stack {
    at::TensorList tensors;
    cpu::GruShape shape;
    std::size_t cells;
    variable_list states, gates;

    Stack(at::TensorList all, std::size_t cell_count) : tensors(all), cells(cell_count) {
        shape = {all[of_frame_at].size(0), all[of_sample_at].size(0), all[of_sample_at].size(1) / 3};
    }

    at::Tensor rows(std::int64_t width) const {
        return at::empty({shape.frames, shape.samples, width}, tensors[of_sample_at].options());
    }
    const at::Tensor& of_cell(std::size_t cell, std::size_t which) const {
        return tensors[first_cell + a_cell * cell + which];
    }

    void make_traces(bool kept) {
        for (std::size_t l = 0; l < cells; ++l) {
            states.push_back(rows(shape.hidden));
            if (kept) gates.push_back(rows(4 * shape.hidden));
        }
    }
    template <typename T>
    std::vector<cpu::GruTrace<T>> traces() const {
        std::vector<cpu::GruTrace<T>> all;
        for (std::size_t l = 0; l < cells; ++l)
            all.push_back({in<T>(states[l]), gates.empty() ? nullptr : in<T>(gates[l])});
        return all;
    }
    template <typename T>
    std::vector<cpu::GruCell<T>> weights() const {
        std::vector<cpu::GruCell<T>> all;
        for (std::size_t l = 0; l < cells; ++l)
            all.push_back({if_there<T>(of_cell(l, 0)), if_there<T>(of_cell(l, 1)), in<T>(of_cell(l, 2)),
                           in<T>(of_cell(l, 3))});
        return all;
    }
    template <typename T>
    cpu::GruInput<T> input() const {
        return {if_there<T>(tensors[0]), if_there<T>(tensors[of_sample_at]),
                if_there<T>(tensors[of_frame_at])};
    }

    template <typename T>
    void run(cpu::GruFeedback<T>* feedback) const {
        cpu::gru_forward<T>(shape, input<T>(), weights<T>(), feedback, traces<T>(), at::get_num_threads());
    }
};

at::Tensor flat(const at::Tensor& x) {
    return x.flatten(0, 1);
}

/// A stack's gradients: those that the kernel writes, and the weights' out of them, all frames in one product.
struct StackGradients {
    variable_list gates, of_frame;
    at::Tensor of_sample;

    explicit StackGradients(const Stack& stack) {
        const auto width = 4 * stack.shape.hidden;
        for (std::size_t l = 0; l < stack.cells; ++l) {
            gates.push_back(stack.rows(width));
            of_frame.push_back(at::empty({stack.shape.frames, width}, gates[l].options()));
        }
        of_sample = at::empty({stack.shape.samples, 3 * stack.shape.hidden}, gates[0].options());
    }

    template <typename T>
    void run(const Stack& stack, cpu::GruFeedback<T>* feedback, const T* grad_states) {
        std::vector<cpu::GruGradient<T>> to;
        for (std::size_t l = 0; l < stack.cells; ++l) to.push_back({in<T>(gates[l]), in<T>(of_frame[l])});
        cpu::gru_backward<T>(stack.shape, stack.weights<T>(), feedback, stack.traces<T>(), grad_states, to,
                             in<T>(of_sample), at::get_num_threads());
    }

    /// (T, N, 3*hidden), what the gates r, z, n are given.
    at::Tensor inputs(std::size_t cell) const {
        const auto hidden = gates[cell].size(2) / 4;
        return gates[cell].narrow(2, hidden, 3 * hidden);
    }

    /// As tensors_of orders them.
    variable_list all(const Stack& stack) const {
        const auto hidden = stack.shape.hidden, frames = stack.shape.frames;
        // Numbers lie n, r, z, as the kernel writes the hidden products' gradients; weights r, z, n.
        const auto in_order = [&](const at::Tensor& x) {
            return at::cat({x.narrow(0, hidden, 2 * hidden), x.narrow(0, 0, hidden)});
        };
        variable_list out{stack.tensors[0].numel() > 0 ? inputs(0) : at::Tensor(), of_sample,
                          of_frame[0].narrow(1, hidden, 3 * hidden)};
        for (std::size_t l = 0; l < stack.cells; ++l) {
            const auto sums = of_frame[l].sum(0);
            const auto to_hidden = gates[l].narrow(2, 0, 3 * hidden).narrow(0, 1, frames - 1);
            const auto before = stack.states[l].narrow(0, 0, frames - 1);
            const auto weight = flat(to_hidden).t().mm(flat(before));
            if (l == 0) {
                out.insert(out.end(), {at::Tensor(), at::Tensor()});
            } else {
                out.push_back(flat(inputs(l)).t().mm(flat(stack.states[l - 1])));
                out.push_back(sums.narrow(0, hidden, 3 * hidden));
            }
            out.push_back(in_order(weight));
            out.push_back(in_order(sums.narrow(0, 0, 3 * hidden)));
        }
        return out;
    }
};

struct Gru : Function<Gru> {
    static at::Tensor forward(AutogradContext* context, at::TensorList tensors) {
        Stack stack(tensors, (tensors.size() - first_cell) / a_cell);
        stack.make_traces(context != nullptr);
        const LayerTimer timer("GRU");
        by_type(tensors[of_sample_at], [&](auto number) { stack.run<decltype(number)>(nullptr); });
        auto saved = tensors.vec();
        saved.insert(saved.end(), stack.gates.begin(), stack.gates.end());
        saved.insert(saved.end(), stack.states.begin(), stack.states.end());
        context->save_for_backward(saved);
        context->saved_data["cells"] = static_cast<std::int64_t>(stack.cells);
        return stack.states.back();
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto cells = static_cast<std::size_t>(context->saved_data["cells"].toInt());
        Stack stack(at::TensorList(saved).slice(0, first_cell + a_cell * cells), cells);
        const auto trace = saved.end() - static_cast<std::ptrdiff_t>(2 * cells);
        stack.gates.assign(trace, saved.end() - static_cast<std::ptrdiff_t>(cells));
        stack.states.assign(saved.end() - static_cast<std::ptrdiff_t>(cells), saved.end());
        StackGradients to(stack);
        const auto grad = grads[0].contiguous();
        const LayerTimer timer("GRU", true);
        by_type(grad, [&](auto number) {
            using T = decltype(number);
            to.run<T>(stack, nullptr, in<T>(grad));
        });
        return to.all(stack);
    }
};

/// What feeds poses back, beside the stack's own tensors.
struct PoseTensors {
    at::Tensor weight, head, head_bias, lie, lie_bias, bones;  ///< the last three of rotations along chains
};

struct ChainOptions : torch::CustomClassHolder {
    const cpu::Chains* chains;
    bool feeds_joints;

    ChainOptions(const cpu::Chains* chains_, bool feeds_joints_)
        : chains(chains_), feeds_joints(feeds_joints_) {}
};

/// What poses leave behind: the outputs, and of rotations along chains what tanh gave and the joints.
struct PoseTraces {
    at::Tensor out, inner, joints;

    PoseTraces() = default;
    PoseTraces(const Stack& stack, std::int64_t numbers, bool is_lie) : out(stack.rows(numbers)) {
        if (!is_lie) return;
        inner = stack.rows(numbers);
        joints = stack.rows(numbers);
    }
};

template <typename T, typename Use>
void with_feedback(const Stack& stack, const PoseTensors& poses, const ChainOptions& options,
                   const PoseTraces& trace, const cpu::PoseGradient<T>* gradient, const Use& use) {
    const cpu::ChainBody<T> body{{if_there<T>(poses.lie), if_there<T>(poses.lie_bias)},
                                 options.chains,
                                 if_there<T>(poses.bones),
                                 options.feeds_joints};
    cpu::PoseFeedback<T> feedback(
        stack.shape, poses.head.size(0), in<T>(poses.weight), {in<T>(poses.head), in<T>(poses.head_bias)},
        options.chains ? &body : nullptr, {in<T>(trace.out), in<T>(trace.inner), in<T>(trace.joints)},
        gradient, at::get_num_threads());
    use(feedback);
}

/// Gradients of the weights that feed poses back, out of those to a pose's linear maps.
variable_list pose_gradients(const PoseTensors& poses, const StackGradients& stack, const at::Tensor& fed,
                             const at::Tensor& states, const PoseTraces& trace, const at::Tensor& raw,
                             const at::Tensor& lie) {
    const auto frames = fed.size(0);
    variable_list out{
        flat(stack.inputs(0).narrow(0, 1, frames - 1)).t().mm(flat(fed.narrow(0, 0, frames - 1))),
        flat(raw).t().mm(flat(states)), flat(raw).sum(0)};
    if (poses.lie.numel() > 0) {
        out.push_back(flat(lie).t().mm(flat(trace.inner.narrow(2, 3, trace.inner.size(2) - 3))));
        out.push_back(flat(lie).sum(0));
    } else {
        out.insert(out.end(), {at::Tensor(), at::Tensor()});
    }
    return out;
}

/// Outputs and joints' positions; without forward kinematics the latter is an empty tensor.
struct FedBackPoses : Function<FedBackPoses> {
    static variable_list forward(AutogradContext* context, at::TensorList tensors, const at::Tensor& weight,
                                 const at::Tensor& head, const at::Tensor& head_bias, const at::Tensor& lie,
                                 const at::Tensor& lie_bias, const at::Tensor& bones,
                                 const c10::intrusive_ptr<ChainOptions>& options) {
        Stack stack(tensors, 2);
        stack.make_traces(true);
        const PoseTensors poses{weight, head, head_bias, lie, lie_bias, bones};
        const PoseTraces trace(stack, head.size(0), options->chains != nullptr);
        const LayerTimer timer("GRU, fed back");
        by_type(weight, [&](auto number) {
            using T = decltype(number);
            with_feedback<T>(stack, poses, *options, trace, nullptr,
                             [&](cpu::PoseFeedback<T>& feedback) { stack.run<T>(&feedback); });
        });
        auto saved = tensors.vec();
        for (const auto* more : {&weight, &head, &head_bias, &lie, &lie_bias, &bones}) saved.push_back(*more);
        const auto none = at::empty({0}, weight.options());
        const auto inner = options->chains ? trace.inner : none,
                   joints = options->chains ? trace.joints : none;
        for (const auto& more :
             {stack.gates[0], stack.gates[1], stack.states[0], stack.states[1], trace.out, inner, joints})
            saved.push_back(more);
        context->save_for_backward(saved);
        context->saved_data["options"] = c10::IValue::make_capsule(options);
        return {trace.out, joints};
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        constexpr std::size_t inputs = first_cell + 2 * a_cell;
        const auto* s = saved.data() + inputs;
        const PoseTensors poses{s[0], s[1], s[2], s[3], s[4], s[5]};
        Stack stack(at::TensorList(saved).slice(0, inputs), 2);
        stack.gates = {s[6], s[7]};
        stack.states = {s[8], s[9]};
        PoseTraces trace;
        trace.out = s[10];
        const auto capsule = context->saved_data["options"].toCapsule();
        const auto& options = static_cast<const ChainOptions&>(*capsule);
        const bool is_lie = options.chains != nullptr;
        if (is_lie) {
            trace.inner = s[11];
            trace.joints = s[12];
        }
        StackGradients to(stack);
        const auto numbers = trace.out.size(2);
        const auto raw = stack.rows(numbers), lie = is_lie ? stack.rows(numbers - 3) : at::Tensor();
        const auto to_out = grads[0].contiguous(), to_joints = grads[1].contiguous();
        const LayerTimer timer("GRU, fed back", true);
        by_type(raw, [&](auto number) {
            using T = decltype(number);
            const cpu::PoseGradient<T> gradient{in<T>(to_out), if_there<T>(to_joints), in<T>(raw),
                                                in<T>(lie)};
            with_feedback<T>(stack, poses, options, trace, &gradient,
                             [&](cpu::PoseFeedback<T>& feedback) { to.run<T>(stack, &feedback, nullptr); });
        });
        auto all = to.all(stack);
        const auto& fed = is_lie && options.feeds_joints ? trace.joints : trace.out;
        for (auto& more : pose_gradients(poses, to, fed, stack.states[1], trace, raw, lie))
            all.push_back(std::move(more));
        all.insert(all.end(), {at::Tensor(), at::Tensor()});
        return all;
    }
};

struct ChainKinematics : Function<ChainKinematics> {
    template <typename Run>
    static void for_parts(std::int64_t rows, const Run& run) {
        at::parallel_for(0, rows, 64,
                         [&](std::int64_t first, std::int64_t last) { run(first, last - first); });
    }

    static at::Tensor forward(AutogradContext* context, const at::Tensor& poses, const at::Tensor& bones,
                              const c10::intrusive_ptr<ChainOptions>& options) {
        auto joints = at::empty_like(poses);
        const LayerTimer timer("chains of bones");
        by_type(poses, [&](auto number) {
            using T = decltype(number);
            const auto width = poses.size(1);
            for_parts(poses.size(0), [&](std::int64_t first, std::int64_t count) {
                cpu::chain_kinematics<T>(*options->chains, count, in<T>(poses) + first * width,
                                         in<T>(bones) + first * width / 3, in<T>(joints) + first * width);
            });
        });
        context->save_for_backward({poses, bones});
        context->saved_data["options"] = c10::IValue::make_capsule(options);
        return joints;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &poses = saved[0], &bones = saved[1];
        const auto grad = grads[0].contiguous();
        const auto capsule = context->saved_data["options"].toCapsule();
        const auto& options = static_cast<const ChainOptions&>(*capsule);
        auto to = at::empty_like(poses);
        const LayerTimer timer("chains of bones", true);
        by_type(poses, [&](auto number) {
            using T = decltype(number);
            const auto width = poses.size(1);
            for_parts(poses.size(0), [&](std::int64_t first, std::int64_t count) {
                cpu::chain_kinematics_backward<T>(*options.chains, count, in<T>(poses) + first * width,
                                                  in<T>(bones) + first * width / 3,
                                                  in<T>(grad) + first * width, in<T>(to) + first * width);
            });
        });
        return {to, {}, {}};
    }
};

}  // namespace

at::Tensor fused_gru(const GruInputs& inputs, const std::vector<GruTensors>& cells) {
    const auto tensors = tensors_of(inputs, cells);
    return Gru::apply(at::TensorList(tensors));
}

FusedPoses fused_fed_back_poses(const GruInputs& inputs, const std::vector<GruTensors>& cells,
                                const at::Tensor& weight, const LinearTensors& head,
                                const ChainBodyTensors& body) {
    const auto tensors = tensors_of(inputs, cells);
    const auto none = at::empty({0}, head.weight.options());
    const bool is_lie = body.chains != nullptr;
    const auto out = FedBackPoses::apply(at::TensorList(tensors), weight.contiguous(), head.weight, head.bias,
                                         is_lie ? body.weight.weight : none, is_lie ? body.weight.bias : none,
                                         is_lie ? body.bones.contiguous() : none,
                                         c10::make_intrusive<ChainOptions>(body.chains, body.feeds_joints));
    return {out[0], is_lie ? out[1] : at::Tensor()};
}

FusedPoses fused_sampled_poses(const PriorTensors& prior, const GruInputs& inputs,
                               const std::vector<GruTensors>& cells, const at::Tensor& weight,
                               const LinearTensors& head, const ChainBodyTensors& body,
                               const at::Tensor& noise) {
    const at::NoGradGuard no_gradients;
    const auto width = 3 * cells[0].hidden.weight.size(1);
    auto with_products = inputs;
    with_products.products = at::empty({noise.size(0), noise.size(1), width}, noise.options());
    const auto tensors = tensors_of(with_products, cells), of_prior = tensors_of(prior.inputs, {prior.cell});
    Stack stack(tensors, cells.size());
    stack.make_traces(false);
    const Stack prior_stack(of_prior, 1);
    const auto none = at::empty({0}, noise.options());
    const bool is_lie = body.chains != nullptr;
    const PoseTensors poses{weight.contiguous(),
                            head.weight,
                            head.bias,
                            is_lie ? body.weight.weight : none,
                            is_lie ? body.weight.bias : none,
                            is_lie ? body.bones.contiguous() : none};
    const PoseTraces trace(stack, head.weight.size(0), is_lie);
    const auto pose = prior.pose.contiguous(), latent = prior.latent.contiguous(),
               normals = noise.contiguous();
    const LayerTimer timer("GRU, sampled");
    by_type(noise, [&](auto number) {
        using T = decltype(number);
        const cpu::PriorWeights<T> weights{prior_stack.input<T>(),
                                           prior_stack.weights<T>()[0],
                                           in<T>(pose),
                                           {in<T>(prior.head.weight), in<T>(prior.head.bias)},
                                           in<T>(latent),
                                           in<T>(normals),
                                           noise.size(2)};
        with_feedback<T>(stack, poses, ChainOptions(body.chains, body.feeds_joints), trace, nullptr,
                         [&](cpu::PoseFeedback<T>& feedback) {
                             cpu::PoseSampler<T> sampler(stack.shape, feedback, weights,
                                                         in<T>(stack.tensors[0]), at::get_num_threads());
                             stack.run<T>(&sampler);
                         });
    });
    return {trace.out, trace.joints};
}

at::Tensor fused_chain_kinematics(const cpu::Chains& chains, const at::Tensor& poses,
                                  const at::Tensor& bones) {
    return ChainKinematics::apply(poses.contiguous(), bones.contiguous(),
                                  c10::make_intrusive<ChainOptions>(&chains, false));
}

}  // namespace actformer::model
