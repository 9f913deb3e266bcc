#include "model/nn/fused.hpp"

#include <torch/csrc/autograd/custom_function.h>

#include "model/cpu/motion_kernels.hpp"
#include "model/cpu/spectral_kernel.hpp"
#include "model/nn/function_support.hpp"

namespace actformer::model {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

struct Spectral : Function<Spectral> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& weight, const at::Tensor& u,
                              const at::Tensor& v, bool iterate) {
        auto normalised = at::empty_like(weight);
        const auto rows = u.numel(), columns = v.numel();
        double value = 0;
        timed("spectral norms", false, weight, [&](auto number) {
            using T = decltype(number);
            const T now =
                iterate ? cpu::power_iteration<T>(in<T>(weight), rows, columns, in<T>(u), in<T>(v), threads())
                        : cpu::singular_value<T>(in<T>(weight), rows, columns, in<T>(u), in<T>(v), threads());
            cpu::scale<T>(in<T>(weight), weight.numel(), 1 / now, in<T>(normalised), threads());
            value = static_cast<double>(now);
        });
        // The vectors move on at the next call, perhaps before this one's gradient is taken.
        context->save_for_backward({normalised, u.clone(), v.clone()});
        context->saved_data["value"] = value;
        return normalised;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &normalised = saved[0], &u = saved[1], &v = saved[2];
        const auto grad = grads[0].contiguous();
        auto to = at::empty_like(normalised);
        timed("spectral norms", true, grad, [&](auto number) {
            using T = decltype(number);
            cpu::spectral_backward<T>(in<T>(grad), in<T>(normalised), u.numel(), v.numel(), in<T>(u),
                                      in<T>(v), static_cast<T>(context->saved_data["value"].toDouble()),
                                      in<T>(to), threads());
        });
        return {to, {}, {}, {}};
    }
};

cpu::EmbeddingShape embedding_shape(const at::Tensor& latent, const at::Tensor& positions) {
    return {latent.size(0), latent.size(1), positions.size(1),
            latent.size(2), latent.size(3), positions.size(2)};
}

struct Embedding : Function<Embedding> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& latent, const at::Tensor& weight,
                              const at::Tensor& bias, const at::Tensor& classes,
                              const at::Tensor& positions) {
        const auto shape = embedding_shape(latent, positions);
        auto tokens =
            at::empty({shape.samples, shape.persons, shape.tokens(), shape.width}, weight.options());
        timed("latents to tokens", false, latent, [&](auto number) {
            using T = decltype(number);
            cpu::embed_forward<T>(shape, in<T>(latent), linear_of<T>(weight, bias), in<T>(classes),
                                  in<T>(positions), in<T>(tokens), threads());
        });
        context->save_for_backward({latent, weight, bias, classes, positions});
        return tokens;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto& latent = saved[0];
        const auto grad = grads[0].contiguous();
        const Gradients linear(saved[1], saved[2]);
        auto classes = at::empty_like(saved[3]), positions = at::empty_like(saved[4]);
        timed("latents to tokens", true, latent, [&](auto number) {
            using T = decltype(number);
            cpu::embed_backward<T>(embedding_shape(latent, positions), in<T>(latent), in<T>(grad),
                                   {linear.to<T>(), in<T>(classes), in<T>(positions)}, threads());
        });
        return {{}, linear.weight, linear.bias, classes, positions};
    }
};

cpu::TokenShape token_shape(const at::Tensor& x) {
    return {x.size(0), x.size(1), x.size(2), x.size(3)};
}

const char* attention_name(const cpu::AttentionShape& shape) {
    return shape.over_persons ? "attention over persons" : "attention over frames";
}

/// A sublayer's six weights, as Function saves them behind x.
template <typename T>
cpu::AttentionWeights<T> attention_weights(const at::Tensor* w) {
    return {norm_of<T>(w[0], w[1]), linear_of<T>(w[2], w[3]), linear_of<T>(w[4], w[5])};
}

template <typename T>
cpu::MlpWeights<T> mlp_weights(const at::Tensor* w) {
    return {norm_of<T>(w[0], w[1]), linear_of<T>(w[2], w[3]), linear_of<T>(w[4], w[5])};
}

