// What `train recogniser` goes through from its first step to its last, for eager PyTorch to go through too.
#pragma once

#include "eval/metrics/confusion.hpp"
#include "ingest/dataset/view.hpp"
#include "model/recognisers/recogniser_settings.hpp"
#include "model/train/step_seed.hpp"
#include "model/train/torch_device.hpp"
#include "model/train/training_data.hpp"
#include "model/train/window_feed.hpp"
#include "model/train/window_tensors.hpp"
#include "tests/support/lessons.hpp"

namespace actformer::test {

struct Course {
    model::StgcnNet start;
    Lessons lessons;    ///< all steps; shown are the test split's consecutive windows
    at::Tensor labels;  ///< (M) of what is shown
    std::size_t steps_an_epoch;
};

/// A copy: a feed's own memory is good for one batch.
inline at::Tensor copied(const model::Windows& windows, const kernels::ClipTable& table,
                         std::uint32_t frames) {
    return model::values_of(windows, table.persons * table.numbers, frames, table.nodes, at::kCPU).clone();
}

inline void draw(const kernels::ClipStore& clips, const model::RecogniserSettings& settings, Course& course) {
    model::RandomFeed feed(clips, {settings.seed, kernels::ClassSampling::plain, true}, settings.batch,
                           settings.frames);
    std::vector<at::Tensor> x, labels;
    for (std::uint64_t step = 0; step < settings.epochs * course.steps_an_epoch; ++step) {
        const auto windows = feed.batch(step);
        x.push_back(copied(windows, clips.table(), settings.frames));
        labels.push_back(model::labels_of(windows, at::kCPU));
        course.lessons.rates.push_back(settings.rate * settings.rate_share(step / course.steps_an_epoch));
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
    const auto shape = model::stgcn_for(settings, header.representation, header.topology, header.persons,
                                        header.classes.size(), dataset.folder().string());
    kernels::Device device(settings.opencl);
    const auto clips = ingest::load_view(device, dataset, settings.train_split);
    Course course{{shape, settings.seed, at::kCPU, model::torch_type(settings.precision)},
                  {},
                  {},
                  (clips.clips.size() + settings.batch - 1) / settings.batch};
    draw(clips.store, settings, course);
    show(ingest::load_view(device, dataset, settings.test_split).store, settings, course);
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

/// Of every `count` numbers.
inline std::vector<double> means(const std::vector<double>& numbers, std::size_t count) {
    std::vector<double> out(numbers.size() / count);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        out.at(i / count) += numbers[i] / static_cast<double>(count);
    return out;
}

}  // namespace actformer::test
