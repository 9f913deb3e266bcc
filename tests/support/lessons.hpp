// A training step by step, here and in eager PyTorch, which is given the same weights, batches and numbers to drop out.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "eval/confusion.hpp"
#include "eval/view.hpp"
#include "ingest/hdf5/writer.hpp"
#include "model/recogniser_settings.hpp"
#include "model/sgd.hpp"
#include "model/stgcn_net.hpp"
#include "model/training.hpp"
#include "model/weights_file.hpp"
#include "model/window_feed.hpp"
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

/// What `train recogniser` goes through under some settings.
struct Course {
    model::StgcnNet start;
    Lessons lessons;    ///< all steps; shown are the test split's consecutive windows
    at::Tensor labels;  ///< (M) of what is shown
    std::size_t steps_an_epoch;
};

/// A copy: a feed's own memory is good for one batch.
inline at::Tensor copied(const model::Windows& windows, const kernels::ClipTable& table,
                         std::uint32_t frames) {
    return model::values_of(windows, table.persons * table.channels, frames, table.joints, at::kCPU).clone();
}

inline void draw(const kernels::ClipStore& clips, const model::RecogniserSettings& settings, Course& course) {
    model::RandomFeed feed(clips, {settings.seed, kernels::ClassSampling::plain, true}, settings.batch,
                           settings.frames);
    std::vector<at::Tensor> x, labels;
    for (std::uint64_t step = 0; step < settings.epochs * course.steps_an_epoch; ++step) {
        const auto windows = feed.batch(step);
        x.push_back(copied(windows, clips.table(), settings.frames));
        labels.push_back(model::labels_of(windows, at::kCPU));
        course.lessons.rates.push_back(settings.rate_at(step / course.steps_an_epoch));
        course.lessons.seeds.push_back(model::step_seed(settings.seed, step));
    }
    course.lessons.x = at::stack(x);
    course.lessons.labels = at::stack(labels);
}

inline void show(const kernels::ClipStore& clips, const model::RecogniserSettings& settings, Course& course) {
    std::vector<at::Tensor> windows, labels;
    model::for_each_window(clips, settings.batch, settings.frames, [&](const model::Windows& part) {
        windows.push_back(copied(part, clips.table(), settings.frames));
        labels.push_back(model::labels_of(part, at::kCPU));
    });
    course.lessons.shown = at::cat(windows);
    course.labels = at::cat(labels);
}

inline Course course_of(const model::RecogniserSettings& settings) {
    const auto dataset = model::dataset_to_train_on(settings.data);
    const auto& header = dataset.header();
    const auto shape = model::network_for(settings, header.topology, header.persons, header.classes.size(),
                                          dataset.folder().string());
    kernels::Device device(settings.opencl);
    const auto clips = eval::load_view(device, dataset, settings.train_split);
    Course course{{shape, settings.seed, at::kCPU, model::torch_type(settings.precision)},
                  {},
                  {},
                  (clips.clips.size() + settings.batch - 1) / settings.batch};
    draw(clips.store, settings, course);
    show(eval::load_view(device, dataset, settings.test_split).store, settings, course);
    return course;
}

/// How the windows shown at the end are taken.
inline eval::Confusion judge(const Learnt& learnt, const Course& course) {
    const auto classes = course.start.settings().classes;
    eval::Confusion confusion(classes);
    const auto guesses = at::tensor(learnt.logits).view({-1, classes}).argmax(1);
    for (std::int64_t i = 0; i < course.labels.numel(); ++i)
        confusion.add(static_cast<std::size_t>(course.labels[i].item<std::int64_t>()),
                      static_cast<std::size_t>(guesses[i].item<std::int64_t>()));
    return confusion;
}

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

/// The same lessons for a network that begins with the same weights, in eager PyTorch (tests/model/training_oracle.py).
/// Nothing, after a failure of the running test, where it does not work.
inline std::optional<Learnt> learn_in_eager_pytorch(const model::StgcnNet& start, const Lessons& lessons) {
    const TempDir dir;
    const auto weights = dir / "start.h5", file = dir / "lessons.h5";
    model::save_weights(weights, start.settings(), start.arrays(), {});
    {
        const auto sizes = [](const at::Tensor& t) {
            return ingest::hdf5::Shape(t.sizes().begin(), t.sizes().end());
        };
        const auto values = [](const at::Tensor& t) {
            return std::span<const float>(t.data_ptr<float>(), static_cast<std::size_t>(t.numel()));
        };
        const auto steps = lessons.rates.size();
        const auto* labels = lessons.labels.data_ptr<std::int64_t>();
        const std::vector<std::uint32_t> as_written(labels, labels + lessons.labels.numel());
        ingest::hdf5::Writer out(file);
        out.write<float>("x", sizes(lessons.x), values(lessons.x));
        out.write<std::uint32_t>("labels", sizes(lessons.labels), as_written);
        out.write<double>("rates", {steps}, lessons.rates);
        out.write<std::uint64_t>("seeds", {steps}, lessons.seeds);
        out.write<float>("shown", sizes(lessons.shown), values(lessons.shown));
        EXPECT_TRUE(out.finish());
    }
    const bool in_double = start.weight("fcn.weight").scalar_type() == at::kDouble;
    const auto answer =
        run_command("OMP_NUM_THREADS=1 /usr/bin/python3 " + source("tests/model/training_oracle.py") + " " +
                    weights.string() + " " + file.string() + (start.fused ? " fused" : " plain") +
                    (in_double ? " float64" : " float32"));
    EXPECT_EQ(answer.exit, 0) << answer.output;
    if (answer.exit != 0) return std::nullopt;
    const auto learnt = nlohmann::json::parse(answer.output);
    return Learnt{learnt.at("losses"), learnt.at("logits")};
}

}  // namespace actformer::test
