// A whole training of the recogniser beside eager PyTorch's, given the same random numbers: weights to begin with, batches and what
// is dropped out. What tells the two apart then is rounding alone, which training magnifies: in float64 to a window or none.
//
// usage: compare_training CONFIG.yaml [key=value ...]
// CONFIG and keys are `actformer train recogniser`'s. On one thread; minutes.
#include <fmt/format.h>

#include <cmath>

#include "kernels/error.hpp"
#include "model/blas.hpp"
#include "tests/support/lessons.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;

namespace {

RecogniserSettings settings_from(std::span<char*> arguments) {
    auto config = recogniser_config();
    config.load(arguments[0]);
    for (const std::string assignment : arguments.subspan(1)) config.override_with(assignment);
    const auto settings = recogniser_settings(config);
    if (settings.dropout != 0.5 || settings.momentum != 0.9 || settings.weight_decay != 1e-4 ||
        !settings.nesterov)
        throw Error(
            "dropout, momentum, weight_decay and nesterov: eager PyTorch's part is written for their "
            "presets");
    return settings;
}

void print_losses(const Learnt& ours, const Learnt& theirs, std::uint64_t steps_an_epoch) {
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

void print_confusions(const eval::Confusion& here, const eval::Confusion& there, std::size_t classes) {
    std::uint64_t apart = 0;
    for (std::size_t i = 0; i < classes; ++i)
        for (std::size_t j = 0; j < classes; ++j)
            apart += here.at(i, j) > there.at(i, j) ? here.at(i, j) - there.at(i, j) : 0;
    fmt::print("{:.4f} % of {} windows recognised, in eager PyTorch {:.4f} %; confusions differ in {}\n",
               100 * here.mean_class_accuracy(), here.samples(), 100 * there.mean_class_accuracy(), apart);
}

void compare(Course course) {
    const auto theirs = learn_in_eager_pytorch(course.start, course.lessons);
    if (!theirs) throw std::runtime_error("eager PyTorch failed");
    const auto ours = learn(course.start, course.lessons);
    print_losses(ours, *theirs, course.steps_an_epoch);
    print_confusions(judge(ours, course), judge(*theirs, course), course.start.settings().classes);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        fmt::print(stderr, "usage: compare_training CONFIG.yaml [key=value ...]\n");
        return 2;
    }
    try {
        set_threads(1);
        compare(course_of(settings_from({arguments + 1, arguments + count})));
    } catch (const std::exception& e) {
        fmt::print(stderr, "compare_training: {}\n", e.what());
        return 1;
    }
}
