// A training step by step, here and in eager PyTorch, which is given the same weights, batches and numbers to drop out.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "base/hdf5/writer.hpp"
#include "model/nn/sgd.hpp"
#include "model/recognisers/stgcn_file.hpp"
#include "model/recognisers/stgcn_net.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::test {

struct Lessons {
    at::Tensor x;                      ///< (steps, N, C, T, K) float32
    at::Tensor labels;                 ///< (steps, N) int64
    std::vector<double> rates;         ///< (steps) of learning
    std::vector<std::uint64_t> seeds;  ///< (steps) of dropout
    at::Tensor shown;                  ///< (M, C, T, K) float32, at the end
};

struct Learnt {
    std::vector<double> losses;  ///< one a step, before it
    std::vector<double> logits;  ///< (M, classes) of what is shown at the end, by the running statistics
};

inline Learnt learn(model::StgcnNet& net, const Lessons& lessons) {
    const auto type = net.weight("fcn.weight").scalar_type();
    model::Sgd sgd(net.trained(), {});
    Learnt out;
    for (std::size_t step = 0; step < lessons.rates.size(); ++step) {
        const auto at = static_cast<std::int64_t>(step);
        const auto output = net.train_forward(lessons.x[at].to(type), lessons.seeds[step]);
        const auto loss = at::cross_entropy_loss(output.logits, lessons.labels[at]);
        loss.backward();
        sgd.step(lessons.rates[step]);
        out.losses.push_back(loss.item<double>());
    }
    for (const auto& part : lessons.shown.split(64)) {
        const auto logits = net.eval_forward(part.to(type)).logits.to(at::kDouble).contiguous();
        out.logits.insert(out.logits.end(), logits.data_ptr<double>(),
                          logits.data_ptr<double>() + logits.numel());
    }
    return out;
}

/// The same lessons for a network that begins with the same weights, in eager PyTorch (tests/model/recognisers/training_oracle.py).
/// Nothing, after a failure of the running test, where it does not work.
inline std::optional<Learnt> learn_in_eager_pytorch(const model::StgcnNet& start, const Lessons& lessons) {
    const TempDir dir;
    const auto weights = dir / "start.h5", file = dir / "lessons.h5";
    model::save_stgcn_weights(weights, start.settings(), start.arrays(), {});
    {
        const auto sizes = [](const at::Tensor& t) {
            return hdf5::Shape(t.sizes().begin(), t.sizes().end());
        };
        const auto values = [](const at::Tensor& t) {
            return std::span<const float>(t.data_ptr<float>(), static_cast<std::size_t>(t.numel()));
        };
        const auto steps = lessons.rates.size();
        const auto* labels = lessons.labels.data_ptr<std::int64_t>();
        const std::vector<std::uint32_t> as_written(labels, labels + lessons.labels.numel());
        hdf5::Writer out(file);
        out.write<float>("x", sizes(lessons.x), values(lessons.x));
        out.write<std::uint32_t>("labels", sizes(lessons.labels), as_written);
        out.write<double>("rates", {steps}, lessons.rates);
        out.write<std::uint64_t>("seeds", {steps}, lessons.seeds);
        out.write<float>("shown", sizes(lessons.shown), values(lessons.shown));
        out.finish();
    }
    const bool in_double = start.weight("fcn.weight").scalar_type() == at::kDouble;
    const auto answer = run_command(
        "OMP_NUM_THREADS=1 /usr/bin/python3 " + source("tests/model/recognisers/training_oracle.py") + " " +
        weights.string() + " " + file.string() + (start.fused ? " fused" : " plain") +
        (in_double ? " float64" : " float32"));
    EXPECT_EQ(answer.exit, 0) << answer.output;
    if (answer.exit != 0) return std::nullopt;
    const auto learnt = nlohmann::json::parse(answer.output);
    return Learnt{learnt.at("losses"), learnt.at("logits")};
}

}  // namespace actformer::test
