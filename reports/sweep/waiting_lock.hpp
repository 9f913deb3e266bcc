// Taking turns with other processes that work on the same sweep.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "base/files/lock.hpp"
#include "base/process/interruption.hpp"

namespace actformer::reports {

/// Waits for whoever holds the lock. None where a signal comes before. Throws Error where `path` cannot be made.
inline std::optional<FileLock> lock_when_free(const std::filesystem::path& path,
                                              const SafePoints& safe_points) {
    auto lock = FileLock::if_free(path);
    while (!lock && !safe_points.asked()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        lock = FileLock::if_free(path);
    }
    return lock;
}

}  // namespace actformer::reports
