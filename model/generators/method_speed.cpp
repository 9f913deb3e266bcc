#include "model/generators/method_speed.hpp"

#include <chrono>
#include <cmath>
#include <functional>

#include "base/process/usage.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "kernels/sampler.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/generators/method.hpp"
#include "model/nn/blas.hpp"
#include "model/train/learner.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

constexpr std::uint32_t motions_timed = 100, clips_made = 64;

void time_into(Seconds& best, const std::function<void()>& work) {
    using Clock = std::chrono::steady_clock;
    const auto keep = [](double& least, double now) { least = least == 0 ? now : std::min(least, now); };
    const auto start = Clock::now();
    const double before = processor_seconds();
    work();
    keep(best.wall, std::chrono::duration<double>(Clock::now() - start).count());
    keep(best.processors, processor_seconds() - before);
}

Config config_of(const MethodSpeedRequest& request) {
    auto config = generator_config(method_named(request.method, "--method"));
    config.override_with("frames=" + std::to_string(request.frames));
    config.override_with("batch=" + std::to_string(request.batch));
    for (const auto& assignment : request.overrides) config.override_with(assignment);
    return config;
}

MotionSpec timed_spec(const MethodSpeedRequest& request) {
    const auto& tree = ingest::ntu25();
    return {ingest::Representation::limb,    tree, request.persons, request.classes, "speed",
            ingest::usual_bone_lengths(tree)};
}

/// Of libtorch, as a training takes it.
at::Device device_of(const Config& config) {
    const auto settings = generator_trainer_settings(config);
    const auto device = torch_device(settings.device);
    set_tf32_and_determinism(settings, device);
    return device;
}

/// Clips of smooth numbers, of every class in turn.
kernels::ClipStore clips_of(const MethodSpeedRequest& request, const MotionSpec& spec,
                            kernels::Device& device) {
    std::vector<std::uint32_t> labels;
    for (std::uint32_t i = 0; i < clips_made; ++i) labels.push_back(i % request.classes);
    kernels::ClipStore clips(device, {request.persons, spec.nodes(), spec.numbers(),
                                      std::vector<std::uint32_t>(clips_made, request.frames), labels});
    for (std::uint32_t i = 0; i < clips_made; ++i) {
        std::vector<float> values(request.frames * clips.table().frame_values());
        for (std::size_t v = 0; v < values.size(); ++v)
            values[v] = std::sin(0.1F * static_cast<float>(v + i));
        clips.load(i, values);
    }
    return clips;
}

}  // namespace

struct MethodSpeed::Parts {
    MethodSpeedRequest request;
    const Method& method;
    Config config;
    MotionSpec spec;
    at::Device torch;
    kernels::Device device;
    kernels::ClipStore clips;
    Processes processes;
    std::unique_ptr<Learner> learner;
    std::unique_ptr<Maker> maker;
    std::uint64_t steps = 0;
    Seconds step, generation;
    std::string machine;

    explicit Parts(const MethodSpeedRequest& wanted)
        : request(wanted),
          method(method_named(wanted.method, "--method")),
          config(config_of(wanted)),
          spec(timed_spec(wanted)),
          torch(device_of(config)),
          clips(clips_of(wanted, spec, device)),
          learner(method.learner(config, spec, {clips, torch, processes})),
          maker(method.maker(config, spec, learner->weights(), torch.str())),
          machine(check_blas().line) {}

    /// The device may still be at work when a step returns: reading the sums waits for it.
    void take_step() {
        learner->step(steps++, 1);
        learner->sums().to(at::kCPU);
    }

    void generate() {
        for (std::uint32_t i = 0; i * maker->batch() < motions_timed; ++i)
            maker->make(1, static_cast<std::uint32_t>(steps % request.classes), i, request.frames);
    }
};

MethodSpeed::MethodSpeed(const MethodSpeedRequest& request) {
    set_threads(request.threads);
    parts_ = std::make_unique<Parts>(request);
    parts_->take_step();  // what is made once is made
    parts_->generate();
}

MethodSpeed::~MethodSpeed() = default;

void MethodSpeed::run(int rounds) {
    auto& p = *parts_;
    for (int i = 0; i < rounds; ++i) {
        time_into(p.step, [&] { p.take_step(); });
        time_into(p.generation, [&] { p.generate(); });
    }
}

const Seconds& MethodSpeed::step() const {
    return parts_->step;
}

const Seconds& MethodSpeed::generation() const {
    return parts_->generation;
}

const std::string& MethodSpeed::machine() const {
    return parts_->machine;
}

std::string MethodSpeed::device() const {
    return parts_->torch.str();
}

}  // namespace actformer::model
