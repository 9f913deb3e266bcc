#include "model/nn/fused_post_norm.hpp"

#include <torch/csrc/autograd/custom_function.h>

#include "model/cpu/post_norm_kernels.hpp"
#include "model/nn/function_support.hpp"

namespace actformer::model {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

/// What a sublayer is told beside tensors.
struct SublayerOptions : torch::CustomClassHolder {
    std::int64_t heads;
    double epsilon;
    BranchDropout dropout;

    SublayerOptions(std::int64_t of_heads, double of_epsilon, const BranchDropout& of_dropout)
        : heads(of_heads), epsilon(of_epsilon), dropout(of_dropout) {}
};
using SublayerPointer = c10::intrusive_ptr<SublayerOptions>;

const SublayerOptions& sublayer_of(AutogradContext* context) {
    return static_cast<const SublayerOptions&>(*context->saved_data["sublayer"].toCapsule());
}

cpu::TokenShape sequence_shape(const at::Tensor& x) {
    return {x.size(0), 1, x.size(1), x.size(2)};
}

cpu::AttentionShape attention_shape(const at::Tensor& x, const SublayerOptions& sublayer) {
    return {sequence_shape(x), sublayer.heads, false};
}

/// AttentionNormWeights or MlpNormWeights: two linear maps and the norm behind, as Functions save them behind x.
template <template <typename> class Weights, typename T>
Weights<T> branch_weights(const at::Tensor* w, const SublayerOptions& sublayer) {
    return {linear_of<T>(w[0], w[1]),
            linear_of<T>(w[2], w[3]),
            {norm_of<T>(w[4], w[5]), sublayer.epsilon, sublayer.dropout.branch},
            sublayer.dropout.within};
}

/// parts, bias, norm.
template <typename T>
cpu::SumNormWeights<T> sum_weights(const at::Tensor* w, const SublayerOptions& sublayer) {
    return {in<T>(w[0]),
            in<T>(w[1]),
            {norm_of<T>(w[2], w[3]), sublayer.epsilon, sublayer.dropout.branch},
            sublayer.dropout.within};
}

constexpr const char *of_attention = "attention", *of_mlp = "MLP", *of_sum = "attention to one token";

/// Tensors to keep for the backward pass; undefined where there is none.
struct KeptAttention {
    at::Tensor qkv, seen, sum;
};

struct AttentionNorm : Function<AttentionNorm> {
    static at::Tensor run_forward(const at::Tensor& x, const at::Tensor* weights,
                                  const SublayerOptions& sublayer, const KeptAttention& kept) {
        auto y = at::empty_like(x);
        timed(of_attention, false, x, [&](auto number) {
            using T = decltype(number);
            cpu::attention_norm_forward<T>(attention_shape(x, sublayer), in<T>(x),
                                           branch_weights<cpu::AttentionNormWeights, T>(weights, sublayer),
                                           {in<T>(kept.qkv), in<T>(kept.seen), in<T>(kept.sum)}, in<T>(y),
                                           threads());
        });
        return y;
    }

    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& qkv,
                              const at::Tensor& qkv_bias, const at::Tensor& proj, const at::Tensor& proj_bias,
                              const at::Tensor& norm, const at::Tensor& norm_bias,
                              const SublayerPointer& sublayer) {
        const auto shape = attention_shape(x, *sublayer);
        const KeptAttention kept{at::empty({shape.tokens.rows(), shape.qkv_pitch()}, x.options()),
                                 at::empty({shape.tokens.rows(), shape.seen_pitch()}, x.options()),
                                 at::empty_like(x)};
        const at::Tensor weights[] = {qkv, qkv_bias, proj, proj_bias, norm, norm_bias};
        auto y = run_forward(x, weights, *sublayer, kept);
        context->save_for_backward(
            {x, qkv, qkv_bias, proj, proj_bias, norm, norm_bias, kept.qkv, kept.seen, kept.sum});
        context->saved_data["sublayer"] = c10::IValue::make_capsule(sublayer);
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto& x = saved[0];
        const auto& sublayer = sublayer_of(context);
        const auto grad = grads[0].contiguous();
        auto to_x = at::empty_like(x);
        const Gradients qkv(saved[1], saved[2]), proj(saved[3], saved[4]), norm(saved[5], saved[6]);
        timed(of_attention, true, x, [&](auto number) {
            using T = decltype(number);
            cpu::attention_norm_backward<T>(attention_shape(x, sublayer), in<T>(x),
                                            branch_weights<cpu::AttentionNormWeights, T>(&saved[1], sublayer),
                                            {in<T>(saved[7]), in<T>(saved[8]), in<T>(saved[9])}, in<T>(grad),
                                            {in<T>(to_x), norm.to<T>(), qkv.to<T>(), proj.to<T>()},
                                            threads());
        });
        return {to_x, qkv.weight, qkv.bias, proj.weight, proj.bias, norm.weight, norm.bias, {}};
    }
};

