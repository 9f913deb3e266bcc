#include "model/generators/train_generator.hpp"

#include <memory>

#include "base/error.hpp"
#include "eval/metrics/confusion.hpp"
#include "model/generators/generator_file.hpp"
#include "model/generators/generator_validator.hpp"
#include "model/nn/blas.hpp"
#include "model/nn/one_line.hpp"
#include "model/train/torch_device.hpp"
#include "model/train/trainer.hpp"
#include "model/train/training_data.hpp"

namespace actformer::model {
namespace {

/// The GPU that belongs to this process; else the device as it is asked for.
std::string device_for(const TrainerSettings& settings, const Place& place) {
    return settings.device == "cuda" && place.size > 1 ? fmt::format("cuda:{}", place.local)
                                                       : settings.device;
}

TrainingResult train_here(const Config& config, const std::filesystem::path& run, bool data_parallel,
                          const TrainingEvents& events) {
    const auto settings = generator_trainer_settings(config);
    const auto& method = method_named(config.model(), "configuration");
    const auto dataset = dataset_to_train_on(settings.data);
    check_split(dataset, "train_split", settings.train_split);
    const auto subjects = ingest::subjects_of(dataset);
    const auto spec = spec_of(subjects, dataset.folder().string());
    method.networks(config, spec);  // what cannot be built is refused before the clips are loaded
    const auto place = data_parallel ? place_of(environment) : Place{};
    const auto device_name = device_for(settings, place);
    const auto device = torch_device(device_name);
    set_tf32_and_determinism(settings, device);
    const auto processes =
        data_parallel ? std::make_unique<Processes>(place, device) : std::make_unique<Processes>();
    auto opencl = device_that_draws(settings.opencl, place.local, place.leads() ? events.note : nullptr);
    const auto clips = view_to_draw(opencl, dataset, settings.train_split).store;
    const LearnerSetup setup{clips, device, *processes};
    const auto learner = method.learner(config, spec, setup);
    if (place.leads())
        tell_split(dataset, settings, clips.table().clips(),
                   learner->windows_a_step() * static_cast<std::uint64_t>(place.size),
                   settings.recogniser.empty()
                       ? "no recogniser scores it, so no accuracy and no new weights-best.h5 (recogniser=RUN "
                         "names one)"
                       : fmt::format("scored against split {}", settings.train_split),
                   events.note);
    std::unique_ptr<GeneratorValidator> validator;
    if (place.leads() && !settings.recogniser.empty()) {
        validator = std::make_unique<GeneratorValidator>(config, spec, dataset, clips, device_name, *learner);
        const auto accuracy = validator->metrics().real_accuracy();
        if (events.note)
            events.note(fmt::format("the recogniser knows {:.1f} % of the {} real windows of split {}",
                                    100 * accuracy, validator->metrics().real_windows(),
                                    settings.train_split));
        if (const auto warning = eval::near_chance(accuracy, subjects.classes.size());
            events.note && !warning.empty())
            events.note("warning: " + warning);
    }
    const TrainingTask task{method.name, config, settings, dataset,
                            [&](const auto& path, const auto& weights, const auto& notes) {
                                save_generator(path, weights, config, subjects, notes);
                            }};
    return train(task, *learner, setup, validator.get(), run, events);
}

}  // namespace

TrainingResult train_generator(const Config& config, const std::filesystem::path& run, bool data_parallel,
                               const TrainingEvents& events) {
    set_threads(generator_trainer_settings(config).threads);
    const auto blas = check_blas().line;
    if (events.note && (!data_parallel || place_of(environment).leads())) events.note(blas);
    try {
        return train_here(config, run, data_parallel, events);
    } catch (const c10::Error& e) {
        throw Error("libtorch: {}; a smaller batch helps where memory ran out", one_line(e));
    }
}

}  // namespace actformer::model
