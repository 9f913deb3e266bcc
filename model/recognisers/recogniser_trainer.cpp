#include "model/recognisers/recogniser_trainer.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "ingest/dataset/view.hpp"
#include "model/cpu/blas.hpp"
#include "model/nn/sgd.hpp"
#include "model/nn/tensor_array.hpp"
#include "model/nn/weights_file.hpp"
#include "model/recognisers/stgcn_net.hpp"
#include "model/train/checkpoint.hpp"
#include "model/train/run_folder.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

class Training {
  public:
    Training(const Config& config, const std::filesystem::path& run, const TrainingEvents& events);
    TrainingResult run();

  private:
    void say(const std::string& line) const {
        if (events_.note) events_.note(line);
    }
    void say_what_is_missing() const;
    void resume();
    EpochReport train_epoch();
    void step(const Windows& windows, double rate, std::uint64_t index);
    void score(EpochReport& report);
    void keep(const EpochReport& report);
    std::vector<Array> momenta();
    at::Tensor to_tensor(const Windows& windows) const;
    std::map<std::string, std::string> notes(std::uint64_t epoch) const;
    std::filesystem::path last_weights() const { return folder_.path() / "weights-last.h5"; }
    std::filesystem::path best_weights() const { return folder_.path() / "weights-best.h5"; }

    const Config& config_;
    const TrainingEvents& events_;
    RecogniserSettings settings_;
    ingest::Dataset dataset_;
    StgcnSettings shape_;
    kernels::Device opencl_;
    kernels::ClipStore train_clips_;
    std::optional<kernels::ClipStore> test_clips_;
    RandomFeed feed_;
    at::Device device_;
    StgcnNet net_;
    Sgd sgd_;
    RunFolder folder_;  ///< made last: what cannot be trained leaves no folder behind
    std::uint64_t steps_an_epoch_ = 0, epochs_ = 0;
    std::uint64_t best_epoch_ = 0;
    double best_accuracy_ = -1;
    at::Tensor loss_sum_,
        right_sum_;  ///< of the running epoch, on the device: reading them would wait for every step
    eval::Confusion confusion_;
};

std::optional<kernels::ClipStore> load_test_split(kernels::Device& device, const ingest::Dataset& dataset,
                                                  const std::string& split) {
    if (split.empty()) return std::nullopt;
    return ingest::load_view(device, dataset, split).store;
}

Training::Training(const Config& config, const std::filesystem::path& run, const TrainingEvents& events)
    : config_(config),
      events_(events),
      settings_(recogniser_settings(config)),
      dataset_(dataset_to_train_on(settings_.data)),
      shape_(network_for(settings_, dataset_.header().topology, dataset_.header().persons,
                         dataset_.header().classes.size(), dataset_.folder().string())),
      opencl_(settings_.opencl),
      train_clips_(ingest::load_view(opencl_, dataset_, settings_.train_split).store),
      test_clips_(load_test_split(opencl_, dataset_, settings_.test_split)),
      feed_(train_clips_, {settings_.seed, kernels::ClassSampling::plain, true}, settings_.batch,
            settings_.frames),
      device_(torch_device(settings_.device)),
      net_(shape_, settings_.seed, device_, torch_type(settings_.precision)),
      sgd_(net_.trained(), {settings_.momentum, settings_.weight_decay, settings_.nesterov}),
      folder_(run),
      confusion_(shape_.classes) {
    steps_an_epoch_ = (train_clips_.table().clips() + settings_.batch - 1) / settings_.batch;
    folder_.keep_to(config_, recogniser_config(), keys_free_to_change());
    say_what_is_missing();
    resume();
}

/// A class that is never seen in training is never recognised: worth a line before hours of it.
void Training::say_what_is_missing() const {
    std::vector<std::size_t> counts(shape_.classes, 0);
    for (const auto label : train_clips_.table().labels) ++counts[label];
    std::vector<std::string> missing;
    for (std::size_t c = 0; c < counts.size(); ++c)
        if (counts[c] == 0) missing.push_back(dataset_.header().classes[c]);
    if (missing.empty()) return;
    constexpr std::size_t named = 8;
    const auto more = missing.size() > named ? fmt::format(" and {} more", missing.size() - named) : "";
    const auto all = missing.size();
    missing.resize(std::min(all, named));
    say(fmt::format("split {} has no clip of {} of the {} classes, which will not be recognised: {}{}",
                    settings_.train_split, all, counts.size(), fmt::join(missing, ", "), more));
}

void Training::resume() {
    const auto found =
        newest_checkpoint(folder_.path(), "recogniser", [this](const std::string& line) { say(line); });
    if (found) {
        if (found->state.at("dataset") != dataset_.fingerprint())
            throw Error("{}: holds a training on other data; choose another -o", folder_.path().string());
        const auto where = fmt::format("{}: checkpoint of epoch {}", folder_.path().string(), found->done);
        net_.load(found->arrays, where);
        auto& momenta = sgd_.momenta();
        const auto first = found->arrays.size() - momenta.size();  // they follow the weights
        for (std::size_t i = 0; i < momenta.size(); ++i)
            copy_into(momenta[i], found->arrays.at(first + i), where);
        epochs_ = found->done;
        best_epoch_ = found->state.at("best_epoch");
        best_accuracy_ = found->state.at("best_accuracy");
        say(fmt::format("going on after epoch {} of {}", epochs_, settings_.epochs));
    }
    folder_.rewind_log(epochs_);
}

at::Tensor Training::to_tensor(const Windows& windows) const {
    return values_of(windows, shape_.channels, settings_.frames, train_clips_.table().nodes, device_)
        .to(torch_type(settings_.precision));
}

