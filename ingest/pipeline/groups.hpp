// Cutting a source into groups, which are in memory as text together, and tranches, which are written together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/pipeline/source.hpp"

namespace actformer::ingest {

// A tranche is what one kill can lose, and what one shard a dataset is made of; a group is what is in memory as text.
inline constexpr std::uint64_t files_a_tranche = 4096, bytes_a_tranche = std::uint64_t{96} << 20;
inline constexpr std::uint64_t files_a_group = 256, bytes_a_group = std::uint64_t{48} << 20;

/// One raw file on its way through a group.
struct Item {
    RawFile file;
    std::string checksum;           ///< of its text
    std::vector<ParsedClip> clips;  ///< parsed and not yet taken, in the file's order
    std::size_t bytes = 0;          ///< of these
    bool done = false;              ///< the file holds no more
    double read_seconds = 0, parse_seconds = 0;
};

struct Group {
    std::vector<Item> items;
    bool ends_tranche = false;
    double fraction = 0;  ///< of the source that has been read with it
};

/// Cuts the source into groups and tranches.
class Groups {
  public:
    Groups(Source& source, double total) : source_(source), total_(total) {}

    bool next(Group& group) {
        group = {};
        std::uint64_t bytes = 0;
        while (more() && group.items.size() < files_a_group && bytes < bytes_a_group && !group.ends_tranche) {
            bytes += ahead_.size;
            tranche_bytes_ += ahead_.size;
            group.items.push_back({std::move(ahead_), {}, {}, 0, false, 0, 0});
            have_ahead_ = false;
            group.ends_tranche = ++tranche_files_ >= files_a_tranche || tranche_bytes_ >= bytes_a_tranche;
        }
        if (!more()) group.ends_tranche = true;
        if (group.ends_tranche) tranche_files_ = tranche_bytes_ = 0;
        group.fraction = total_ > 0 ? static_cast<double>(source_.bytes_read()) / total_ : 1;
        return !group.items.empty();
    }

  private:
    bool more() { return have_ahead_ || (have_ahead_ = source_.next(ahead_)); }

    Source& source_;
    double total_;
    RawFile ahead_;
    bool have_ahead_ = false;
    std::uint64_t tranche_files_ = 0, tranche_bytes_ = 0;
};

}  // namespace actformer::ingest
