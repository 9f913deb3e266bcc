#include "model/nn/weight_store.hpp"

#include <ATen/CPUGeneratorImpl.h>
#include <ATen/core/grad_mode.h>

#include <cmath>

#include "model/nn/autocast.hpp"

namespace actformer::model {
namespace {

constexpr double least_norm = 1e-12;  // as in torch.nn.utils.spectral_norm
constexpr int first_iterations = 15;

at::Tensor unit(const at::Tensor& vector) {
    return vector / vector.norm().clamp_min(least_norm);
}

/// Sines and cosines of `count` positions in turn, (count, width).
at::Tensor sinusoids(std::int64_t count, std::int64_t width) {
    auto table = at::zeros({count, width}, at::kDouble);
    for (std::int64_t i = 0; i < count; ++i)
        for (std::int64_t c = 0; c < width; ++c) {
            const double pace =
                std::pow(10000.0, -static_cast<double>(c / 2 * 2) / static_cast<double>(width));
            const double angle = static_cast<double>(i) * pace;
            table.data_ptr<double>()[i * width + c] = c % 2 == 0 ? std::sin(angle) : std::cos(angle);
        }
    return table;
}

/// [over frames, over persons], (frames, persons, width), from a table each; one person leaves the width to the frames.
at::Tensor tiled(const at::Tensor& frames, const at::Tensor& persons) {
    const auto t = frames.size(0), p = persons.size(0);
    return at::cat({frames.unsqueeze(1).expand({t, p, frames.size(1)}),
                    persons.unsqueeze(0).expand({t, p, persons.size(1)})},
                   2);
}

/// Behind the class token, first of all, which has no place in time.
at::Tensor frame_sinusoids(std::int64_t tokens, std::int64_t width) {
    return at::cat({at::zeros({1, width}, at::kDouble), sinusoids(tokens - 1, width)});
}

at::Tensor sinusoid_table(const std::vector<std::int64_t>& shape) {
    const auto half = shape[1] > 1 ? shape[2] / 2 : shape[2];
    const auto frames = frame_sinusoids(shape[0], half);
    auto persons = sinusoids(shape[1], shape[2] - half);
    auto table = tiled(frames, persons);
    table[0].zero_();
    return table;
}

at::Tensor started(const NetworkWeight& weight, at::Generator& random) {
    const auto normal = [&](at::IntArrayRef shape) {
        return at::empty(shape, at::kDouble).normal_(0, weight.scale, random);
    };
    switch (weight.init) {
        case Init::uniform:
            return at::empty(weight.shape, at::kDouble).uniform_(-weight.scale, weight.scale, random);
        case Init::normal:
            return normal(weight.shape);
        case Init::orthogonal: {
            const auto gauss = at::empty(weight.shape, at::kDouble).normal_(0, 1, random);
            const bool wide = weight.shape[0] < weight.shape[1];
            const auto [q, r] = at::linalg_qr(wide ? gauss.t() : gauss);
            const auto signed_q = q * r.diagonal().sign();
            return (wide ? signed_q.t() : signed_q).contiguous();
        }
        case Init::tiling: {
            const auto half = weight.shape[2] / 2;
            const auto frames = normal({weight.shape[0], half});
            return tiled(frames, normal({weight.shape[1], weight.shape[2] - half}));
        }
        case Init::sinusoids:
            return sinusoid_table(weight.shape);
        case Init::frame_sinusoids:
            return frame_sinusoids(weight.shape[0], weight.shape[1]);
        case Init::person_sinusoids:
            return sinusoids(weight.shape[0], weight.shape[1]);
        case Init::ones:
            return at::ones(weight.shape, at::kDouble);
        case Init::zeros:
            break;
    }
    return at::zeros(weight.shape, at::kDouble);
}

/// The module of a dotted name's last part, made on the way where it is missing, and that part.
std::pair<torch::nn::Module*, std::string> place_of(torch::nn::Module& root, const std::string& name) {
    auto* module = &root;
    std::size_t from = 0;
    for (auto dot = name.find('.'); dot != std::string::npos; dot = name.find('.', from)) {
        const auto part = name.substr(from, dot - from);
        const auto children = module->named_children();
        const auto* known = children.find(part);
        module = known ? known->get()
                       : module->register_module(part, std::make_shared<torch::nn::Module>(part)).get();
        from = dot + 1;
    }
    return {module, name.substr(from)};
}

void iterate_once(const at::Tensor& matrix, at::Tensor& u, at::Tensor& v) {
    const at::NoGradGuard no_gradients;
    v.copy_(unit(matrix.t().mv(u)));
    u.copy_(unit(matrix.mv(v)));
}

}  // namespace

WeightStore::WeightStore(torch::nn::Module& module, const std::vector<NetworkWeight>& weights,
                         std::uint64_t seed, at::ScalarType type) {
    auto random = at::make_generator<at::CPUGeneratorImpl>(seed);
    for (const auto& weight : weights) {
        Entry entry;
        const auto [place, name] = place_of(module, weight.name);
        const auto values = weight.same_as.empty() ? started(weight, random).to(type).contiguous()
                                                   : entries_.at(weight.same_as).weight.detach().clone();
        entry.weight =
            weight.trained ? place->register_parameter(name, values) : place->register_buffer(name, values);
        if (weight.spectral) {
            entry.rows = weight.rows;
            const auto vector = [&](std::int64_t size) {
                return unit(at::empty({size}, at::kDouble).normal_(0, 1, random)).to(type);
            };
            entry.u = place->register_buffer(name + "_u", vector(weight.rows));
            entry.v = place->register_buffer(name + "_v", vector(weight.count() / weight.rows));
            const auto matrix = entry.weight.detach().view({weight.rows, -1});
            for (int i = 0; i < first_iterations; ++i) iterate_once(matrix, entry.u, entry.v);
        }
        entries_[weight.name] = std::move(entry);
    }
}

at::Tensor WeightStore::normalised(const std::string& name, bool iterate) const {
    const auto& entry = entries_.at(name);
    if (entry.rows == 0) return entry.weight;
    if (fused && entry.weight.is_cpu()) return fused_spectral(entry.weight, entry.u, entry.v, iterate);
    const NoAutocast float32;  // a power iteration in bfloat16 finds two digits of the norm
    const auto matrix = entry.weight.view({entry.rows, -1});
    auto u = entry.u, v = entry.v;
    if (iterate) {
        iterate_once(matrix.detach(), u, v);
        // The buffers move on at the next call, perhaps before this one's gradient is taken.
        u = u.clone();
        v = v.clone();
    }
    return entry.weight / at::dot(u, matrix.mv(v));
}

at::Tensor WeightStore::spectral_norm(const std::string& name) const {
    const at::NoGradGuard no_gradients;
    const auto& entry = entries_.at(name);
    return at::dot(entry.u, entry.weight.view({entry.rows, -1}).mv(entry.v));
}

}  // namespace actformer::model
