// The tables that papers print: rows, columns and figures, a file each in reports/tables. The figures are only ever shown beside
// measured ones, never in place of them.
//
// To add a table:
//   1. Write reports/tables/NAME.yaml, as below, and build. The report shows it, `fills: [NAME/row/dataset]` in a sweep fills it.
//   2. Where a metric is new, add it to the metrics of scoring (eval/metrics) first.
//   3. Run test_reports: it reads all tables. A mistake is told with file and line.
//
//   title: Table 3
//   caption: Parts of the generator, single person
//   source: "ActFormer (Xu, Song et al., ICCV 2023), Table 3"
//   order: 3                                       # tables stand in the report by this number
//   metrics:                                       # only where this table prints one otherwise than scoring does
//     accuracy: {heading: Acc. %, scale: 100, better: higher}         # better: lower, higher or nearest to real
//   columns:
//     - {dataset: NTU-1P, metrics: [accuracy, fid_mean, diversity]}   # as in the scores' JSON
//   real: real motions                             # optional: the row that holds real motions; it is never marked as the best
//   rows:
//     real motions: {NTU-1P: [98.8 ± 0.1, -, 7.07]}                   # with half-widths of intervals; -: not printed there
//     full: {NTU-1P: [42.01, 12.53, not at hand]}                     # printed there, but nobody here has seen the figure
//     CSGN: {NTU-1P: not at hand}                                     # all of them
//     fixed PE: {}                                                    # the paper does not have this row on any dataset
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/tables/metric.hpp"

namespace actformer::reports {

/// One number of a paper, as printed: accuracies in per cent.
struct PaperFigure {
    std::optional<double> value;       ///< none: not printed, or not at hand
    std::optional<double> half_width;  ///< of the interval that is printed with it
    bool at_hand = true;
    bool operator==(const PaperFigure&) const = default;
};

/// A metric as a table prints it: as scoring does, or with a heading, scale and direction of the table's own.
struct ColumnMetric {
    explicit ColumnMetric(const eval::Metric& scored)
        : name(scored.name),
          heading(eval::heading_with_unit(scored)),
          scale(scored.scale),
          better(scored.direction) {}

    std::string name;     ///< in the scores' JSON: "fid_mean"
    std::string heading;  ///< "FIDm"
    double scale;         ///< printed = scale * measured: 100 for shares in per cent
    eval::Direction better;
};

/// Columns of one dataset, as in "NTU-1P": one a metric.
struct PaperColumns {
    std::string dataset;
    std::vector<ColumnMetric> metrics;
};

struct PaperRow {
    std::string name;
    std::vector<std::vector<PaperFigure>> figures;  ///< (datasets, metrics)
};

struct PaperTable {
    std::string id;  ///< the file's name without its ending: "table1"
    std::string title, caption, source;
    int order = 0;
    std::vector<PaperColumns> columns;
    std::vector<PaperRow> rows;
    std::optional<std::size_t> real;  ///< the row of real motions
};

/// All tables of reports/tables, which are part of the program, in their order.
const std::vector<PaperTable>& paper_tables();

/// The text of one file; `file` is its path, for messages, and gives the id. Throws Error naming file and line: unknown keys and metrics,
/// rows and datasets that come twice, figures that are no numbers or not one a metric.
PaperTable read_table(std::string_view yaml, const std::string& file);

/// What a run of one dataset fills: all metrics of a row there, "table3/full/NTU-1P".
struct Cell {
    const PaperTable* table = nullptr;
    std::size_t row = 0, columns = 0;
};

/// Throws Error naming the tables, rows or datasets that there are.
Cell find_cell(const std::string& name, const std::vector<PaperTable>& tables = paper_tables());

/// "Table 3 · full · NTU-1P"
std::string words_of(const Cell& cell);

}  // namespace actformer::reports
