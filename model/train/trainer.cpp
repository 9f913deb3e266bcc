#include "model/train/trainer.hpp"

#include <chrono>
#include <memory>

#include "base/error.hpp"
#include "base/process/interruption.hpp"
#include "model/train/checkpoint.hpp"
#include "model/train/divergence.hpp"
#include "model/train/run_folder.hpp"
#include "model/train/validations.hpp"

namespace actformer::model {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class Loop {
  public:
    Loop(const TrainingTask& task, Learner& learner, const LearnerSetup& setup, Validator* validator,
         const std::filesystem::path& run, const TrainingEvents& events, const SafePoints& safe_points);
    TrainingResult run();

  private:
    bool leads() const { return processes_.place().leads(); }
    void say(const std::string& line) const {
        if (events_.note && leads()) events_.note(line);
    }
    void resume();
    void take_over(const Checkpoint& checkpoint);
    void compare_data(const Json& state) const;
    void say_where_it_goes_on() const;
    void broadcast();
    std::vector<double> read_sums();
    void read_losses();
    void end_epoch();
    void begin_validation(EpochReport& report);
    std::optional<ValidationReport> end_validation();
    void log_later_validation();
    void try_writing(const std::function<void()>& write) const;
    void log(const Json& line) const {
        try_writing([&] { folder_->log(line); });
    }
    Json state_now();
    std::map<std::string, std::string> notes(std::uint64_t step) const;
    void save_best();
    void save();
    void save_if_sound();
    void check_weights() const;
    std::string what_is_kept() const;
    [[noreturn]] void stop();
    void finish();
    std::uint64_t epoch() const { return step_ / steps_an_epoch_; }
    std::filesystem::path file(const char* name) const { return folder_->path() / name; }

