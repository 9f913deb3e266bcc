// Progress on standard error: a bar with rate and time left on a terminal, a plain line now and then elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace actformer::cli {

class Progress {
  public:
    /// `label` as in "ingest"; `unit` as in "clips".
    Progress(std::string label, std::string unit, bool quiet = false);
    ~Progress();

    /// `fraction` of the work is done (0..1), and `count` units so far. Cheap: draws at most ten times a second.
    void update(double fraction, std::uint64_t count);

    /// Takes the bar off the terminal, so that other lines can be printed.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    std::string label_, unit_;
    bool quiet_, terminal_, drawn_ = false;
    Clock::time_point start_, last_;
    double start_fraction_ = -1;
    std::uint64_t start_count_ = 0;
};

/// "1.2 s", "3 min 20 s", "2 h 05 min".
std::string duration(double seconds);

}  // namespace actformer::cli
