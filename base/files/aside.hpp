// A file that appears whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/files/temporary.hpp"

namespace actformer {

/// A file in the making, beside where it will be: "out.h5.partial" for "out.h5". Gone at the end unless commit() was called, and
/// with a signal that ends the program.
class Aside {
  public:
    /// Makes it, empty. `ending` comes last in its name, for libraries that go by it. Throws Error where nothing can be
    /// written at `path`.
    explicit Aside(std::filesystem::path path, const std::string& ending = {});
    ~Aside();
    Aside(const Aside&) = delete;
    Aside& operator=(const Aside&) = delete;

    const std::filesystem::path& partial() const { return partial_; }

    /// Gives the file its name; replaces what was there. Throws Error where that fails, or where what should be in it is
    /// not `complete`.
    void commit(bool complete = true);

  private:
    std::filesystem::path path_, partial_;
    std::optional<Temporary> temporary_;
    bool committed_ = false;
};

}  // namespace actformer
