#include "model/generators/actformer/generator_trainer.hpp"

#include <chrono>
#include <cmath>
#include <memory>

#include "base/error.hpp"
#include "ingest/dataset/subjects.hpp"
#include "ingest/dataset/view.hpp"
#include "model/cpu/blas.hpp"
#include "model/generators/actformer/gan.hpp"
#include "model/generators/actformer/generator_file.hpp"
#include "model/generators/actformer/health.hpp"
#include "model/generators/actformer/trials.hpp"
#include "model/train/checkpoint.hpp"
#include "model/train/rate_drops.hpp"
#include "model/train/run_folder.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Json json_of(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

std::optional<double> optional_of(const Json& value) {
    if (value.is_null()) return {};
    return value.get<double>();
}

class Training {
  public:
    Training(const Config& config, const std::filesystem::path& run, bool data_parallel,
             const GeneratorEvents& events);
    GeneratorResult run();

  private:
    bool leads() const { return processes_->place().leads(); }
    void say(const std::string& line) const {
        if (events_.note && leads()) events_.note(line);
    }
    void open_run(const std::filesystem::path& run);
    void resume();
    void compare_data(const Json& state) const;
    void share();
    void train_step();
    void look();
    Losses losses_of(const std::vector<double>& sums, std::uint64_t steps) const;
    void end_epoch();
    void end_trial();
    bool write(const std::function<void()>& something) const;
    void log(const Json& line) const {
        write([&] { folder_->log(line); });
    }
    bool keep();
    void save();
    void finish();
    Json state_now();
    std::map<std::string, std::string> notes(std::uint64_t step) const;
    std::vector<double> sums_now();
    std::uint64_t epoch() const { return step_ / steps_an_epoch_; }
    std::filesystem::path file(const char* name) const { return folder_->path() / name; }

    const Config& config_;
    const GeneratorEvents& events_;
    GanSettings settings_;
    ingest::Dataset dataset_;
    ingest::Subjects subjects_;
    GeneratorSettings generator_settings_;
    at::Device device_;
    std::unique_ptr<Processes> processes_;
    kernels::Device opencl_;
    kernels::ClipStore clips_;
    RandomFeed feed_;
    Gan gan_;
    std::unique_ptr<Trials> trials_;  ///< of rank 0, where there is a recogniser
    std::unique_ptr<RunFolder>
        folder_;  ///< of rank 0, made last: what cannot be trained leaves no folder behind
    Health health_;
    std::uint64_t steps_an_epoch_ = 0, step_ = 0;
    std::vector<double> seen_sums_;  ///< of the running epoch, when last looked at
    std::uint64_t seen_step_ = 0;
    Clock::time_point epoch_start_, kept_;
    std::uint64_t timed_from_ = 0, kept_step_ = 0;
    double epoch_seconds_ = 0;  ///< spent on the running epoch by earlier calls
    std::optional<GeneratorScores> best_, last_;
};

Place place_in(bool data_parallel) {
    return data_parallel ? place_of(environment) : Place{};
}

/// The GPU that belongs to this process; else the device as it is asked for.
std::string device_for(const GanSettings& settings, const Place& place) {
    return settings.device == "cuda" && place.size > 1 ? fmt::format("cuda:{}", place.local)
                                                       : settings.device;
}

std::unique_ptr<Processes> connect(bool data_parallel, const at::Device& device) {
    return data_parallel ? std::make_unique<Processes>(place_in(true), device)
                         : std::make_unique<Processes>();
}

GeneratorSettings generator_for(const Config& config, const ingest::Dataset& dataset) {
    const auto& header = dataset.header();
    return generator_settings(config, header.topology, header.persons, header.classes.size(), 3,
                              dataset.folder().string());
}

DiscriminatorSettings discriminator_for(const Config& config, const ingest::Dataset& dataset) {
    const auto& header = dataset.header();
    return discriminator_settings(config, header.topology, header.persons, header.classes.size(), 3,
                                  dataset.folder().string());
}

kernels::SamplerOptions sampling(const GanSettings& settings, const Place& place) {
    return {settings.seed, kernels::ClassSampling::square_root, true,
            static_cast<std::uint32_t>(place.rank) * settings.batch};
}

