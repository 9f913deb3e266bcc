#include "base/files/mapping_watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <iterator>
#include <utility>

#include "base/text/printable.hpp"

namespace actformer {

std::atomic<const MappingWatch::Mapping*> MappingWatch::watched[most];

void MappingWatch::end_with_line(int signal, siginfo_t* what, void* /*context*/) {
    const auto* at = static_cast<const char*>(what->si_addr);
    for (const auto& place : watched) {
        const auto* mapping = place.load();
        if (what->si_code != BUS_ADRERR || !mapping) continue;
        if (std::less<>()(at, mapping->begin) || !std::less<>()(at, mapping->begin + mapping->bytes))
            continue;
        [[maybe_unused]] const auto written =
            ::write(STDERR_FILENO, mapping->line.data(), mapping->line.size());
        ::_exit(1);
    }
    ::signal(signal, SIG_DFL);
    ::raise(signal);
}

MappingWatch::MappingWatch(const void* memory, std::size_t bytes, const std::filesystem::path& file)
    : mapping_(new Mapping{
          static_cast<const char*>(memory), bytes,
          fmt::format(
              "actformer: {}: cut short by another program while it was read; run the command again\n",
              printable(file.string()))}) {
    static const bool handled = [] {
        struct sigaction action {};
        action.sa_sigaction = end_with_line;
        action.sa_flags = SA_SIGINFO;
        return ::sigaction(SIGBUS, &action, nullptr) == 0;
    }();
    if (!handled) return;
    const auto take = [&](auto& place) {
        const Mapping* none = nullptr;
        return place.compare_exchange_strong(none, mapping_.get());
    };
    const auto* const end = std::end(watched);
    if (auto* const place = std::find_if(std::begin(watched), std::end(watched), take); place != end)
        place_ = place;
}

MappingWatch::~MappingWatch() {
    if (place_) place_->store(nullptr);
}

MappingWatch::MappingWatch(MappingWatch&& other) noexcept
    : mapping_(std::move(other.mapping_)), place_(std::exchange(other.place_, nullptr)) {}

MappingWatch& MappingWatch::operator=(MappingWatch&& other) noexcept {
    std::swap(mapping_, other.mapping_);
    std::swap(place_, other.place_);
    return *this;
}

}  // namespace actformer