struct Attention : Function<Attention> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& norm,
                              const at::Tensor& norm_bias, const at::Tensor& qkv, const at::Tensor& qkv_bias,
                              const at::Tensor& proj, const at::Tensor& proj_bias, std::int64_t heads,
                              bool over_persons) {
        const cpu::AttentionShape shape{token_shape(x), heads, over_persons};
        auto kept_qkv = at::empty({shape.tokens.rows(), shape.qkv_pitch()}, x.options()),
             kept_seen = at::empty({shape.tokens.rows(), shape.seen_pitch()}, x.options());
        auto y = at::empty_like(x);
        const at::Tensor weights[] = {norm, norm_bias, qkv, qkv_bias, proj, proj_bias};
        timed(attention_name(shape), false, x, [&](auto number) {
            using T = decltype(number);
            cpu::attention_forward<T>(shape, in<T>(x), attention_weights<T>(weights),
                                      {in<T>(kept_qkv), in<T>(kept_seen)}, in<T>(y), threads());
        });
        context->save_for_backward({x, norm, norm_bias, qkv, qkv_bias, proj, proj_bias, kept_qkv, kept_seen});
        context->saved_data["heads"] = heads;
        context->saved_data["over_persons"] = over_persons;
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto& x = saved[0];
        const cpu::AttentionShape shape{token_shape(x), context->saved_data["heads"].toInt(),
                                        context->saved_data["over_persons"].toBool()};
        const auto grad = grads[0].contiguous();
        auto to_x = at::empty_like(x);
        const Gradients norm(saved[1], saved[2]), qkv(saved[3], saved[4]), proj(saved[5], saved[6]);
        timed(attention_name(shape), true, x, [&](auto number) {
            using T = decltype(number);
            cpu::attention_backward<T>(shape, in<T>(x), attention_weights<T>(&saved[1]),
                                       {in<T>(saved[7]), in<T>(saved[8])}, in<T>(grad),
                                       {in<T>(to_x), norm.to<T>(), qkv.to<T>(), proj.to<T>()}, threads());
        });
        return {to_x, norm.weight, norm.bias, qkv.weight, qkv.bias, proj.weight, proj.bias, {}, {}};
    }
};

struct Mlp : Function<Mlp> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& norm,
                              const at::Tensor& norm_bias, const at::Tensor& up, const at::Tensor& up_bias,
                              const at::Tensor& down, const at::Tensor& down_bias) {
        const cpu::MlpShape shape{token_shape(x), up.size(0)};
        auto kept = at::empty({shape.tokens.rows(), shape.hidden_pitch()}, x.options());
        auto y = at::empty_like(x);
        const at::Tensor weights[] = {norm, norm_bias, up, up_bias, down, down_bias};
        timed("MLP", false, x, [&](auto number) {
            using T = decltype(number);
            cpu::mlp_forward<T>(shape, in<T>(x), mlp_weights<T>(weights), in<T>(kept), in<T>(y), threads());
        });
        context->save_for_backward({x, norm, norm_bias, up, up_bias, down, down_bias, kept});
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto& x = saved[0];
        const auto grad = grads[0].contiguous();
        auto to_x = at::empty_like(x);
        const Gradients norm(saved[1], saved[2]), up(saved[3], saved[4]), down(saved[5], saved[6]);
        timed("MLP", true, x, [&](auto number) {
            using T = decltype(number);
            cpu::mlp_backward<T>({token_shape(x), saved[3].size(0)}, in<T>(x), mlp_weights<T>(&saved[1]),
                                 in<T>(saved[7]), in<T>(grad),
                                 {in<T>(to_x), norm.to<T>(), up.to<T>(), down.to<T>()}, threads());
        });
        return {to_x, norm.weight, norm.bias, up.weight, up.bias, down.weight, down.bias};
    }
};

cpu::PoseShape pose_shape(const at::Tensor& x, const at::Tensor& head,
                          ingest::Representation representation) {
    return {token_shape(x), head.size(0) / representation.numbers(), representation};
}

at::Tensor motion_for(const cpu::PoseShape& shape, const at::Tensor& like) {
    return at::empty(
        {shape.tokens.samples, shape.tokens.persons * shape.numbers(), shape.frames(), shape.nodes},
        like.options());
}

