// XXH3-128: tells apart contents at memory speed; `xxhsum -H2` prints the same. It guards against accidents, not malice.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace actformer {

class Checksum {
  public:
    Checksum();
    ~Checksum();
    Checksum& add(std::string_view bytes);
    /// 32 hexadecimal digits of all that was added so far.
    std::string hex() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

std::string checksum(std::string_view bytes);

/// Throws Error where the file cannot be read.
std::string checksum_file(const std::filesystem::path& path);

}  // namespace actformer