Training::Training(const Config& config, const std::filesystem::path& run, bool data_parallel,
                   const GeneratorEvents& events)
    : config_(config),
      events_(events),
      settings_(gan_settings(config)),
      dataset_(dataset_to_train_on(settings_.data)),
      subjects_(ingest::subjects_of(dataset_)),
      generator_settings_(generator_for(config, dataset_)),
      device_(torch_device(device_for(settings_, place_in(data_parallel)))),
      processes_(connect(data_parallel, device_)),
      opencl_(settings_.opencl),
      clips_(ingest::load_view(opencl_, dataset_, settings_.train_split).store),
      feed_(clips_, sampling(settings_, processes_->place()), settings_.batch, settings_.frames),
      gan_(settings_, generator_settings_, discriminator_for(config, dataset_), device_, *processes_),
      health_(settings_.loss) {
    const auto windows = std::uint64_t{settings_.batch} * settings_.discriminator_steps *
                         static_cast<std::uint64_t>(processes_->place().size);
    steps_an_epoch_ = (clips_.table().clips() + windows - 1) / windows;
    if (leads()) open_run(run);
    share();
    seen_step_ = timed_from_ = kept_step_ = step_;
    seen_sums_ = sums_now();
    kept_ = epoch_start_ = Clock::now();
}

void Training::open_run(const std::filesystem::path& run) {
    if (!settings_.recogniser.empty()) {
        trials_ = std::make_unique<Trials>(settings_, dataset_, clips_);
        say(fmt::format("the recogniser knows {:.1f} % of the {} real windows of split {}",
                        100 * trials_->judge().real_accuracy(), trials_->judge().real_windows(),
                        settings_.train_split));
    }
    folder_ = std::make_unique<RunFolder>(run);
    folder_->keep_to(config_, generator_config(), generator_keys_free_to_change());
    resume();
}

/// What differs is named: another skeleton or other classes are no mere update of the data.
void Training::compare_data(const Json& state) const {
    const auto refuse = [&](const std::string& what) {
        throw Error("{}: holds a training on {}, and {} has others; choose another -o",
                    folder_->path().string(), what, dataset_.folder().string());
    };
    if (state.at("persons") != subjects_.persons)
        refuse(fmt::format("{} persons a clip", state.at("persons").get<int>()));
    if (state.at("parents") != Json(subjects_.topology.parents))
        refuse(fmt::format("a skeleton of {} joints", state.at("parents").size()));
    if (state.at("classes") != Json(subjects_.classes))
        refuse(fmt::format("{} classes, the first '{}'", state.at("classes").size(),
                           state.at("classes").empty() ? "" : state.at("classes")[0].get<std::string>()));
    if (state.at("dataset") != dataset_.fingerprint())
        throw Error("{}: holds a training on other data; choose another -o", folder_->path().string());
    if (state.at("processes") != processes_->place().size)
        throw Error(
            "{}: holds a training by {} processes, and these are {}; start as many, or choose another -o",
            folder_->path().string(), state.at("processes").get<int>(), processes_->place().size);
}

void Training::resume() {
    const auto found =
        newest_checkpoint(folder_->path(), "generator", [this](const std::string& line) { say(line); });
    if (found) {
        const auto& state = found->state;
        compare_data(state);
        step_ = found->done;
        gan_.load(found->arrays, step_,
                  fmt::format("{}: checkpoint of step {}", folder_->path().string(), step_));
        const auto sums = state.at("sums").get<std::vector<double>>();
        for (std::size_t i = 0; i < sums.size(); ++i) gan_.sums()[static_cast<std::int64_t>(i)] = sums[i];
        epoch_seconds_ = state.at("seconds");
        if (state.contains("best") && trials_ && state.at("recogniser") == trials_->judge().checksum()) {
            const auto& b = state.at("best");
            best_ = {b.at("epoch"),
                     b.at("step"),
                     b.at("accuracy"),
                     b.at("fid_whole"),
                     optional_of(b.at("fid_mean")),
                     true};
        }
        say(fmt::format("going on after step {}, in epoch {} of {}", step_, epoch() + 1, settings_.epochs));
    }
    folder_->rewind_log(epoch());
}

