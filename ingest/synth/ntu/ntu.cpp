#include "ingest/synth/ntu/ntu.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>

#include "ingest/ntu/actions.hpp"
#include "ingest/synth/ntu/kinect.hpp"
#include "ingest/synth/ntu/skeleton_writer.hpp"
#include "kernels/error.hpp"

namespace actformer::ingest::synth {
namespace {

namespace fs = std::filesystem;

/// Returns how many frames the clip has.
std::size_t make_text(const ClipId& clip, std::uint64_t seed, std::string& text) {
    const Casting casting{seed, clip.setup, clip.performer, clip.replication, clip.action};
    const auto recording = record(perform(casting), casting, clip.camera);
    write_skeleton(recording, text);
    return recording.size();
}

[[noreturn]] void refuse_write(const fs::path& file, int code) {
    const char* remedy = code == ENOSPC || code == EDQUOT
                             ? "free some space and run the command again: it goes on where it was"
                             : "make the folder writable or choose another with -o";
    throw Error("{}: cannot be written ({}); {}", file.string(), std::strerror(code), remedy);
}

/// Aside first, then under its name: a file that is there is whole.
void write_file(const fs::path& file, const std::string& text) {
    const fs::path aside = file.string() + ".part";
    std::FILE* out = std::fopen(aside.c_str(), "wb");
    if (!out) refuse_write(file, errno);
    const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
    int code = written ? 0 : errno;
    if (std::fclose(out) != 0 && code == 0) code = errno;
    if (code == 0 && std::rename(aside.c_str(), file.c_str()) != 0) code = errno;
    if (code == 0) return;
    std::remove(aside.c_str());
    refuse_write(file, code);
}

std::vector<int> checked_actions(const NtuOptions& options) {
    auto actions = options.actions;
    if (actions.empty()) {
        actions.resize(ntu::actions);
        std::iota(actions.begin(), actions.end(), 1);
    }
    std::sort(actions.begin(), actions.end());
    actions.erase(std::unique(actions.begin(), actions.end()), actions.end());
    for (const int a : actions) ntu::action_name(a);  // refuses what is no action
    if (const auto most = actions.size() * clips_per_action; options.clips > most)
        throw Error(
            "{} clips: {} actions have at most {} clips with names of their own ({} each); ask for fewer",
            options.clips, actions.size(), most, clips_per_action);
    if (options.clips == 0) throw Error("0 clips: ask for at least one");
    return actions;
}

/// The folder says what its clips were made from; clips of another seed or version must not be mixed with
/// them.
void claim_folder(const NtuOptions& options) {
    std::error_code failed;
    fs::create_directories(options.folder, failed);
    if (failed)
        throw Error("{}: cannot be made a folder ({}); choose another with -o", options.folder.string(),
                    failed.message());
    const auto file = options.folder / "synth.json";
    const nlohmann::ordered_json mine = {
        {"made_by", "actformer synth ntu"}, {"version", ACTFORMER_VERSION}, {"seed", options.seed}};
    if (!fs::exists(file)) return write_file(file, mine.dump(2) + "\n");
    std::ifstream in(file);
    const auto theirs = nlohmann::json::parse(in, nullptr, false);
    if (!theirs.is_object() || theirs != nlohmann::json(mine))
        throw Error(
            "{}: the folder holds clips of another seed or version than seed {} of version {}; choose "
            "another with -o",
            file.string(), options.seed, ACTFORMER_VERSION);
}

/// The clips shared out over threads; the first failure stops all.
class Run {
  public:
    Run(const NtuOptions& options, std::vector<int> actions,
        const std::function<void(std::uint64_t)>& progress)
        : options_(options), actions_(std::move(actions)), progress_(progress) {}

    NtuSummary all() {
        const unsigned wanted =
            options_.threads ? options_.threads : std::max(1u, std::thread::hardware_concurrency());
        {
            std::vector<std::jthread> threads;
            for (unsigned t = 0; t < std::min<std::uint64_t>(wanted, options_.clips); ++t)
                threads.emplace_back([this] { work(); });
        }
        if (failure_) std::rethrow_exception(failure_);
        summary_.clips = options_.clips;
        return summary_;
    }

  private:
    void work() {
        std::string text;
        try {
            for (auto i = next_++; i < options_.clips && !stop_; i = next_++) one(i, text);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!failure_) failure_ = std::current_exception();
            stop_ = true;
        }
    }

    void one(std::uint64_t i, std::string& text) {
        const auto clip = clip_at(i, actions_);
        const auto file = options_.folder / (clip.name() + ".skeleton");
        const bool there = fs::exists(file);
        const std::size_t frames = there ? 0 : make_text(clip, options_.seed, text);
        if (!there) write_file(file, text);

        const std::lock_guard lock(mutex_);
        summary_.written += there ? 0 : 1;
        summary_.frames += frames;
        summary_.bytes += there ? 0 : text.size();
        ++done_;
        if (progress_) progress_(done_);
    }

    const NtuOptions& options_;
    const std::vector<int> actions_;
    const std::function<void(std::uint64_t)>& progress_;
    std::atomic<std::uint64_t> next_{0};
    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    NtuSummary summary_;
    std::uint64_t done_ = 0;
    std::exception_ptr failure_;
};

}  // namespace

NtuSummary synthesise_ntu(const NtuOptions& options, const std::function<void(std::uint64_t)>& progress) {
    auto actions = checked_actions(options);
    claim_folder(options);
    return Run(options, std::move(actions), progress).all();
}

std::string skeleton_text(const ClipId& clip, std::uint64_t seed) {
    std::string text;
    make_text(clip, seed, text);
    return text;
}

}  // namespace actformer::ingest::synth