void Training::step(const Windows& windows, double rate, std::uint64_t index) {
    const auto labels = labels_of(windows, device_);
    const auto output = net_.train_forward(to_tensor(windows), step_seed(settings_.seed, index));
    const auto loss = at::cross_entropy_loss(output.logits, labels);
    loss.backward();
    sgd_.step(rate);
    loss_sum_ += loss.detach();
    right_sum_ += output.logits.detach().argmax(1).eq(labels).sum();
}

EpochReport Training::train_epoch() {
    EpochReport report;
    report.epoch = epochs_ + 1;
    report.rate = settings_.rate_at(epochs_);
    loss_sum_ = at::zeros({}, at::TensorOptions(torch_type(settings_.precision)).device(device_));
    right_sum_ = at::zeros({}, at::TensorOptions(at::kLong).device(device_));
    const auto start = Clock::now();
    const auto all_steps = static_cast<double>(steps_an_epoch_ * settings_.epochs);
    for (std::uint64_t i = 0; i < steps_an_epoch_; ++i) {
        const auto index = epochs_ * steps_an_epoch_ + i;
        step(feed_.batch(index), report.rate, index);
        if (events_.progress)
            events_.progress(static_cast<double>(index + 1) / all_steps, (index + 1) * settings_.batch);
    }
    const auto windows = static_cast<double>(steps_an_epoch_ * settings_.batch);
    report.loss = loss_sum_.item<double>() / static_cast<double>(steps_an_epoch_);
    report.train_accuracy = static_cast<double>(right_sum_.item<std::int64_t>()) / windows;
    report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    report.windows_a_second = windows / report.seconds;
    if (!std::isfinite(report.loss))
        throw Error("{}: the loss of epoch {} is no number; a smaller rate than {} may help",
                    folder_.path().string(), report.epoch, report.rate);
    ++epochs_;
    return report;
}

void Training::score(EpochReport& report) {
    if (!test_clips_) return;
    confusion_ = eval::Confusion(shape_.classes);
    for_each_window(*test_clips_, settings_.batch, settings_.frames, [&](const Windows& windows) {
        const auto guesses = net_.eval_forward(to_tensor(windows)).logits.argmax(1).to(at::kCPU);
        const auto* guess = guesses.data_ptr<std::int64_t>();
        for (std::uint32_t i = 0; i < windows.count; ++i)
            confusion_.add(windows.labels[i], static_cast<std::size_t>(guess[i]));
    });
    report.scored = true;
    report.class_accuracy = confusion_.mean_class_accuracy();
    report.sample_accuracy = confusion_.sample_accuracy();
    report.best = report.class_accuracy > best_accuracy_;
    if (!report.best) return;
    best_accuracy_ = report.class_accuracy;
    best_epoch_ = report.epoch;
}

std::vector<Array> Training::momenta() {
    std::vector<Array> arrays;
    for (const auto& tensor : sgd_.momenta())
        arrays.push_back(array_of(fmt::format("momentum.{}", arrays.size()), tensor));
    return arrays;
}

std::map<std::string, std::string> Training::notes(std::uint64_t epoch) const {
    return {{"program", "actformer " ACTFORMER_VERSION},
            {"configuration", config_.yaml()},
            {"dataset", dataset_.header().name},
            {"fingerprint", dataset_.fingerprint()},
            {"epoch", std::to_string(epoch)}};
}

/// The checkpoint comes last: what a kill leaves before it is written anew, the same.
void Training::keep(const EpochReport& report) {
    Json line{{"epoch", report.epoch},
              {"rate", report.rate},
              {"loss", report.loss},
              {"train_accuracy", report.train_accuracy}};
    if (report.scored) {
        line["class_accuracy"] = report.class_accuracy;
        line["sample_accuracy"] = report.sample_accuracy;
        line["confusion"] = confusion_.rows();
    }
    line["seconds"] = report.seconds;
    line["windows_a_second"] = report.windows_a_second;
    folder_.log(line);

    Checkpoint checkpoint{epochs_, {}, net_.arrays()};
    const auto& names = dataset_.header().classes;
    save_weights(last_weights(), shape_, checkpoint.arrays, notes(epochs_), names);
    if (report.best) save_weights(best_weights(), shape_, checkpoint.arrays, notes(epochs_), names);
    checkpoint.state = {
        {"model", "recogniser"},
        {"program", ACTFORMER_VERSION},
        {"dataset", dataset_.fingerprint()},
        {"seed", settings_.seed},  // with the steps done, all there is to the random numbers' state
        {"steps", epochs_ * steps_an_epoch_},
        {"best_epoch", best_epoch_},
        {"best_accuracy", best_accuracy_}};
    for (auto& array : momenta()) checkpoint.arrays.push_back(std::move(array));
    save_checkpoint(folder_.path(), checkpoint);
}

TrainingResult Training::run() {
    EpochReport report;
    while (epochs_ < settings_.epochs) {
        report = train_epoch();
        score(report);
        keep(report);
        if (events_.epoch) events_.epoch(report);
    }
    if (!report.scored) score(report);  // an earlier call did all epochs
    TrainingResult result{epochs_,        best_epoch_, best_accuracy_, confusion_, dataset_.header().classes,
                          last_weights(), {}};
    if (best_epoch_ > 0) result.best_weights = best_weights();
    return result;
}

}  // namespace

TrainingResult train_recogniser(const Config& config, const std::filesystem::path& run,
                                const TrainingEvents& events) {
    set_threads(recogniser_settings(config).threads);
    if (events.note) events.note(check_blas().line);
    try {
        return Training(config, run, events).run();
    } catch (const c10::Error& e) {
        throw Error("libtorch: {}; a smaller batch helps where memory ran out", one_line(e));
    }
}

}  // namespace actformer::model
