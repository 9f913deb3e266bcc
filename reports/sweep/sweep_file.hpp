// A sweep: which models are trained on which data, how they are scored, and which table cells that fills.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "reports/sweep/job.hpp"

namespace actformer::reports {

/// Ready (`path`), ingested from raw files (`raw`), or ingested from synthetic ones (`clips`).
struct SweepDataset {
    std::string path;
    std::string format = "ntu";  ///< of raw or synthetic clips, as `actformer ingest` lists them
    std::vector<std::string> raw;
    std::vector<std::string> arguments;  ///< more words for `actformer ingest`
    std::uint64_t clips = 0, seed = 1;   ///< synthetic
    std::string actions;                 ///< synthetic
    std::string use;                     ///< folder within what ingest makes, as in ntu-1p; empty: itself
};

/// Trained, or ready where `weights` says.
struct SweepRecogniser {
    std::string data, config, weights;
    Settings set;
};

/// A generator trained with each of `seeds`, or ready weights, or motions of another tool, and its scores.
struct SweepRow {
    std::string name, data, recogniser, single_recogniser, config;
    std::string weights;  ///< of a generator, or the folder of its training; in place of `config`
    std::vector<std::string>
        motions;  ///< in place of a generator, whatever `config` says: each file a repeat
    Settings set;
    std::vector<std::uint64_t> seeds{0, 1, 2};
    std::uint64_t repeats = 20, per_class = 100, window = 60;
    std::string split, device;       ///< split empty: the `train_split` of `set` or `config`, else "all"
    std::vector<std::string> fills;  ///< cells, see find_cell
};

struct Sweep {
    std::string name;
    std::string
        tables;  ///< of its own, and rows of its own in the papers' (see with_own_tables()); as YAML, empty without any
    std::map<std::string, SweepDataset> datasets;
    std::map<std::string, SweepRecogniser> recognisers;
    std::vector<SweepRow> rows;
    bool comparison = false;  ///< its rows are the two sides of `actformer compare`; files do not say it
};

/// Reads
///
///   name: mini
///   datasets:
///     one: {clips: 600, actions: "1-8", use: ntu-1p}
///   recognisers:
///     ntu-1p: {data: one, config: model/configs/recogniser-small.yaml, set: {epochs: 4}}
///   base: {data: one, recogniser: ntu-1p, config: model/configs/actformer-small.yaml, repeats: 3}
///   tables:                                                      # optional
///     table1: {rows: {Mine: {}}}                                  # or a whole table: see reports/tables/own_tables.hpp
///   rows:
///     mine: {motions: mine.h5, fills: [table1/Mine/NTU-1P]}       # made by another tool
///     full: {fills: [table1/ActFormer/NTU-1P, table3/full/NTU-1P]}
///     gaussian: {like: full, set: {prior: gaussian}, fills: [table3/Gaussian prior/NTU-1P]}
///
/// An entry takes what it does not say from the one it is `like` (of its own section), a row without `like` from `base`; `set` is
/// taken key by key (`width: ~` takes a width away, as a row of another method must), `fills` not at all. A key without a value
/// (`split: ~`) is not said: it takes what is inherited away. Throws Error naming file and line: unknown keys, keys that are given twice,
/// keys and settings that say nothing beside others, values of another kind, a circle of `like`, names that nothing has, unknown cells, a
/// cell filled twice.
Sweep read_sweep(const std::filesystem::path& file);

}  // namespace actformer::reports
