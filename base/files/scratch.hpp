// A folder that is gone when it is no longer needed.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/files/descriptor.hpp"
#include "base/files/temporary.hpp"

namespace actformer {

/// A new folder of its own, removed with all that is in it, by a signal too. What a killed process left is removed by the next one that
/// makes such a folder in the same place.
class Scratch {
  public:
    /// Below `where`, or the system's place for such things; `purpose` is part of its name. Throws Error where none can be made.
    explicit Scratch(const std::string& purpose, const std::filesystem::path& where = {});
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    const std::filesystem::path& path() const { return folder_->path(); }

  private:
    std::unique_ptr<Temporary> folder_;
    Descriptor lock_;  ///< held on the folder itself: its process lives
};

}  // namespace actformer