struct MlpNorm : Function<MlpNorm> {
    /// Keeps up's outputs and the sums for the backward pass where they are defined.
    static at::Tensor run_forward(const at::Tensor& x, const at::Tensor* weights,
                                  const SublayerOptions& sublayer, const at::Tensor& kept_up,
                                  const at::Tensor& sum) {
        auto y = at::empty_like(x);
        timed(of_mlp, false, x, [&](auto number) {
            using T = decltype(number);
            cpu::mlp_norm_forward<T>({sequence_shape(x), weights[0].size(0)}, in<T>(x),
                                     branch_weights<cpu::MlpNormWeights, T>(weights, sublayer),
                                     {in<T>(kept_up), in<T>(sum)}, in<T>(y), threads());
        });
        return y;
    }

    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& up,
                              const at::Tensor& up_bias, const at::Tensor& down, const at::Tensor& down_bias,
                              const at::Tensor& norm, const at::Tensor& norm_bias,
                              const SublayerPointer& sublayer) {
        const cpu::MlpShape shape{sequence_shape(x), up.size(0)};
        const auto kept_up = at::empty({shape.tokens.rows(), shape.hidden_pitch()}, x.options()),
                   sum = at::empty_like(x);
        const at::Tensor weights[] = {up, up_bias, down, down_bias, norm, norm_bias};
        auto y = run_forward(x, weights, *sublayer, kept_up, sum);
        context->save_for_backward({x, up, up_bias, down, down_bias, norm, norm_bias, kept_up, sum});
        context->saved_data["sublayer"] = c10::IValue::make_capsule(sublayer);
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto& x = saved[0];
        const auto& sublayer = sublayer_of(context);
        const auto grad = grads[0].contiguous();
        auto to_x = at::empty_like(x);
        const Gradients up(saved[1], saved[2]), down(saved[3], saved[4]), norm(saved[5], saved[6]);
        timed(of_mlp, true, x, [&](auto number) {
            using T = decltype(number);
            cpu::mlp_norm_backward<T>({sequence_shape(x), saved[1].size(0)}, in<T>(x),
                                      branch_weights<cpu::MlpNormWeights, T>(&saved[1], sublayer),
                                      {in<T>(saved[7]), in<T>(saved[8])}, in<T>(grad),
                                      {in<T>(to_x), norm.to<T>(), up.to<T>(), down.to<T>()}, threads());
        });
        return {to_x, up.weight, up.bias, down.weight, down.bias, norm.weight, norm.bias, {}};
    }
};

