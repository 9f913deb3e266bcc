// A folder that is gone when it is no longer needed.
#pragma once

#include <filesystem>
#include <string>

namespace actformer {

/// A new folder of its own, removed with all that is in it.
class Scratch {
  public:
    /// Below `where`, or the system's place for such things; `purpose` is part of its name. Throws Error where none can be made.
    explicit Scratch(const std::string& purpose, const std::filesystem::path& where = {});
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace actformer
