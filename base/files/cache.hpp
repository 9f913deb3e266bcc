// The user's cache folder: results that can be computed again.
#pragma once

#include <filesystem>

namespace actformer {

/// $XDG_CACHE_HOME/actformer, or the same under ~/.cache.
std::filesystem::path cache_folder();

/// Held while it lives: another process that asks for the same lock waits. It goes with the process that holds it, killed or
/// not. Where the file system knows no locks nobody waits.
class FileLock {
  public:
    explicit FileLock(const std::filesystem::path& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    int file_ = -1;
};

}  // namespace actformer