/// What rank 0 found in the folder, to all.
void Training::share() {
    auto counters = at::tensor({static_cast<double>(step_)}, at::kDouble).to(device_);
    processes_->share(counters);
    processes_->share(gan_.sums());
    step_ = static_cast<std::uint64_t>(counters.item<double>());
    gan_.share(step_);
}

std::vector<double> Training::sums_now() {
    const auto sums = gan_.sums().to(at::kCPU);
    const auto* first = sums.data_ptr<double>();
    return {first, first + sums.numel()};
}

Losses Training::losses_of(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto g = static_cast<double>(steps), d = g * settings_.discriminator_steps;
    return {sums[0] / d, sums[1] / d, sums[2] / d, sums[3] / g};
}

/// A step of the generator, and those of the discriminator before it. Every random number is a function of the seed and of
/// the step's number.
void Training::train_step() {
    const auto steps = std::uint64_t{settings_.discriminator_steps};
    gan_.set_rate_share(rate_share(settings_.rate_drops, settings_.rate_factor, epoch()));
    at::Tensor labels;
    for (std::uint64_t i = 0; i < steps; ++i) {
        const auto windows = feed_.batch(step_ * steps + i);
        labels = labels_of(windows, device_);
        const auto real = values_of(windows, 3 * std::int64_t{subjects_.persons}, settings_.frames,
                                    static_cast<std::int64_t>(subjects_.topology.joints()), device_);
        gan_.step_discriminator(real, labels, step_ * (steps + 1) + i);
    }
    gan_.step_generator(labels, step_ * (steps + 1) + steps);
    ++step_;
}

/// Reads the losses, which waits for the device.
void Training::look() {
    const auto sums = sums_now();
    auto since = sums;
    for (std::size_t i = 0; i < sums.size(); ++i) since[i] -= seen_sums_[i];
    health_.see(losses_of(since, step_ - seen_step_), step_ - seen_step_);
    seen_sums_ = sums;
    seen_step_ = step_;
    const auto verdict = health_.verdict();
    if (verdict.empty()) return;
    if (!leads()) throw Error("rank {}: stopped at step {}", processes_->place().rank, step_);
    end_trial();
    throw Error(
        "{}: stopped at step {}, as {}; the checkpoint of step {} is kept, and other rates or another loss: "
        "in a new -o may help",
        folder_->path().string(), step_, verdict, kept_step_);
}

void Training::end_epoch() {
    const auto losses = losses_of(seen_sums_, steps_an_epoch_);
    GeneratorEpoch report{epoch(),          step_, losses.discriminator, losses.generator, losses.real_score,
                          losses.made_score};
    const double here = seconds_since(epoch_start_);
    report.seconds = epoch_seconds_ + here;
    report.steps_a_second = static_cast<double>(step_ - timed_from_) / here;
    gan_.sums().zero_();
    seen_sums_.assign(seen_sums_.size(), 0);
    epoch_seconds_ = 0;
    timed_from_ = step_;
    epoch_start_ = Clock::now();
    if (!leads()) return;
    log({{"epoch", report.epoch},
         {"step", report.step},
         {"discriminator_loss", report.discriminator_loss},
         {"generator_loss", report.generator_loss},
         {"real_score", report.real_score},
         {"made_score", report.made_score},
         {"seconds", report.seconds},
         {"steps_a_second", report.steps_a_second}});
    if (events_.epoch) events_.epoch(report);
    if (trials_ && (report.epoch % settings_.score_every == 0 || report.epoch == settings_.epochs)) {
        end_trial();
        trials_->begin(gan_.shown(), report.epoch, step_);
    }
}

/// What came of the trial on its way, if there is one.
void Training::end_trial() {
    const auto trial = trials_ ? trials_->end() : std::nullopt;
    if (!trial) return;
    const auto& found = trial->scores;
    GeneratorScores scores{trial->epoch, trial->step, found.accuracy, found.fid_whole, found.fid_mean};
    scores.best =
        (!best_ || scores.fid_whole < best_->fid_whole) && write([&] {
            save_generator(file("weights-best.h5"), trial->weights, config_, subjects_, notes(trial->step));
        });
    log({{"epoch", scores.epoch},
         {"step", scores.step},
         {"accuracy", scores.accuracy},
         {"real_accuracy", trials_->judge().real_accuracy()},
         {"fid_whole", scores.fid_whole},
         {"fid_mean", json_of(scores.fid_mean)}});
    last_ = scores;
    if (scores.best) best_ = scores;
    if (events_.scores) events_.scores(scores);
}