struct SumNorm : Function<SumNorm> {
    /// Keeps the sums for the backward pass where `sum` is defined.
    static at::Tensor run_forward(const at::Tensor& x, const at::Tensor* weights,
                                  const SublayerOptions& sublayer, const at::Tensor& sum) {
        auto y = at::empty_like(x);
        timed(of_sum, false, x, [&](auto number) {
            using T = decltype(number);
            cpu::sum_norm_forward<T>({sequence_shape(x), weights[0].size(1)}, in<T>(x),
                                     sum_weights<T>(weights, sublayer), in<T>(sum), in<T>(y), threads());
        });
        return y;
    }

    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& parts,
                              const at::Tensor& bias, const at::Tensor& norm, const at::Tensor& norm_bias,
                              const SublayerPointer& sublayer) {
        const auto sum = at::empty_like(x);
        const at::Tensor weights[] = {parts, bias, norm, norm_bias};
        auto y = run_forward(x, weights, *sublayer, sum);
        context->save_for_backward({parts, bias, norm, norm_bias, sum});
        context->saved_data["sublayer"] = c10::IValue::make_capsule(sublayer);
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &parts = saved[0], &bias = saved[1], &sum = saved[4];
        const auto grad = grads[0].contiguous();
        auto to_x = at::empty_like(sum), to_parts = at::empty_like(parts), to_bias = at::empty_like(bias);
        const Gradients norm(saved[2], saved[3]);
        timed(of_sum, true, sum, [&](auto number) {
            using T = decltype(number);
            cpu::sum_norm_backward<T>(
                {sequence_shape(sum), parts.size(1)}, sum_weights<T>(&saved[0], sublayer_of(context)),
                in<T>(sum), in<T>(grad), {in<T>(to_x), in<T>(to_parts), in<T>(to_bias), norm.to<T>()},
                threads());
        });
        return {to_x, to_parts, to_bias, norm.weight, norm.bias, {}};
    }
};

SublayerPointer options_of(std::int64_t heads, const PostNormTensors& post, const BranchDropout& dropout) {
    return c10::make_intrusive<SublayerOptions>(heads, post.epsilon, dropout);
}

}  // namespace

at::Tensor fused_attention_norm(const at::Tensor& x, const LinearTensors& qkv, const LinearTensors& proj,
                                const PostNormTensors& post, std::int64_t heads,
                                const BranchDropout& dropout) {
    const auto sublayer = options_of(heads, post, dropout);
    if (grad_enabled())
        return AttentionNorm::apply(x, qkv.weight, qkv.bias, proj.weight, proj.bias, post.norm.weight,
                                    post.norm.bias, sublayer);
    const at::Tensor weights[] = {qkv.weight, qkv.bias,         proj.weight,
                                  proj.bias,  post.norm.weight, post.norm.bias};
    return AttentionNorm::run_forward(x, weights, *sublayer, {});
}

at::Tensor fused_mlp_norm(const at::Tensor& x, const LinearTensors& up, const LinearTensors& down,
                          const PostNormTensors& post, const BranchDropout& dropout) {
    const auto sublayer = options_of(0, post, dropout);
    if (grad_enabled())
        return MlpNorm::apply(x, up.weight, up.bias, down.weight, down.bias, post.norm.weight, post.norm.bias,
                              sublayer);
    const at::Tensor weights[] = {up.weight, up.bias,          down.weight,
                                  down.bias, post.norm.weight, post.norm.bias};
    return MlpNorm::run_forward(x, weights, *sublayer, {}, {});
}

at::Tensor fused_sum_norm(const at::Tensor& x, const at::Tensor& parts, const at::Tensor& bias,
                          const PostNormTensors& post, const BranchDropout& dropout) {
    const auto sublayer = options_of(0, post, dropout);
    if (grad_enabled()) return SumNorm::apply(x, parts, bias, post.norm.weight, post.norm.bias, sublayer);
    const at::Tensor weights[] = {parts, bias, post.norm.weight, post.norm.bias};
    return SumNorm::run_forward(x, weights, *sublayer, {});
}

at::Tensor kept_numbers(const at::Tensor& x, const cpu::Dropout& dropout) {
    const auto samples = x.size(0), columns = x.size(-1), rows = x.numel() / (samples * columns),
               words = cpu::words_for(columns);
    auto kept = at::empty({samples, rows, columns}, at::kFloat);
    std::vector<std::uint16_t> bits(static_cast<std::size_t>(rows * words));
    auto* to = kept.data_ptr<float>();
    for (std::int64_t n = 0; n < samples; ++n) {
        cpu::draw_kept(dropout, n, rows * words, bits.data());
        for (std::int64_t r = 0; r < rows; ++r)
            for (std::int64_t c = 0; c < columns; ++c) {
                const auto word = bits[static_cast<std::size_t>(r * words + c / cpu::numbers_a_word)];
                *to++ = static_cast<float>(word >> (c % cpu::numbers_a_word) & 1);
            }
    }
    return kept.view(x.sizes()).to(x.scalar_type()) * dropout.scale();
}

}  // namespace actformer::model