struct Poses : Function<Poses> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& norm,
                              const at::Tensor& norm_bias, const at::Tensor& head,
                              const at::Tensor& head_bias, ingest::Representation representation) {
        const auto shape = pose_shape(x, head, representation);
        auto kept = at::empty(
            {shape.tokens.samples * shape.tokens.persons * shape.frames(), shape.raw_pitch()}, x.options());
        auto motion = motion_for(shape, x);
        timed("tokens to motions", false, x, [&](auto number) {
            using T = decltype(number);
            cpu::pose_forward<T>(shape, in<T>(x),
                                 {norm_of<T>(norm, norm_bias), linear_of<T>(head, head_bias)}, in<T>(kept),
                                 in<T>(motion), threads());
        });
        context->save_for_backward({x, norm, norm_bias, head, head_bias, kept});
        context->saved_data["representation"] = std::int64_t{ingest::Representation::Kind(representation)};
        return motion;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto& x = saved[0];
        const auto grad = grads[0].contiguous();
        const auto representation =
            static_cast<ingest::Representation::Kind>(context->saved_data["representation"].toInt());
        auto to_x = at::empty_like(x);
        const Gradients norm(saved[1], saved[2]), head(saved[3], saved[4]);
        timed("tokens to motions", true, x, [&](auto number) {
            using T = decltype(number);
            cpu::pose_backward<T>(pose_shape(x, saved[3], representation), in<T>(x),
                                  {norm_of<T>(saved[1], saved[2]), linear_of<T>(saved[3], saved[4])},
                                  in<T>(saved[5]), in<T>(grad), {in<T>(to_x), norm.to<T>(), head.to<T>()},
                                  threads());
        });
        return {to_x, norm.weight, norm.bias, head.weight, head.bias, {}};
    }
};

struct MotionInput : Function<MotionInput> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& motion, std::int64_t padding) {
        const cpu::MotionInputShape shape{motion.size(0), motion.size(1), motion.size(2), motion.size(3),
                                          padding};
        auto to = at::empty({shape.samples, shape.nodes, shape.frames + 2 * padding, 2 * shape.channels},
                            motion.options());
        timed("motions to nodes", false, motion, [&](auto number) {
            using T = decltype(number);
            cpu::motion_input<T>(shape, in<T>(motion), in<T>(to), threads());
        });
        context->saved_data["padding"] = padding;
        return to;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto grad = grads[0].contiguous();
        const auto padding = context->saved_data["padding"].toInt();
        const cpu::MotionInputShape shape{grad.size(0), grad.size(3) / 2, grad.size(2) - 2 * padding,
                                          grad.size(1), padding};
        auto to = at::empty({shape.samples, shape.channels, shape.frames, shape.nodes}, grad.options());
        timed("motions to nodes", true, grad, [&](auto number) {
            using T = decltype(number);
            cpu::motion_input_backward<T>(shape, in<T>(grad), in<T>(to), threads());
        });
        return {to, {}};
    }
};

const char* convolution_name(const cpu::NodeShape& shape) {
    if (shape.out_nodes == 1) return "convolution over all nodes";
    if (shape.out_nodes > shape.in_nodes) return "graph convolution, refining";
    if (shape.stride == 1) return "graph convolution, all frames";
    if (shape.in_nodes == shape.out_nodes) return "graph convolution, coarse nodes";
    return "graph convolution, coarsening";
}

/// What a graph convolution keeps for the backward pass beside tensors.
struct NodeLayer : torch::CustomClassHolder {
    cpu::NodeShape shape;
    std::shared_ptr<const cpu::NodeSums> sums;
    double leak;

    NodeLayer(const cpu::NodeShape& of, std::shared_ptr<const cpu::NodeSums> from, double slope)
        : shape(of), sums(std::move(from)), leak(slope) {}
};

/// Functions take no undefined tensors: an empty bias stands for none.
struct NodeConvolve : Function<NodeConvolve> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& weight,
                              const at::Tensor& bias, const c10::intrusive_ptr<NodeLayer>& layer) {
        const auto& shape = layer->shape;
        auto y =
            at::empty({shape.samples, shape.out_nodes, shape.padded_out_frames(), shape.out}, x.options());
        timed(convolution_name(shape), false, x, [&](auto number) {
            using T = decltype(number);
            cpu::node_forward<T>(shape, *layer->sums, in<T>(x), in<T>(weight),
                                 bias.numel() > 0 ? in<T>(bias) : nullptr, static_cast<T>(layer->leak),
                                 in<T>(y), threads());
        });
        context->save_for_backward({x, weight, bias, y});
        context->saved_data["layer"] = c10::IValue::make_capsule(layer);
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &x = saved[0], &weight = saved[1], &bias = saved[2], &y = saved[3];
        const auto grad = grads[0].contiguous();
        const auto capsule = context->saved_data["layer"].toCapsule();
        const auto& layer = static_cast<const NodeLayer&>(*capsule);
        const auto& shape = layer.shape;
        at::Tensor to_x, to_weight, to_bias;
        if (context->needs_input_grad(0)) to_x = at::empty_like(x);
        if (context->needs_input_grad(1)) to_weight = at::empty_like(weight);
        if (bias.numel() > 0 && context->needs_input_grad(2)) to_bias = at::empty_like(bias);
        timed(convolution_name(shape), true, x, [&](auto number) {
            using T = decltype(number);
            cpu::node_backward<T>(shape, *layer.sums, in<T>(x), in<T>(weight), static_cast<T>(layer.leak),
                                  in<T>(y), in<T>(grad), weight.numel(),
                                  {in<T>(to_x), in<T>(to_weight), in<T>(to_bias)}, threads());
        });
        return {to_x, to_weight, to_bias, {}};
    }
};

}  // namespace

