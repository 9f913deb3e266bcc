// What sweeps and trainings have measured, read back from their folders (reports/sweep/results.hpp says how they lie there).
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/origin.hpp"
#include "reports/tables/paper_tables.hpp"

namespace actformer::reports {

/// One seed of a row. Whole paths; empty where the sweep names none. What they name may have gone since.
struct MeasuredRun {
    std::uint64_t seed = 0;
    std::string status,
        why;  ///< "done", "failed", "running", "waiting" or, of a training by itself, "stopped"; why of a failure
    std::filesystem::path scores, features, motions, run, recogniser, dataset;
    nlohmann::ordered_json
        scored;  ///< what `actformer score` wrote; null unless the run is done and it can be read
};

struct MeasuredRow {
    std::string sweep, name, status, why;
    std::optional<std::size_t> comparison;  ///< of the folders read, the place of its comparison's
    std::vector<std::string> fills;         ///< cells, see find_cell()
    std::string dataset, split;
    std::string data;                 ///< in plain words, what `dataset` is
    ingest::DataOrigin origin;        ///< of `dataset`, as the scores tell it
    nlohmann::ordered_json settings;  ///< key: value, as the sweep file has them
    std::vector<MeasuredRun> runs;

    /// The run that stands for the row where only one can be shown; null where none has scores.
    const MeasuredRun* shown() const;

    /// The run whose curves stand for the row: shown()'s, else the first with a log, else the first; null where there is none.
    const MeasuredRun* trained() const;
};

struct Measured {
    std::vector<MeasuredRow> rows;
    std::vector<std::string> notices;                 ///< what is missing or cannot be read, a line each
    std::vector<PaperTable> tables = paper_tables();  ///< with the sweeps' own
};

/// Reads OUT/results.json of every folder and the scores that it names; the folder of a training is a row of its own. Throws Error for
/// any other folder, for one that is given twice, and for results that are damaged or of another format, and for two tables of one name with other columns; scores that are missing or damaged become notices.
Measured read_measured(const std::vector<std::filesystem::path>& folders);

}  // namespace actformer::reports
