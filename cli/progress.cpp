#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/say.hpp"

namespace actformer::cli {

std::string duration(double seconds) {
    if (seconds < 10) return fmt::format("{:.1f} s", seconds);
    const auto s = static_cast<std::uint64_t>(std::llround(seconds));
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
    return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(std::string label, std::string unit, bool quiet)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
    clear();
}

void Progress::update(double fraction, std::uint64_t count) {
    if (quiet_) return;
    const auto now = Clock::now();
    if (start_fraction_ < 0) {  // resumed work counts for the bar, not for the rate
        start_fraction_ = fraction;
        start_count_ = count;
        start_ = now;
    }
    const auto interval = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
    if (now - last_ < interval) return;
    last_ = now;

    const double spent = std::chrono::duration<double>(now - start_).count();
    const double rate =
        spent > 0 && count > start_count_ ? static_cast<double>(count - start_count_) / spent : 0;
    const double gained = fraction - start_fraction_;
    const auto left =
        gained > 0 ? duration(spent * (1 - fraction) / gained) + " left" : std::string("starting");
    const auto text = fmt::format("{:3.0f} %  {} {}  {:.{}f}/s  {}", 100 * std::min(fraction, 1.0), count,
                                  unit_, rate, rate < 10 ? 2 : 0, left);
    if (terminal_) {
        constexpr int width = 28;
        const int full = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
        std::string bar;
        for (int i = 0; i < width; ++i) bar += i < full ? "█" : "░";
        write_to_stderr(fmt::format("\r\033[K{} {} {}", label_, bar, text));
    } else {
        write_to_stderr(fmt::format("{} {}\n", label_, text));
    }
    std::fflush(stderr);
    drawn_ = true;
}

void Progress::clear() {
    if (drawn_ && terminal_) write_to_stderr("\r\033[K");
    drawn_ = false;
}

}  // namespace actformer::cli
