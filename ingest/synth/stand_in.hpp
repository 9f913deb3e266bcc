// What all stand-ins but NTU's take and tell. To add one: a folder with a writer of its raw layout, and a line in stand_ins.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <span>
#include <string_view>

namespace actformer::ingest::synth {

struct StandInOptions {
    std::filesystem::path folder;
    std::uint64_t clips = 1;
    std::uint64_t seed = 1;
    unsigned threads = 0;                         ///< 0: one a processor
    std::function<void(std::uint64_t)> progress;  ///< told how many clips are done
};

struct StandInSummary {
    std::uint64_t clips = 0;              ///< in the set
    std::uint64_t written = 0;            ///< now; the others were there already
    std::uint64_t frames = 0, bytes = 0;  ///< of what was written
};

struct StandIn {
    std::string_view name, help;
    std::uint64_t clips;             ///< unless told otherwise
    std::string_view what_clips_do;  ///< of the option --clips, as in "the classes taking turns"
    StandInSummary (*make)(const StandInOptions&);
    std::string_view examples;
};

std::span<const StandIn> stand_ins();

/// Counts clips from several threads.
class Counting {
  public:
    explicit Counting(const StandInOptions& options) : options_(options) {}

    void clip_done(std::uint64_t frames, std::uint64_t bytes, bool written = true) {
        const std::lock_guard lock(mutex_);
        ++summary_.clips;
        summary_.written += written;
        summary_.frames += frames;
        summary_.bytes += bytes;
        if (options_.progress) options_.progress(summary_.clips);
    }
    void add_bytes(std::uint64_t bytes) { summary_.bytes += bytes; }
    const StandInSummary& summary() const { return summary_; }

  private:
    const StandInOptions& options_;
    std::mutex mutex_;
    StandInSummary summary_;
};

}  // namespace actformer::ingest::synth
