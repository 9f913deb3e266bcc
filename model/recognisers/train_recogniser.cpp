#include "model/recognisers/train_recogniser.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "base/text/first_few.hpp"
#include "ingest/dataset/view.hpp"
#include "model/nn/blas.hpp"
#include "model/nn/one_line.hpp"
#include "model/recognisers/learner.hpp"
#include "model/recognisers/stgcn_file.hpp"
#include "model/train/torch_device.hpp"
#include "model/train/trainer.hpp"
#include "model/train/training_data.hpp"

namespace actformer::model {
namespace {

using SaveWeights = std::function<void(const std::filesystem::path&, const std::vector<Array>&,
                                       const std::map<std::string, std::string>&)>;

/// A class that is never seen in training is never recognised: worth a line before hours of it.
std::string missing_classes(const kernels::ClipStore& clips, const std::vector<std::string>& classes,
                            const std::string& split) {
    std::vector<std::size_t> counts(classes.size(), 0);
    for (const auto label : clips.table().labels) ++counts[label];
    std::vector<std::string> missing;
    for (std::size_t c = 0; c < counts.size(); ++c)
        if (counts[c] == 0) missing.push_back(classes[c]);
    if (missing.empty()) return {};
    return fmt::format("split {} has no clip of {} of the {} classes, which will not be recognised: {}",
                       split, missing.size(), counts.size(), few_and_more(missing, 8));
}

/// A network to train, and how its weights are saved.
struct Trainee {
    std::unique_ptr<RecogniserNetwork> network;
    SaveWeights save;
};

Trainee trainee_for(const RecogniserSettings& settings, const ingest::Dataset& dataset,
                    const at::Device& device) {
    const auto& header = dataset.header();
    const auto joints = settings.joints_seen();
    const auto network_of = [&](const auto& make) {
        return make(settings, ingest::representation_of(dataset, joints),
                    ingest::topology_of(dataset, joints), header.persons, header.classes.size(),
                    dataset.folder().string());
    };
    if (settings.kind == RecogniserKind::gru) {
        const auto network = network_of(gru_for);
        return {
            gru_network(settings, network, device),
            [network, classes = header.classes](const auto& path, const auto& weights, const auto& notes) {
                save_gru_weights(path, network, weights, notes, classes);
            }};
    }
    const auto network = network_of(stgcn_for);
    return {stgcn_network(settings, network, device),
            [network, classes = header.classes](const auto& path, const auto& weights, const auto& notes) {
                save_stgcn_weights(path, network, weights, notes, classes);
            }};
}

RecogniserResult train_here(const Config& config, const std::filesystem::path& run,
                            const TrainingEvents& events) {
    const auto settings = recogniser_settings(config);
    const auto dataset = dataset_to_train_on(settings.data);
    check_split(dataset, "train_split", settings.train_split);
    if (!settings.test_split.empty()) check_split(dataset, "test_split", settings.test_split);
    const auto& header = dataset.header();
    eval::check_class_count(header.classes.size(), dataset.folder().string());
    const auto joints = settings.joints_seen();
    auto trainee = trainee_for(settings, dataset, torch_device(settings.device));
    set_tf32_and_determinism(settings, torch_device(settings.device));
    auto opencl = device_that_draws(settings.opencl, 0, events.note);
    const auto clips = view_to_draw(opencl, dataset, settings.train_split, joints).store;
    std::optional<kernels::ClipStore> test_clips;
    if (!settings.test_split.empty())
        test_clips = view_to_draw(opencl, dataset, settings.test_split, joints).store;
    const Processes alone;
    const LearnerSetup setup{clips, torch_device(settings.device), alone};
    RecogniserLearner learner(settings, std::move(trainee.network), header.classes.size(),
                              Augmentation(settings, ingest::representation_of(dataset, joints),
                                           ingest::topology_of(dataset, joints), dataset.folder().string()),
                              setup);
    std::optional<TestSplitValidator> validator;
    if (test_clips) validator.emplace(settings.test_split, *test_clips, learner);
    const TrainingTask task{config.model(), config, settings, dataset,
                            [&](const auto& path, const auto& weights, auto notes) {
                                notes["configuration"] = config.yaml();
                                trainee.save(path, weights, notes);
                            }};
    const auto tests =
        test_clips
            ? fmt::format("tests on split {}: {} clips", settings.test_split, test_clips->table().clips())
            : "tests on none, so no accuracy and no weights-best.h5 (test_split=SPLIT names one)";
    tell_split(dataset, settings, clips.table().clips(), learner.windows_a_step(), tests, events.note);
    if (const auto line = missing_classes(clips, header.classes, settings.train_split);
        !line.empty() && events.note)
        events.note(line);
    RecogniserResult result{train(task, learner, setup, validator ? &*validator : nullptr, run, events),
                            eval::Confusion(header.classes.size()), header.classes};
    if (validator)  // an earlier call may have done all epochs
        result.confusion =
            validator->confusion() ? *validator->confusion() : learner.confusion_on(*test_clips);
    return result;
}

}  // namespace

RecogniserResult train_recogniser(const Config& config, const std::filesystem::path& run,
                                  const TrainingEvents& events) {
    set_threads(recogniser_settings(config).threads);
    if (events.note) events.note(check_blas().line);
    try {
        return train_here(config, run, events);
    } catch (const c10::Error& e) {
        throw Error("libtorch: {}; a smaller batch helps where memory ran out", one_line(e));
    }
}

}  // namespace actformer::model
