// What an ingest has finished so far: OUT.partial/journal. Its first line is the request, then comes a line of JSON for every tranche. Each
// line begins with the checksum of itself and of all lines before it, and tells the checksums of the shards' bytes. A run
// that was killed goes on behind the last line that is right and whose shards are. Shards that are written anew at the end, all lines
// being there, have their later checksums in OUT.partial/announced.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/files/lock.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// What gave no clip, of a file or all of it.
struct LeftOut {
    std::string path;
    Rejection rejection;

    bool is_broken() const { return rejection.kind == Rejection::Kind::broken; }
    std::string text() const { return path + ": " + rejection.reason; }
};

/// A clip that was kept although something about it is doubtful.
struct Doubtful {
    std::size_t dataset = 0;
    std::string doubt, clip;
};

/// A shard in the working folder.
struct KeptShard {
    ShardEntry entry;      ///< with its path below Workplace::data()
    std::string checksum;  ///< of its bytes
};

/// What became of one tranche of raw files.
struct Tranche {
    std::uint64_t files = 0, text_bytes = 0;
    std::string fingerprint;  ///< of all raw text up to its end
    std::vector<LeftOut> left_out;
    std::vector<Doubtful> doubts;
    std::vector<std::pair<std::size_t, KeptShard>> shards;  ///< dataset number, shard
    std::vector<std::string> names;                         ///< of the clips kept
    std::set<std::pair<std::size_t, std::uint32_t>>
        labels;  ///< dataset number, label: those that clips kept have
    std::map<std::pair<std::size_t, std::string>, std::uint64_t>
        splits;  ///< dataset number, split: how many of the clips kept are in it
};

/// The working folder, as workplace_of() tells it, held by one process at a time.
class Workplace {
  public:
    /// Opens or makes `folder`, for work on so many datasets. Work that an earlier run left for another `request` (settings and raw
    /// files) is thrown away, and what is no longer as it was written. Throws Error where another process holds it, and where something lies there that no
    /// ingest left.
    Workplace(std::filesystem::path folder, const std::string& request, std::size_t datasets);

    const std::vector<Tranche>& finished() const { return finished_; }

    /// What was thrown away of an earlier run's work, and why; a line each.
    const std::vector<std::string>& notes() const { return notes_; }
    std::filesystem::path data() const { return folder_ / "data"; }

    /// The shards of `tranche` are in place: note it down.
    void finish(Tranche tranche);

    /// Shards, whatever tranche they are of, may from here on have bytes of these checksums as well.
    void announce(const std::map<std::filesystem::path, std::string>& to_be);

    /// Moves data() to `out`, whole and on the disk, and removes what is left.
    void deliver(const std::filesystem::path& out);

    /// Removes everything, unless somebody has put something of theirs there.
    void discard();

  private:
    void load(const std::string& request);
    bool take_line(const std::string& line, std::size_t number);
    std::string fault_of(const Tranche& tranche) const;
    void read_announced();
    void remove_unfinished() const;
    void start_afresh(const std::string& request);
    std::string line_for(const std::string& text);

    std::filesystem::path folder_;
    std::size_t datasets_;
    std::optional<FileLock> lock_;
    std::vector<Tranche> finished_;
    std::vector<std::string> notes_;
    std::map<std::filesystem::path, std::string>
        announced_;    ///< shards below data() and the checksums that their bytes may have as well
    std::string sum_;  ///< of the journal's lines so far
};

}  // namespace actformer::ingest
