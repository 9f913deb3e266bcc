// Keeping other processes out of a file or a folder.
#pragma once

#include <filesystem>
#include <optional>

#include "base/files/descriptor.hpp"

namespace actformer {

/// Held while it lives, by way of a file that stays there. It goes with the process that holds it, killed or not. Where the file
/// system knows no locks nobody is kept out.
class FileLock {
  public:
    /// Waits for whoever holds it. Where `path` cannot be made nobody is kept out.
    explicit FileLock(const std::filesystem::path& path);

    /// None where another process holds it. Where one that held it has just removed the file, on a new one. Throws Error where `path`
    /// cannot be made.
    static std::optional<FileLock> if_free(const std::filesystem::path& path);

    /// On a folder itself, which is made where there is none: no file of its own lies in it. None where another process holds it.
    /// Throws Error where the folder cannot be made.
    static std::optional<FileLock> on_folder_if_free(const std::filesystem::path& folder);

    /// Whether some process holds it now. Makes no file.
    static bool is_held(const std::filesystem::path& path);

  private:
    FileLock() = default;
    Descriptor file_;
};

}  // namespace actformer
