// What an ingest leaves beside its datasets: rejected.csv, and ingest.json, by which a second run knows that the work is done.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ingest/dataset/dataset_json.hpp"
#include "ingest/pipeline/journal.hpp"
#include "ingest/pipeline/pipeline.hpp"

namespace actformer::ingest {

/// What the output was made from.
struct Origin {
    std::string settings;
    std::string request;                ///< checksum of all that decides the output
    std::string fingerprint;            ///< of the raw text
    std::vector<std::string> not_read;  ///< as Source tells it; a later run finds it anew
};

/// Counts files and rejections into `summary`.
void add_up(const std::vector<Tranche>& tranches, IngestSummary& summary);
void add_dataset(const DatasetFile& file, const std::filesystem::path& folder, SplitCounts splits,
                 IngestSummary& summary);

/// The doubts about clips of one dataset.
std::vector<IngestSummary::Doubt> doubts_of(const std::vector<Tranche>& tranches, std::size_t dataset);

/// A line a file left out: file, kind, reason.
std::string rejected_csv(const std::vector<Tranche>& tranches);

/// [{"what", "clips", "first"}]
nlohmann::ordered_json doubts_json(const IngestSummary& summary);

/// [{"folder", "clips", "frames", "bytes", "shards", "classes"}]
nlohmann::ordered_json datasets_json(const IngestSummary& summary);

/// What ingest.json says; folders of datasets relative to `out`.
std::string record_text(const Origin& origin, const std::filesystem::path& out, const IngestSummary& summary);

/// True, and the summary restored, where OUT/ingest.json is there and was made by `request`.
bool read_record(const std::filesystem::path& out, const std::string& request, IngestSummary& summary);

}  // namespace actformer::ingest
