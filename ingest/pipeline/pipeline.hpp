// From raw files to datasets: reads, parses, cleans and writes shards, a tranche of files at a time, and goes on
// after an interruption where the last whole tranche ended.
//
//   Source -> [survey, where the format asks for it]
//   Source -> [parse on every core] -> [clean on the device] -> ShardBuilder -> shard file, journal line
//
// All is put together in OUT.partial and renamed to OUT at the end. How files fall into tranches depends on the source alone, so
// an interrupted and resumed run ends in the same bytes as an undisturbed one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

struct IngestRequest {
    std::vector<std::filesystem::path> raw;
    std::filesystem::path out;
    bool strict = false;       ///< a broken clip is an error
    bool one_dataset = false;  ///< OUT itself is the dataset, in place of OUT/NAME
    unsigned threads = 0;      ///< 0: all cores
    std::optional<DataOrigin::Kind>
        origin;  ///< of the motion; none: as a file ORIGIN in or beside RAW tells, else as the format has it
    std::function<void(double fraction, std::uint64_t clips)> progress;
};

/// Splits of a dataset, in its order, and how many clips are in each.
using SplitCounts = std::vector<std::pair<std::string, std::uint64_t>>;

struct IngestSummary {
    struct PerDataset {
        std::string folder;
        std::uint64_t clips = 0, frames = 0, bytes = 0;
        std::size_t shards = 0, classes = 0;
        SplitCounts splits{};
    };
    std::uint64_t files = 0, text_bytes = 0;
    std::map<std::string, std::uint64_t> left_out;  ///< kind of rejection -> how many
    std::vector<PerDataset> datasets;
    std::vector<std::string> first_rejections;  ///< a few, "path: reason", for the eye
    std::vector<std::string> remarks;           ///< on the data as a whole

    /// What is doubtful about clips that were kept.
    struct Doubt {
        std::string what;
        std::uint64_t clips = 0;
        std::vector<std::string> first;  ///< names of a few of them
    };
    std::vector<Doubt> doubts;        ///< of all datasets
    bool was_complete = false;        ///< OUT had been finished by an earlier run of the same request
    std::uint64_t resumed_files = 0;  ///< taken over from an interrupted run
    std::vector<std::string>
        made_again;  ///< of an interrupted run, what was not as it was written; a line each

    /// Core-seconds a stage took, of this run: where the time goes. Stages overlap, so they add up to more than `wall`.
    struct Seconds {
        double walk = 0, read = 0, parse = 0, clean = 0, write = 0, wall = 0;
    } seconds;
};

/// As in "2 clips: nothing moves (walk_1, walk_7)".
std::string to_line(const IngestSummary::Doubt& doubt);

/// Throws Error where nothing could be ingested, something wider than a clip is wrong, or OUT is taken.
IngestSummary ingest(const IngestRequest& request, Format& format, kernels::Device& device);

/// "broken", "dropped", "missing", "duplicate"
std::string_view kind_name(Rejection::Kind kind);

}  // namespace actformer::ingest
