#include "model/generators/method_speed.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "base/process/usage.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "kernels/sampler.hpp"
#include "model/cpu/layer_clock.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/generators/method.hpp"
#include "model/nn/blas.hpp"
#include "model/nn/cuda_graph.hpp"
#include "model/train/learner.hpp"
#include "model/train/torch_device.hpp"
#include "model/train/training_data.hpp"

namespace actformer::model {
namespace {

constexpr std::uint32_t motions_timed = 100, clips_made = 64;

/// Times `work`, with its layers where it runs `on_processors`, and keeps what is the least so far.
void time_into(WorkTime& best, const std::function<void()>& work, bool on_processors) {
    using Clock = std::chrono::steady_clock;
    std::vector<LayerTime> layers;
    if (on_processors)
        listen_to_layers([&](const std::string& layer, bool backward, double seconds) {
            auto found = std::ranges::find(layers, layer, &LayerTime::layer);
            if (found == layers.end()) found = layers.insert(found, LayerTime{layer});
            (backward ? found->backward : found->forward) += 1e3 * seconds;
        });
    const auto start = Clock::now();
    const double before = processor_seconds();
    work();
    const double wall = std::chrono::duration<double>(Clock::now() - start).count();
    const double processors = processor_seconds() - before;
    listen_to_layers({});
    if (best.wall == 0 || wall < best.wall) {
        best.wall = wall;
        best.layers = std::move(layers);
    }
    best.processors = best.processors == 0 ? processors : std::min(best.processors, processors);
}

Config config_of(const MethodSpeedRequest& request) {
    auto config = generator_config(method_named(request.method, "--method"));
    config.override_with("frames=" + std::to_string(request.frames));
    config.override_with("batch=" + std::to_string(request.batch));
    for (const auto& assignment : request.overrides) config.override_with(assignment);
    return config;
}

MethodSpeedRequest with_sizes_of(const Config& config, MethodSpeedRequest request) {
    request.frames = static_cast<std::uint32_t>(config.get<std::int64_t>("frames"));
    request.batch = static_cast<std::uint32_t>(config.get<std::int64_t>("batch"));
    return request;
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

/// Clips of smooth numbers, of every class in turn; on the device that draws, where there is one.
kernels::ClipStore clips_of(const MethodSpeedRequest& request, const MotionSpec& spec,
                            std::optional<kernels::Device>& device) {
    std::vector<std::uint32_t> labels;
    for (std::uint32_t i = 0; i < clips_made; ++i) labels.push_back(i % request.classes);
    const kernels::ClipTable table{request.persons, spec.nodes(), spec.numbers(),
                                   std::vector<std::uint32_t>(clips_made, request.frames), labels};
    auto clips = device ? kernels::ClipStore(*device, table) : kernels::ClipStore(table);
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
    const Method& method;
    Config config;
    MethodSpeedRequest request;
    MotionSpec spec;
    at::Device torch;
    std::optional<kernels::Device> opencl;
    kernels::ClipStore clips;
    Processes processes;
    std::unique_ptr<Learner> learner;
    std::unique_ptr<Maker> maker;
    std::vector<Phase> works;  ///< a name and what is timed under it
    std::vector<WorkTime> times;
    std::uint64_t round = 0;  ///< steps follow one another, as their windows are drawn ahead
    std::string machine;

    explicit Parts(const MethodSpeedRequest& wanted)
        : method(method_named(wanted.method, "--method")),
          config(config_of(wanted)),
          request(with_sizes_of(config, wanted)),
          spec(timed_spec(request)),
          torch(device_of(config)),
          opencl(device_that_draws(generator_trainer_settings(config).opencl, 0, nullptr)),
          clips(clips_of(request, spec, opencl)),
          learner(method.learner(config, spec, {clips, torch, processes})),
          maker(method.maker(config, spec, learner->weights(), torch.str())),
          machine(check_blas().line) {
        if (request.by_phase) works = learner->phases();
        if (works.empty()) works.push_back({"step", [this](auto n) { learner->step(n, 1); }});
        works.push_back({std::to_string(motions_timed) + " motions", [this](auto n) { generate(n); }});
        for (const auto& work : works) times.push_back({work.name});
    }

    /// The device may still be at work when a step returns: reading the sums waits for it.
    void run(const Phase& work) {
        work.run(round);
        learner->sums().to(at::kCPU);
    }

    void generate(std::uint64_t n) {
        for (std::uint32_t i = 0; i * maker->batch() < motions_timed; ++i)
            maker->make(1, static_cast<std::uint32_t>(n % request.classes), i, request.frames);
    }
};

MethodSpeed::MethodSpeed(const MethodSpeedRequest& request) {
    set_threads(request.threads);
    parts_ = std::make_unique<Parts>(request);
    // What is made once is made, CUDA's graphs last.
    for (int i = parts_->torch.is_cpu() ? 1 : CudaGraph::warmup_calls + 1; i > 0; --i, ++parts_->round)
        for (const auto& work : parts_->works) parts_->run(work);
}

MethodSpeed::~MethodSpeed() = default;

void MethodSpeed::run(int rounds) {
    auto& p = *parts_;
    for (int i = 0; i < rounds; ++i, ++p.round) {
        for (std::size_t w = 0; w < p.works.size(); ++w)
            time_into(
                p.times[w], [&] { p.run(p.works[w]); }, p.torch.is_cpu());
    }
}

const std::vector<WorkTime>& MethodSpeed::times() const {
    return parts_->times;
}

const MethodSpeedRequest& MethodSpeed::request() const {
    return parts_->request;
}

const std::string& MethodSpeed::machine() const {
    return parts_->machine;
}

std::string MethodSpeed::device() const {
    return parts_->torch.str();
}

}  // namespace actformer::model