std::map<std::string, std::string> Training::notes(std::uint64_t step) const {
    return {{"program", "actformer " ACTFORMER_VERSION},
            {"dataset", dataset_.header().name},
            {"fingerprint", dataset_.fingerprint()},
            {"split", settings_.train_split},
            {"step", std::to_string(step)}};
}

Json Training::state_now() {
    Json state{{"model", "generator"},
               {"program", ACTFORMER_VERSION},
               {"dataset", dataset_.fingerprint()},
               {"persons", subjects_.persons},
               {"parents", subjects_.topology.parents},
               {"classes", subjects_.classes},
               {"processes", processes_->place().size},
               {"seed", settings_.seed},  // with the steps done, all there is to the random numbers' state
               {"sums", seen_sums_},
               {"seconds", epoch_seconds_ + seconds_since(epoch_start_)}};
    if (trials_) state["recogniser"] = trials_->judge().checksum();
    if (best_)
        state["best"] = {{"epoch", best_->epoch},
                         {"step", best_->step},
                         {"accuracy", best_->accuracy},
                         {"fid_whole", best_->fid_whole},
                         {"fid_mean", json_of(best_->fid_mean)}};
    return state;
}

/// Where there is no room, training goes on, and says so.
bool Training::write(const std::function<void()>& something) const {
    try {
        something();
        return true;
    } catch (const Error& e) {
        say(fmt::format("step {}: {}; training goes on", step_, e.what()));
        return false;
    }
}

/// Weights and checkpoint, the latter last: what a kill leaves before it is written anew, the same.
void Training::save() {
    save_generator(file("weights-last.h5"), arrays_of(gan_.generator(), ""), config_, subjects_,
                   notes(step_));
    if (settings_.average > 0)
        save_generator(file("weights-average.h5"), arrays_of(gan_.shown(), ""), config_, subjects_,
                       notes(step_));
    save_checkpoint(folder_->path(), {step_, state_now(), gan_.arrays()});
    kept_step_ = step_;
}

/// Keeps what is sound. False where it is not, or cannot be written.
bool Training::keep() {
    kept_ = Clock::now();
    end_trial();
    if (!health_.sound() || !gan_.finite()) return false;
    return write([this] { save(); });
}

/// The last of it must be kept.
void Training::finish() {
    end_trial();
    if (!gan_.finite())
        throw Error("{}: the weights of step {} are no numbers; the checkpoint of step {} is kept",
                    folder_->path().string(), step_, kept_step_);
    save();
}

GeneratorResult Training::run() {
    const auto all = settings_.epochs * steps_an_epoch_;
    const std::uint64_t looks = device_.is_cpu() ? 1 : 20;  // steps between them
    while (step_ < all) {
        train_step();
        const bool ends = step_ % steps_an_epoch_ == 0;
        if (ends || step_ % looks == 0) look();
        if (ends) end_epoch();
        if (leads() && seen_step_ == step_ && seconds_since(kept_) >= 60 * settings_.checkpoint_minutes)
            keep();
        if (leads() && events_.progress)
            events_.progress(static_cast<double>(step_) / static_cast<double>(all), step_);
    }
    GeneratorResult result{epoch(), step_, {}, {}, {}, {}, {}, {}};
    if (!leads()) return result;
    finish();
    result.best = best_;
    result.last = last_;
    if (trials_) result.real_accuracy = trials_->judge().real_accuracy();
    result.weights = file("weights-last.h5");
    if (settings_.average > 0) result.average_weights = file("weights-average.h5");
    if (best_) result.best_weights = file("weights-best.h5");
    return result;
}

}  // namespace

GeneratorResult train_generator(const Config& config, const std::filesystem::path& run, bool data_parallel,
                                const GeneratorEvents& events) {
    set_threads(gan_settings(config).threads);
    const auto blas = check_blas().line;
    if (events.note && (!data_parallel || place_of(environment).leads())) events.note(blas);
    try {
        return Training(config, run, data_parallel, events).run();
    } catch (const c10::Error& e) {
        throw Error("libtorch: {}; a smaller batch helps where memory ran out", one_line(e));
    }
}

}  // namespace actformer::model
