// Zip archives of stored members, written in one pass.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/aside.hpp"

namespace actformer::ingest {

/// The same members give the same bytes: times are the format's first, 1980-01-01. Sizes, places and counts beyond 32 and 16 bits
/// take zip64 (APPNOTE 4.3.14, 4.5.3), others do not.
class ZipWriter {
  public:
    explicit ZipWriter(const std::filesystem::path& path, Sync sync = Sync::now) : file_(path, sync) {}

    /// A member of these parts, one after the other. Names are UTF-8 and each its own.
    void add(const std::string& name, std::span<const std::string_view> parts);

    /// Writes the list of members; the archive appears at its path. Throws Error where not all of it could be written.
    void finish();

  private:
    struct Member {
        std::string name;
        std::uint32_t checksum = 0;
        std::uint64_t size = 0, offset = 0;
    };
    void put(std::string_view bytes);
    Aside file_;
    std::vector<Member> members_;
    std::uint64_t at_ = 0;
};

}  // namespace actformer::ingest
