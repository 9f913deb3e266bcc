// A whole training of the recogniser beside eager PyTorch's, given the same random numbers: weights to begin with, batches and what
// is dropped out. What tells the two apart then is rounding alone, which training magnifies: in double to a window or none.
//
// usage: compare_training DATASET TRAIN_SPLIT TEST_SPLIT [SEED [double|float]]
// The training is that of recogniser_accuracy.py: a quarter of the width, 14 epochs of windows of 60 frames. On one thread; minutes.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "eval/confusion.hpp"
#include "eval/view.hpp"
#include "model/blas.hpp"
#include "model/recogniser_settings.hpp"
#include "model/training.hpp"
#include "model/window_feed.hpp"
#include "tests/support/lessons.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;

namespace {

RecogniserSettings usual_settings(std::uint64_t seed) {
    RecogniserSettings settings;
    settings.width = 0.25;
    settings.frames = 60;
    settings.batch = 64;
    settings.epochs = 14;
    settings.rate = 0.1;
    settings.rate_drops = {9, 12};
    settings.seed = seed;
    return settings;
}

/// A split's windows, and the classes they show.
struct Shown {
    at::Tensor windows, labels;
};

/// A copy: a feed's own memory is good for one batch.
Shown copied(const Windows& windows, const kernels::ClipTable& table, std::uint32_t frames) {
    return {values_of(windows, table.persons * table.channels, frames, table.joints, at::kCPU).clone(),
            labels_of(windows, at::kCPU).clone()};
}

Shown every_window(const kernels::ClipStore& clips, const RecogniserSettings& settings) {
    std::vector<at::Tensor> windows, labels;
    for_each_window(clips, settings.batch, settings.frames, [&](const Windows& part) {
        const auto shown = copied(part, clips.table(), settings.frames);
        windows.push_back(shown.windows);
        labels.push_back(shown.labels);
    });
    return {at::cat(windows), at::cat(labels)};
}

/// All that `train recogniser` would draw under these settings.
Lessons lessons_of(const kernels::ClipStore& clips, const RecogniserSettings& settings,
                   std::uint64_t steps_an_epoch) {
    RandomFeed feed(clips, {settings.seed, kernels::ClassSampling::plain, true}, settings.batch,
                    settings.frames);
    Lessons lessons;
    std::vector<at::Tensor> x, labels;
    for (std::uint64_t step = 0; step < settings.epochs * steps_an_epoch; ++step) {
        const auto drawn = copied(feed.batch(step), clips.table(), settings.frames);
        x.push_back(drawn.windows);
        labels.push_back(drawn.labels);
        lessons.rates.push_back(settings.rate_at(step / steps_an_epoch));
        lessons.seeds.push_back(step_seed(settings.seed, step));
    }
    lessons.x = at::stack(x);
    lessons.labels = at::stack(labels);
    return lessons;
}

eval::Confusion judge(const Learnt& learnt, const at::Tensor& labels, std::size_t classes) {
    eval::Confusion confusion(classes);
    const auto guesses = at::tensor(learnt.logits).view({labels.numel(), -1}).argmax(1);
    for (std::int64_t i = 0; i < labels.numel(); ++i)
        confusion.add(static_cast<std::size_t>(labels[i].item<std::int64_t>()),
                      static_cast<std::size_t>(guesses[i].item<std::int64_t>()));
    return confusion;
}

void print(const Learnt& ours, const Learnt& theirs, std::uint64_t steps_an_epoch) {
    fmt::print("epoch  loss here  eager PyTorch  differs by at most\n");
    for (std::size_t first = 0; first < ours.losses.size(); first += steps_an_epoch) {
        double sums[2]{}, most = 0;
        for (auto i = first; i < first + steps_an_epoch; ++i) {
            sums[0] += ours.losses[i];
            sums[1] += theirs.losses[i];
            most = std::max(most, std::abs(ours.losses[i] / theirs.losses[i] - 1));
        }
        const auto steps = static_cast<double>(steps_an_epoch);
        fmt::print("{:5}  {:9.5f}  {:13.5f}  {:.1e} of a step's\n", first / steps_an_epoch + 1,
                   sums[0] / steps, sums[1] / steps, most);
    }
}

void compare(const std::string& folder, const std::string& train, const std::string& test, std::uint64_t seed,
             at::ScalarType type) {
    const auto settings = usual_settings(seed);
    const ingest::Dataset dataset(folder);
    const auto& header = dataset.header();
    const auto shape = network_for(settings, header.topology, header.persons, header.classes.size(), folder);
    kernels::Device device;
    const auto clips = eval::load_view(device, dataset, train);
    const auto steps = (clips.clips.size() + settings.batch - 1) / settings.batch;
    auto lessons = lessons_of(clips.store, settings, steps);
    const auto shown = every_window(eval::load_view(device, dataset, test).store, settings);
    lessons.shown = shown.windows;

    StgcnNet net(shape, seed, at::kCPU, type);
    const auto theirs = learn_in_eager_pytorch(net, lessons);
    if (!theirs) throw std::runtime_error("eager PyTorch failed");
    const auto ours = learn(net, lessons);
    print(ours, *theirs, steps);
    const auto here = judge(ours, shown.labels, shape.classes),
               there = judge(*theirs, shown.labels, shape.classes);
    std::uint64_t apart = 0;
    for (std::size_t i = 0; i < shape.classes; ++i)
        for (std::size_t j = 0; j < shape.classes; ++j)
            apart += here.at(i, j) > there.at(i, j) ? here.at(i, j) - there.at(i, j) : 0;
    fmt::print("{:.4f} % of {} windows recognised, in eager PyTorch {:.4f} %; confusions differ in {}\n",
               100 * here.mean_class_accuracy(), here.samples(), 100 * there.mean_class_accuracy(), apart);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 4) {
        fmt::print(stderr, "usage: compare_training DATASET TRAIN_SPLIT TEST_SPLIT [SEED [double|float]]\n");
        return 2;
    }
    try {
        set_threads(1);
        compare(arguments[1], arguments[2], arguments[3], count > 4 ? std::stoull(arguments[4]) : 1,
                count > 5 && std::strcmp(arguments[5], "float") == 0 ? at::kFloat : at::kDouble);
    } catch (const std::exception& e) {
        fmt::print(stderr, "compare_training: {}\n", e.what());
        return 1;
    }
}
