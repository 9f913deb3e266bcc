// What `ingest ntu` and `ingest bvh` share: the options of every ingest, the run and its summary.
#pragma once

#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "ingest/pipeline/pipeline.hpp"

namespace actformer::cli {

struct IngestOptions {
    std::vector<std::string> raw;
    std::string out, device;
    unsigned threads = 0;
    bool strict = false, json = false;
};

/// RAW..., -o, --device, --threads, --strict, --json.
void add_ingest_options(CLI::App* command, IngestOptions& options);

/// Runs with a progress bar and prints what came of it. `one_dataset` as in IngestRequest.
void run_ingest(const IngestOptions& options, const ingest::Format& format, bool one_dataset,
                std::unordered_set<std::string> missing = {});

void add_ingest_ntu(CLI::App& ingest);
void add_ingest_bvh(CLI::App& ingest);

}  // namespace actformer::cli