    const TrainingTask& task_;
    const TrainerSettings& settings_;
    Learner& learner_;
    const Processes& processes_;
    Validations validations_;
    const TrainingEvents& events_;
    const SafePoints& safe_points_;
    std::unique_ptr<RunFolder> folder_;  ///< of rank 0
    DivergenceWatch watch_;
    std::uint64_t steps_an_epoch_ = 0, windows_a_step_ = 0, step_ = 0;
    std::vector<double> sums_;     ///< of the running epoch, when last read
    std::uint64_t sums_step_ = 0;  ///< at which they were
    Clock::time_point epoch_start_, kept_;
    std::uint64_t timed_from_ = 0;
    std::optional<std::uint64_t> kept_step_;  ///< of the newest checkpoint; none before there is one
    double epoch_seconds_ = 0;                ///< spent on the running epoch by earlier calls
};

Loop::Loop(const TrainingTask& task, Learner& learner, const LearnerSetup& setup, Validator* validator,
           const std::filesystem::path& run, const TrainingEvents& events, const SafePoints& safe_points)
    : task_(task),
      settings_(task.settings),
      learner_(learner),
      processes_(setup.processes),
      validations_(validator),
      events_(events),
      safe_points_(safe_points) {
    windows_a_step_ = learner.windows_a_step() * static_cast<std::uint64_t>(processes_.place().size);
    steps_an_epoch_ = (setup.clips.table().clips() + windows_a_step_ - 1) / windows_a_step_;
    if (leads()) {
        folder_ = std::make_unique<RunFolder>(run, settings_.tensorboard);
        folder_->keep_to(task_.config);
        resume();
    }
    broadcast();
    sums_step_ = timed_from_ = step_;
    sums_ = read_sums();
    kept_ = epoch_start_ = Clock::now();
}

/// What differs is named: another skeleton or other classes are no mere update of the data.
void Loop::compare_data(const Json& state) const {
    const auto& header = task_.dataset.header();
    const auto folder = folder_->path().string();
    const auto refuse = [&](const std::string& what) {
        throw Error("{}: holds a training on {}, and {} has others; choose another -o", folder, what,
                    task_.dataset.folder().string());
    };
    if (state.at("persons") != header.persons)
        refuse(fmt::format("clips of {} person{}", state.at("persons").dump(),
                           state.at("persons") == 1 ? "" : "s"));
    if (state.at("representation") != header.representation.name())
        refuse("motions as " + state.at("representation").get<std::string>());
    if (state.at("parents") != Json(header.topology.parents))
        refuse(fmt::format("a skeleton of {} joints", state.at("parents").size()));
    if (state.at("classes") != Json(header.classes))
        refuse(fmt::format("{} classes, the first '{}'", state.at("classes").size(),
                           state.at("classes").empty() ? "" : state.at("classes")[0].get<std::string>()));
    if (state.at("dataset") != task_.dataset.fingerprint())
        throw Error("{}: holds a training on other data than {} has; choose another -o", folder,
                    task_.dataset.folder().string());
    if (state.at("processes") != processes_.place().size)
        throw Error(
            "{}: holds a training by {} processes, and these are {}; start as many, or choose another -o",
            folder, state.at("processes").dump(), processes_.place().size);
}

void Loop::resume() {
    const auto note = [this](const std::string& line) { say(line); };
    if (const auto found = newest_checkpoint(folder_->path(), task_.model, note)) {
        const auto file = checkpoint_path(folder_->path(), found->step).string();
        try {
            take_over(*found);
        } catch (const Json::exception& e) {
            throw Error("{}: damaged, or made by another version ({}); choose another -o", file, e.what());
        }
        say_where_it_goes_on();
    }
    if (const auto line = folder_->rewind_log(epoch()); !line.empty()) say(line);
}

void Loop::take_over(const Checkpoint& checkpoint) {
    const auto& state = checkpoint.state;
    compare_data(state);
    kept_step_ = step_ = checkpoint.step;
    learner_.load(checkpoint.arrays, step_,
                  fmt::format("{}: checkpoint of step {}", folder_->path().string(), step_));
    const auto sums = state.at("sums").get<std::vector<double>>();
    if (std::ssize(sums) != learner_.sums().numel())
        throw Error("{}: {} sums of losses, and this training has {}; choose another -o",
                    checkpoint_path(folder_->path(), step_).string(), sums.size(), learner_.sums().numel());
    for (std::size_t i = 0; i < sums.size(); ++i) learner_.sums()[static_cast<std::int64_t>(i)] = sums[i];
    epoch_seconds_ = state.at("seconds");
    if (!validations_.take_from(state, epoch() < settings_.epochs))
        say("the scores so far are of another recogniser or of other numbers of motions: the best "
            "weights are chosen from now on");
    else if (!validations_.scores() && validations_.best())
        say(fmt::format("weights-best.h5 is of epoch {} and stays: nothing scores later ones",
                        validations_.best()->epoch));
}

void Loop::say_where_it_goes_on() const {
    if (epoch() > settings_.epochs)
        say(fmt::format("{} epochs are done, more than epochs={}: nothing is left to train", epoch(),
                        settings_.epochs));
    else if (epoch() == settings_.epochs)
        say(fmt::format("all {} epochs are done: nothing is left to train; a larger epochs= goes on",
                        epoch()));
    else if (step_ % steps_an_epoch_ == 0)
        say(fmt::format("going on after epoch {} of {}", epoch(), settings_.epochs));
    else
        say(fmt::format("going on after step {}, in epoch {} of {}", step_, epoch() + 1, settings_.epochs));
}

/// What rank 0 found in the folder, to all.
void Loop::broadcast() {
    auto counters = at::tensor({static_cast<double>(step_)}, at::kDouble).to(learner_.sums().device());
    processes_.broadcast(counters);
    processes_.broadcast(learner_.sums());
    step_ = static_cast<std::uint64_t>(counters.item<double>());
    learner_.broadcast(step_);
}

/// Waits for the device.
std::vector<double> Loop::read_sums() {
    const auto sums = learner_.sums().to(at::kCPU);
    const auto* first = sums.data_ptr<double>();
    return {first, first + sums.numel()};
}

void Loop::read_losses() {
    const auto sums = read_sums();
    auto since = sums;
    for (std::size_t i = 0; i < sums.size(); ++i) since[i] -= sums_[i];
    const auto losses = learner_.losses(since, step_ - sums_step_);
    watch_.see(losses, learner_.trouble(losses), step_ - sums_step_);
    sums_ = sums;
    sums_step_ = step_;
    const auto verdict = watch_.verdict();
    if (verdict.empty()) return;
    if (!leads())
        throw Error("rank {}: stopped at step {}, as {}; rank 0 says which checkpoint is kept",
                    processes_.place().rank, step_, verdict);
    log_later_validation();
    throw Error("{}: stopped at step {}, as {}; {}", folder_->path().string(), step_, verdict,
                what_is_kept());
}

void Loop::end_epoch() {
    EpochReport report{epoch(), step_, learner_.losses(sums_, steps_an_epoch_), {}, 0, 0, 0};
    const double here = seconds_since(epoch_start_);
    report.seconds = epoch_seconds_ + here;
    report.steps_a_second = static_cast<double>(step_ - timed_from_) / here;
    report.windows_a_second = report.steps_a_second * static_cast<double>(windows_a_step_);
    learner_.sums().zero_();
    sums_.assign(sums_.size(), 0);
    if (leads()) {
        begin_validation(report);
        Json line{{"epoch", report.epoch}, {"step", report.step}};
        for (const auto& loss : report.losses) line[loss.key] = loss.value;
        if (report.scores) line.update(report.scores->values);
        line["seconds"] = report.seconds;
        line["steps_a_second"] = report.steps_a_second;
        line["windows_a_second"] = report.windows_a_second;
        log(line);
        if (events_.epoch) events_.epoch(report);
    }
    epoch_seconds_ = 0;
    timed_from_ = step_;
    epoch_start_ = Clock::now();
}

void Loop::begin_validation(EpochReport& report) {
    if (!validations_.due(report.epoch, report.epoch == settings_.epochs)) return;
    log_later_validation();
    check_weights();  // a recogniser's ReLU would make finite scores of NaN
    validations_.begin(report.epoch, step_);
    if (!validations_.in_background()) report.scores = end_validation();
}

/// Waits for the scores on their way, if there are any, and keeps the best one's weights.
std::optional<ValidationReport> Loop::end_validation() {
    auto report = validations_.end();
    if (report && report->best) try_writing([this] { save_best(); });
    return report;
}

void Loop::log_later_validation() {
    const auto report = end_validation();
    if (!report) return;
    Json line{{"epoch", report->epoch}, {"step", report->step}};
    line.update(report->values);
    log(line);
    if (events_.scores) events_.scores(*report);
}

std::map<std::string, std::string> Loop::notes(std::uint64_t step) const {
    return {{"program", "actformer " ACTFORMER_VERSION},
            {"dataset", task_.dataset.header().name},
            {"fingerprint", task_.dataset.fingerprint()},
            {"split", settings_.train_split},
            {"step", std::to_string(step)},
            {"epoch", std::to_string(step / steps_an_epoch_)}};
}

Json Loop::state_now() {
    const auto& header = task_.dataset.header();
    Json state{{"model", task_.model},
               {"program", ACTFORMER_VERSION},
               {"dataset", task_.dataset.fingerprint()},
               {"persons", header.persons},
               {"representation", header.representation.name()},
               {"parents", header.topology.parents},
               {"classes", header.classes},
               {"processes", processes_.place().size},
               {"seed", settings_.seed},  // with the steps done, all there is to the random numbers' state
               {"sums", sums_},
               {"seconds", epoch_seconds_ + seconds_since(epoch_start_)}};
    validations_.add_to(state);
    return state;
}

/// Runs `write`. Where it throws Error, for want of room perhaps, training goes on, and says so.
void Loop::try_writing(const std::function<void()>& write) const {
    try {
        write();
    } catch (const Error& e) {
        say(fmt::format("step {}: {}; training goes on", step_, e.what()));
    }
}

/// The best weights, where those in the folder are others.
void Loop::save_best() {
    validations_.save_best([this](const std::vector<Array>& weights, std::uint64_t step) {
        task_.save_weights(file("weights-best.h5"), weights, notes(step));
    });
}

/// Weights and checkpoint, the latter last: what a kill leaves before it is written anew, the same.
void Loop::save() {
    save_best();
    task_.save_weights(file("weights-last.h5"), learner_.weights(), notes(step_));
    if (learner_.keeps_ema())
        task_.save_weights(file("weights-average.h5"), learner_.ema_weights(), notes(step_));
    folder_->sync_log();  // who goes on from the checkpoint does not log what is before it again
    save_checkpoint(folder_->path(), {step_, state_now(), learner_.state()});
    kept_step_ = step_;
}

/// Saves, unless losses are unsound. Weights that are not finite end the training, as such losses do.
void Loop::save_if_sound() {
    kept_ = Clock::now();
    log_later_validation();
    check_weights();
    if (watch_.sound()) try_writing([this] { save(); });
}

/// Throws Error where weights are not finite: no step makes them so again.
void Loop::check_weights() const {
    if (!learner_.finite())
        throw Error("{}: stopped at step {}, as weights are NaN or infinite; {}", folder_->path().string(),
                    step_, what_is_kept());
}

/// How a message about a training beyond hope ends.
std::string Loop::what_is_kept() const {
    const auto checkpoint = kept_step_ ? fmt::format("the checkpoint of step {} is kept", *kept_step_)
                                       : std::string("no checkpoint has been written yet");
    return checkpoint + ", and lower learning rates in a new -o may help";
}

/// A signal has asked for it: keeps the running step, if that can be.
void Loop::stop() {
    if (sums_step_ != step_) read_losses();
    save_if_sound();
    const auto folder = folder_->path().string();
    if (!kept_step_)
        safe_points_.stop(
            fmt::format("{}: no checkpoint has been written yet; the same command starts anew", folder));
    safe_points_.stop(
        fmt::format("{}: the checkpoint of step {} of {} is kept; the same command goes on from there",
                    folder, *kept_step_, settings_.epochs * steps_an_epoch_));
}

/// The last of it must be kept.
void Loop::finish() {
    log_later_validation();
    check_weights();
    save();
}

TrainingResult Loop::run() {
    const auto all = settings_.epochs * steps_an_epoch_;
    const std::uint64_t between_readings = learner_.sums().is_cpu() ? 1 : 20;  // steps
    while (step_ < all) {
        learner_.step(step_, settings_.rate_share(epoch()));
        ++step_;
        const bool ends = step_ % steps_an_epoch_ == 0;
        if (ends || step_ % between_readings == 0) read_losses();
        if (ends) end_epoch();
        if (leads() && sums_step_ == step_ && seconds_since(kept_) >= 60 * settings_.checkpoint_minutes)
            save_if_sound();
        if (leads() && events_.progress)
            events_.progress(static_cast<double>(step_) / static_cast<double>(all), step_);
        if (leads() && step_ < all && safe_points_.asked()) stop();
    }
    TrainingResult result{epoch(), step_, {}, {}, {}, {}, {}};
    if (!leads()) return result;
    finish();
    result.best = validations_.best();
    result.last = validations_.last();
    result.weights = file("weights-last.h5");
    if (learner_.keeps_ema()) result.average_weights = file("weights-average.h5");
    if (result.best) result.best_weights = file("weights-best.h5");
    return result;
}

}  // namespace

TrainingResult train(const TrainingTask& task, Learner& learner, const LearnerSetup& setup,
                     Validator* validator, const std::filesystem::path& run, const TrainingEvents& events) {
    const SafePoints safe_points;
    const auto& place = setup.processes.place();
    try {
        return Loop(task, learner, setup, validator, run, events, safe_points).run();
    } catch (const PeerLost&) {  // a signal has stopped rank 0 too, perhaps before
        if (place.leads() || !safe_points.asked()) throw;
        safe_points.stop(fmt::format("rank {}: rank 0 keeps the checkpoint", place.rank));
    }
}

}  // namespace actformer::model