at::Tensor fused_spectral(const at::Tensor& weight, const at::Tensor& u, const at::Tensor& v, bool iterate) {
    return Spectral::apply(weight, u, v, iterate);
}

at::Tensor fused_embedding(const at::Tensor& latent, const LinearTensors& linear, const at::Tensor& classes,
                           const at::Tensor& positions) {
    return Embedding::apply(latent, linear.weight, linear.bias, classes, positions);
}

void fused_attention_in_place(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& qkv,
                              const LinearTensors& proj, std::int64_t heads, bool over_persons) {
    const at::Tensor weights[] = {norm.weight, norm.bias, qkv.weight, qkv.bias, proj.weight, proj.bias};
    timed(over_persons ? "attention over persons" : "attention over frames", false, x, [&](auto number) {
        using T = decltype(number);
        cpu::attention_forward<T>({token_shape(x), heads, over_persons}, in<T>(x),
                                  attention_weights<T>(weights), {nullptr, nullptr}, in<T>(x), threads());
    });
}

at::Tensor fused_attention(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& qkv,
                           const LinearTensors& proj, std::int64_t heads, bool over_persons) {
    if (grad_enabled())
        return Attention::apply(x, norm.weight, norm.bias, qkv.weight, qkv.bias, proj.weight, proj.bias,
                                heads, over_persons);
    auto y = x.clone();
    fused_attention_in_place(y, norm, qkv, proj, heads, over_persons);
    return y;
}

void fused_mlp_in_place(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& up,
                        const LinearTensors& down) {
    const at::Tensor weights[] = {norm.weight, norm.bias, up.weight, up.bias, down.weight, down.bias};
    timed("MLP", false, x, [&](auto number) {
        using T = decltype(number);
        cpu::mlp_forward<T>({token_shape(x), up.weight.size(0)}, in<T>(x), mlp_weights<T>(weights), nullptr,
                            in<T>(x), threads());
    });
}

at::Tensor fused_mlp(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& up,
                     const LinearTensors& down) {
    if (grad_enabled())
        return Mlp::apply(x, norm.weight, norm.bias, up.weight, up.bias, down.weight, down.bias);
    auto y = x.clone();
    fused_mlp_in_place(y, norm, up, down);
    return y;
}

at::Tensor fused_poses(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& head,
                       ingest::Representation representation) {
    if (grad_enabled())
        return Poses::apply(x, norm.weight, norm.bias, head.weight, head.bias, representation);
    const auto shape = pose_shape(x, head.weight, representation);
    auto motion = motion_for(shape, x);
    timed("tokens to motions", false, x, [&](auto number) {
        using T = decltype(number);
        cpu::pose_forward<T>(shape, in<T>(x),
                             {norm_of<T>(norm.weight, norm.bias), linear_of<T>(head.weight, head.bias)},
                             nullptr, in<T>(motion), threads());
    });
    return motion;
}

at::Tensor fused_motion_input(const at::Tensor& motion, std::int64_t padding) {
    return MotionInput::apply(motion, padding);
}

at::Tensor fused_node_convolution(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                                  const cpu::NodeShape& shape, std::shared_ptr<const cpu::NodeSums> sums,
                                  double leak) {
    TORCH_CHECK(x.dim() == 4 && x.size(1) == shape.in_nodes && x.size(2) == shape.padded_frames() &&
                    x.size(3) == shape.in,
                "a graph convolution of ", shape.in_nodes, " nodes, ", shape.padded_frames(), " frames and ",
                shape.in, " channels was given ", x.sizes());
    return NodeConvolve::apply(x, weight, bias.defined() ? bias : at::empty({0}, x.options()),
                               c10::make_intrusive<NodeLayer>(shape, std::move(sums), leak));
}

}  // namespace actformer::model
