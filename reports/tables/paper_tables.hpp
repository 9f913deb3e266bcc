// Tables 1 to 5 as the ActFormer paper prints them (DESIGN 5): rows, columns and figures, in this one place. The figures are only
// ever shown beside measured ones, never in place of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace actformer::reports {

/// Columns of one dataset, as in "NTU-1P": one a metric, named as in the scores' JSON (eval/score_report.hpp).
struct PaperColumns {
    std::string dataset;
    std::vector<std::string> metrics;
};

struct PaperRow {
    std::string name;
    std::vector<std::vector<double>>
        figures;  ///< (column groups, metrics); an empty group has none. Accuracy in per cent
};

struct PaperTable {
    std::string id, title;  ///< "table1"
    std::vector<PaperColumns> columns;
    std::vector<PaperRow> rows;
};

const std::vector<PaperTable>& paper_tables();

/// What a run of one dataset fills: all metrics of a row there, "table3/full/NTU-1P".
struct Cell {
    const PaperTable* table = nullptr;
    std::size_t row = 0, columns = 0;
};

/// Throws Error naming the tables, rows or datasets that there are.
Cell find_cell(const std::string& name);

}  // namespace actformer::reports
