// A whole training of the recogniser beside eager PyTorch's, given the same random numbers: weights to begin with, batches and what
// is dropped out. What tells the two apart then is rounding alone, which training magnifies: in float64 to a window or two.
//
// usage: compare_training CONFIG.yaml [key=value ...]
// CONFIG and keys are `actformer train recogniser`'s. On one thread; minutes.
#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "model/recognisers/train_recogniser.hpp"
#include "tests/support/course.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;

namespace {

struct Outcome {
    std::vector<double> losses;  ///< means of the epochs
    eval::Confusion confusion;   ///< of the test split, at the end
};

Config config_from(std::span<char*> arguments) {
    auto config = recogniser_config();
    config.load(arguments[0]);
    for (const std::string assignment : arguments.subspan(1)) config.override_with(assignment);
    config.override_with("threads=1");
    const auto settings = recogniser_settings(config);
    if (settings.dropout != 0.5 || settings.momentum != 0.9 || settings.weight_decay != 1e-4 ||
        !settings.nesterov)
        throw Error(
            "dropout, momentum, weight_decay and nesterov: eager PyTorch's part knows their presets alone");
    if (settings.test_split.empty()) throw Error("test_split: give one to score on");
    return config;
}

Outcome train_here(const Config& config) {
    const TempDir folder;
    Outcome outcome{{}, eval::Confusion(0)};
    TrainingEvents events;
    events.epoch = [&](const EpochReport& report) {
        outcome.losses.push_back(value_of(report.losses, "loss"));
    };
    outcome.confusion = train_recogniser(config, folder / "run", events).confusion;
    return outcome;
}

Outcome train_in_eager_pytorch(const Config& config) {
    const auto course = course_of(recogniser_settings(config));
    const auto learnt = learn_in_eager_pytorch(course.start, course.lessons);
    if (!learnt) throw std::runtime_error("eager PyTorch failed");
    return {means(learnt->losses, course.steps_an_epoch), judge(*learnt, course)};
}

void print(const Outcome& here, const Outcome& there) {
    fmt::print("epoch  loss here  eager PyTorch\n");
    for (std::size_t i = 0; i < here.losses.size(); ++i)
        fmt::print("{:5}  {:9.5f}  {:13.5f}, {:.1e} of it apart\n", i + 1, here.losses[i], there.losses[i],
                   std::abs(here.losses[i] / there.losses[i] - 1));
    std::uint64_t apart = 0;
    const auto &ours = here.confusion, &theirs = there.confusion;
    for (std::size_t i = 0; i < ours.classes(); ++i)
        for (std::size_t j = 0; j < ours.classes(); ++j)
            apart += ours.at(i, j) > theirs.at(i, j) ? ours.at(i, j) - theirs.at(i, j) : 0;
    fmt::print("{:.4f} % of {} windows recognised, in eager PyTorch {:.4f} %; confusions differ in {}\n",
               100 * ours.mean_class_accuracy(), ours.samples(), 100 * theirs.mean_class_accuracy(), apart);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        fmt::print(stderr, "usage: compare_training CONFIG.yaml [key=value ...]\n");
        return 2;
    }
    try {
        const auto config = config_from({arguments + 1, arguments + count});
        const auto here = train_here(config);
        print(here, train_in_eager_pytorch(config));
    } catch (const std::exception& e) {
        fmt::print(stderr, "compare_training: {}\n", e.what());
        return 1;
    }
}
