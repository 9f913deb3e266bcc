#include "model/generators/actformer/speed.hpp"

#include <algorithm>
#include <chrono>
#include <functional>

#include "model/cpu/layer_clock.hpp"
#include "model/generators/actformer/discriminator.hpp"
#include "model/generators/actformer/generator.hpp"
#include "model/generators/adversarial/gan.hpp"
#include "model/generators/adversarial/maker.hpp"
#include "model/nn/blas.hpp"

namespace actformer::model {
namespace {

constexpr std::uint32_t motions_timed = 100;

/// Times `work`, layer by layer, and keeps it where it is the fastest so far.
void time_into(StepTime& best, const std::function<void()>& work) {
    using Clock = std::chrono::steady_clock;
    StepTime now;
    listen_to_layers([&](const std::string& layer, bool backward, double seconds) {
        auto found = std::ranges::find(now.layers, layer, &LayerTime::layer);
        if (found == now.layers.end()) found = now.layers.insert(found, LayerTime{layer});
        (backward ? found->backward : found->forward) += 1e3 * seconds;
    });
    const auto start = Clock::now();
    work();
    now.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    listen_to_layers({});
    if (best.seconds == 0 || now.seconds < best.seconds) best = now;
}

}  // namespace

struct SpeedTest::Parts {
    SpeedRequest request;
    Processes processes;
    GeneratorSettings generator;
    DiscriminatorSettings discriminator;
    Gan gan;
    MotionMaker maker;
    at::Tensor real, labels;
    std::uint64_t draw = 0;
    StepTime discriminator_step, generator_step, generation;
    std::string machine;

    explicit Parts(const SpeedRequest& wanted);
};

namespace {

MotionSpec motions_of(const SpeedRequest& request) {
    return {ingest::Representation::limb, ingest::ntu25(), request.persons, request.classes, "speed"};
}

Config presets() {
    return {"actformer", network_keys()};
}

GanSettings settings_of(const SpeedRequest& request) {
    GanSettings settings;
    settings.frames = request.frames;
    return settings;
}

}  // namespace

SpeedTest::Parts::Parts(const SpeedRequest& wanted)
    : request(wanted),
      generator(generator_settings(presets(), motions_of(wanted))),
      discriminator(discriminator_settings(presets(), motions_of(wanted))),
      gan(settings_of(wanted),
          gan_networks<Generator, Discriminator>(settings_of(wanted), generator, discriminator, at::kCPU),
          at::kCPU, processes),
      maker(gan.generator(), 0),
      real(at::randn({wanted.batch, generator.numbers() * wanted.persons, wanted.frames, generator.nodes()})),
      labels(at::randint(wanted.classes, {wanted.batch}, at::kLong)) {}

SpeedTest::SpeedTest(const SpeedRequest& request) {
    set_threads(request.threads);
    parts_ = std::make_unique<Parts>(request);
    parts_->machine = check_blas().line;
    parts_->gan.step_discriminator(parts_->real, parts_->labels,
                                   parts_->draw++);  // what is made once is made
    parts_->gan.step_generator(parts_->real, parts_->labels, parts_->draw++);
}

SpeedTest::~SpeedTest() = default;

void SpeedTest::run(int rounds) {
    auto& p = *parts_;
    for (int i = 0; i < rounds; ++i) {
        time_into(p.discriminator_step, [&] { p.gan.step_discriminator(p.real, p.labels, p.draw++); });
        time_into(p.generator_step, [&] { p.gan.step_generator(p.real, p.labels, p.draw++); });
        time_into(p.generation, [&] {
            for (std::uint32_t n = 0; n < motions_timed / MotionMaker::chunk; ++n)
                p.maker.make(static_cast<std::uint32_t>(p.draw++ % p.request.classes), n, p.request.frames);
        });
    }
}

const StepTime& SpeedTest::discriminator_step() const {
    return parts_->discriminator_step;
}

const StepTime& SpeedTest::generator_step() const {
    return parts_->generator_step;
}

const StepTime& SpeedTest::generation() const {
    return parts_->generation;
}

const std::string& SpeedTest::machine() const {
    return parts_->machine;
}

}  // namespace actformer::model
