// The paper's tables with what was measured in their cells.
#pragma once

#include <optional>

#include "eval/metrics/interval.hpp"
#include "reports/page/measured.hpp"
#include "reports/tables/paper_tables.hpp"

namespace actformer::reports {

/// One metric, scaled as its table prints it.
struct Figures {
    std::optional<eval::Interval> measured;
    std::vector<double>
        values;  ///< what that is the mean of: one a seed that was trained, its repeats' mean, or the repeats of a single one
    std::size_t repeats = 0;  ///< of all seeds
    bool over_seeds = false;
    std::optional<double> real;  ///< of real motions, where the scores tell
    PaperFigure paper;
    /// Of the table's column, by the metric's direction: better than each of the others by a difference whose 95 % interval holds no 0 (Welch's
    /// over trainings, of paired sets of motions otherwise); and the best of those that the paper prints.
    bool best = false, paper_best = false;
};

enum class CellState { not_run, waiting, failed, measured };

/// "not run", "not finished", "failed", "measured"
const char* in_words(CellState state);

/// What one row of a table has on one dataset.
struct CellGroup {
    CellState state = CellState::not_run;
    const MeasuredRow* row = nullptr;  ///< null where nothing fills the cells
    std::vector<Figures> figures;      ///< as PaperColumns::metrics
    std::string near_chance;           ///< see near_chance()
};

struct FilledTable {
    const PaperTable* paper = nullptr;
    std::vector<std::vector<CellGroup>> rows;  ///< (paper rows, datasets)
    bool all_rows = false;                     ///< no paper's: all rows that were measured on one dataset

    /// Whether a row of a sweep fills any of it.
    bool has_rows() const;
};

/// What eval::near_chance() says of the recogniser that a row was scored with, by its accuracy on real motions; of several runs, the
/// first that it says anything of. Empty where it says nothing, and where the scores do not tell.
std::string near_chance(const MeasuredRow& row);

/// What a row has measured of a table's columns.
CellGroup measured_group(const PaperColumns& columns, const MeasuredRow& row);

/// "3 seeds", "5 repeats": what an interval is over; empty without one.
std::string over_what(const Figures& figures);

/// Marks the best of every column, measured and printed.
void mark_best(FilledTable& table);

/// Of all tables, whether anything fills them or not. Points into `measured`, whose notices get a line for every cell that is not one, or
/// that two rows fill: the one read last counts.
std::vector<FilledTable> fill_tables(Measured& measured);

/// Two digits after the point, as papers have them; more of a number below 0.1, three in all from 100,000 on.
std::string figure_text(double value);

/// "42.01", "98.80 ± 0.10", "not at hand"; empty where the paper prints none.
std::string paper_text(const PaperFigure& figure);

/// What the motions of a table's column `dataset` are: "stand-in, generic skeleton"; several where its rows were measured on
/// several; empty where none tells.
std::string origin_of(const FilledTable& table, std::size_t dataset);

/// What near_chance() says, a line each dataset and recogniser, with the table's rows that it is said of: "NTU-1P (full; fixed PE): the
/// recogniser is right on ..".
std::vector<std::string> near_chance_lines(const FilledTable& table);

/// Where a group's figures come from, a line each: sweep, row and seeds, settings, data and its fingerprint, recogniser, version.
std::vector<std::string> provenance(const CellGroup& group);

}  // namespace actformer::reports
