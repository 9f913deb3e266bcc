// What a training makes of the EMA of CSGN's weights.
#include <gtest/gtest.h>

#include <algorithm>

#include "model/generators/method.hpp"
#include "model/train/learner.hpp"

using namespace actformer;
using namespace actformer::model;

namespace {

const Array& named(const std::vector<Array>& arrays, const std::string& name) {
    return *std::ranges::find(arrays, name, &Array::name);
}

/// Clips of classes 0 and 2 of three, in memory.
kernels::ClipStore two_classes() {
    kernels::ClipTable table{1, 5, 3, {20, 20, 20}, {0, 2, 2}};
    kernels::ClipStore clips(table);
    const std::vector<float> motion(20 * table.frame_values(), 0.5F);
    for (std::size_t c = 0; c < table.clips(); ++c) clips.load(c, motion);
    return clips;
}

/// The EMA after a step of a training whose first gains of class `label` are `gain` times as large.
std::vector<Array> ema_with_gains(std::size_t label, float gain) {
    const auto& method = method_named("csgn", "test");
    auto config = generator_config(method);
    for (const auto* key : {"frames=16", "batch=4", "width=4", "d_width=4", "latent=6", "threads=1",
                            "opencl=none", "average=0.0001"})  // next to nothing stays of older weights
        config.override_with(key);
    MotionSpec spec;
    spec.topology.parents = {-1, 0, 1, 1, 3};
    spec.classes = 3;
    const auto clips = two_classes();
    const Processes alone;
    const auto learner = method.learner(config, spec, {clips, at::kCPU, alone});
    auto state = learner->state();
    for (auto& array : state)
        if (array.name == "generator.norm0.gain") {
            auto& gains = std::get<std::vector<float>>(array.values);
            const auto channels = gains.size() / spec.classes;
            for (std::size_t c = 0; c < channels; ++c) gains[label * channels + c] *= gain;
        }
    learner->load(state, 0, "test");
    learner->step(0, 1);
    return learner->ema_weights();
}

}  // namespace

TEST(CsgnEma, ClassesWithoutAClipHaveNoPartInTheStatistics) {
    const auto usual = ema_with_gains(1, 1);
    const auto statistics = [](const std::vector<Array>& arrays) {
        return named(arrays, "norm1.variance").values;
    };
    EXPECT_EQ(statistics(usual), statistics(ema_with_gains(1, 100)));
    EXPECT_NE(statistics(usual), statistics(ema_with_gains(2, 100))) << "of a class that has clips";
}
