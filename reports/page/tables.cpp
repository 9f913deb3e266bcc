#include "reports/page/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.hpp"
#include "base/text/counted.hpp"
#include "base/text/loose_json.hpp"
#include "eval/metrics/confusion.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> repeats_of(const MeasuredRun& run, const ColumnMetric& metric) {
    std::vector<double> values;
    for (const auto& value : loose::list(loose::member(run.scored, metric.name.c_str()), "repeats"))
        if (value.is_number()) values.push_back(metric.scale * value.get<double>());
    return values;
}

/// What a row has measured of a metric.
Figures figures_of(const MeasuredRow& row, const ColumnMetric& metric) {
    Figures out;
    std::vector<double> seeds, repeats;
    for (const auto& run : row.runs)
        if (const auto of_it = repeats_of(run, metric); !of_it.empty()) {
            repeats.insert(repeats.end(), of_it.begin(), of_it.end());
            seeds.push_back(eval::interval(of_it).mean);
        }
    out.repeats = repeats.size();
    out.over_seeds = seeds.size() > 1;
    out.values = out.over_seeds ? std::move(seeds) : std::move(repeats);
    if (!out.values.empty()) out.measured = eval::interval(out.values);
    return out;
}

/// What real motions come to, the mean over all runs whose scores tell.
std::optional<double> real_value(const MeasuredRow& row, const ColumnMetric& metric) {
    double sum = 0, count = 0;
    for (const auto& run : row.runs)
        if (const auto& value = loose::member(loose::member(run.scored, "real"), metric.name.c_str());
            value.is_number()) {
            sum += metric.scale * value.get<double>();
            ++count;
        }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

CellState state_of(const MeasuredRow& row) {
    if (row.shown()) return CellState::measured;
    return row.status == "failed" ? CellState::failed : CellState::waiting;
}

FilledTable empty_table(const PaperTable& paper) {
    FilledTable table{&paper, {}, false};
    for (const auto& row : paper.rows) {
        auto& groups = table.rows.emplace_back(paper.columns.size());
        for (std::size_t c = 0; c < paper.columns.size(); ++c)
            for (const auto& figure : row.figures[c]) groups[c].figures.emplace_back().paper = figure;
    }
    return table;
}

/// One metric of one dataset, over all rows.
struct Column {
    FilledTable& table;
    std::size_t dataset, metric;

    Figures& at(std::size_t row) { return table.rows[row][dataset].figures[metric]; }
    eval::Direction better() const { return table.paper->columns[dataset].metrics[metric].better; }
};

/// How far the values of a row are from the best that there is.
struct Candidate {
    std::size_t row;
    std::vector<double> distances;
    bool over_seeds;  ///< of trainings, rather than of sets of motions that one generator made
};

double mean_of(const Candidate& candidate) {
    return eval::interval(candidate.distances).mean;
}

/// Rows that can be compared, best first; `values` gives a row's numbers, `real` what real motions have beside them. The row of real
/// motions is no candidate.
template <typename Values, typename Real>
std::vector<Candidate> candidates(Column column, Values values, Real real) {
    std::vector<Candidate> out;
    for (std::size_t r = 0; r < column.table.rows.size(); ++r) {
        const std::vector<double> mine = values(column.at(r));
        const std::optional<double> ideal = real(column.at(r));
        const bool comparable = ideal || column.better() != eval::Direction::nearest_real;
        const bool finite = std::ranges::all_of(mine, [](double value) { return std::isfinite(value); });
        if (mine.empty() || !finite || !comparable || column.table.paper->real == r) continue;
        auto& candidate = out.emplace_back(Candidate{r, {}, column.at(r).over_seeds});
        for (const double value : mine)
            candidate.distances.push_back(distance_from_best(column.better(), value, ideal.value_or(0)));
    }
    std::ranges::stable_sort(out, {}, mean_of);
    return out;
}

/// Chance alone is not enough to make `one` that much further away than `best`. Sets of motions are paired, as the i-th of every generator
/// has the same seed; trainings of different networks have nothing in common.
bool surely_further(const Candidate& one, const Candidate& best) {
    const bool paired = !one.over_seeds && !best.over_seeds && one.distances.size() == best.distances.size();
    const auto further = paired ? eval::paired_difference(best.distances, one.distances)
                                : eval::difference(best.distances, one.distances);
    return further.half_width && further.mean > *further.half_width;
}

void mark_best(Column column) {
    const auto printed = [](const Figures& f) {
        return f.paper.value ? std::vector{*f.paper.value} : std::vector<double>();
    };
    const auto real_row = column.table.paper->real;
    std::optional<double> measured_real, printed_real;
    if (real_row && column.at(*real_row).measured) measured_real = column.at(*real_row).measured->mean;
    if (real_row) printed_real = column.at(*real_row).paper.value;

    const auto in_paper = candidates(column, printed, [&](const Figures&) { return printed_real; });
    for (const auto& one : in_paper)
        if (mean_of(one) == mean_of(in_paper[0])) column.at(one.row).paper_best = true;

    const auto measured = candidates(
        column, [](const Figures& f) { return f.values; },
        [&](const Figures& f) { return f.real ? f.real : measured_real; });
    if (measured.size() > 1)
        column.at(measured[0].row).best =
            std::all_of(measured.begin() + 1, measured.end(),
                        [&](const Candidate& one) { return surely_further(one, measured[0]); });
}

/// The first of a group's figures that was measured; empty where none was.
Figures first_measured(const CellGroup& group) {
    const auto is_measured = [](const Figures& figures) { return figures.measured.has_value(); };
    const auto found = std::ranges::find_if(group.figures, is_measured);
    return found == group.figures.end() ? Figures() : *found;
}

/// What the scores say of where they come from.
void add_score_lines(const Json& scored, std::vector<std::string>& lines) {
    const auto& from = loose::member(scored, "provenance");
    const auto &real = loose::member(from, "real"), &recogniser = loose::member(from, "recogniser");
    if (!loose::member(real, "fingerprint").is_null())
        lines.push_back(fmt::format("real side: {}, split {}, fingerprint {}", loose::text(real, "dataset"),
                                    loose::text(real, "split"),
                                    loose::text(real, "fingerprint").substr(0, 16)));
    if (!loose::member(recogniser, "checksum").is_null())
        lines.push_back("recogniser: checksum " + loose::text(recogniser, "checksum").substr(0, 16));
    if (!loose::member(from, "version").is_null())
        lines.push_back("actformer " + loose::text(from, "version"));
}

}  // namespace

std::string near_chance(const MeasuredRow& row) {
    for (const auto& run : row.runs) {
        const auto& accuracy = loose::member(loose::member(run.scored, "real"), "accuracy");
        if (!accuracy.is_number()) continue;
        const auto classes = loose::list(run.scored, "per_class").size();
        if (auto said = eval::near_chance(accuracy.get<double>(), classes); !said.empty()) return said;
    }
    return {};
}

CellGroup measured_group(const PaperColumns& columns, const MeasuredRow& row) {
    CellGroup group{state_of(row), &row, std::vector<Figures>(columns.metrics.size()), near_chance(row)};
    for (std::size_t m = 0; m < columns.metrics.size(); ++m) {
        group.figures[m] = figures_of(row, columns.metrics[m]);
        group.figures[m].real = real_value(row, columns.metrics[m]);
    }
    return group;
}

void mark_best(FilledTable& table) {
    for (std::size_t c = 0; c < table.paper->columns.size(); ++c)
        for (std::size_t m = 0; m < table.paper->columns[c].metrics.size(); ++m)
            mark_best(Column{table, c, m});
}

std::vector<FilledTable> fill_tables(Measured& measured) {
    const auto& papers = measured.tables;
    std::vector<FilledTable> tables;
    for (const auto& paper : papers) tables.push_back(empty_table(paper));
    for (const auto& row : measured.rows)
        for (const auto& name : row.fills) {
            Cell cell;
            try {
                cell = find_cell(name, papers);
            } catch (const Error& error) {
                measured.notices.push_back(fmt::format("{}: {}", row.name, error.what()));
                continue;
            }
            const auto table = static_cast<std::size_t>(cell.table - papers.data());
            auto& group = tables[table].rows[cell.row][cell.columns];
            if (group.row)
                measured.notices.push_back(
                    fmt::format("{} is filled by ‘{}’ of {} and by ‘{}’ of {}: the latter is shown", name,
                                group.row->name, group.row->sweep, row.name, row.sweep));
            const auto printed = std::move(group.figures);
            group = measured_group(cell.table->columns[cell.columns], row);
            for (std::size_t m = 0; m < printed.size(); ++m) group.figures[m].paper = printed[m].paper;
        }
    for (auto& table : tables) mark_best(table);
    return tables;
}

bool FilledTable::has_rows() const {
    return std::ranges::any_of(rows, [](const auto& row) {
        return std::ranges::any_of(row, [](const CellGroup& group) { return group.row != nullptr; });
    });
}

const char* in_words(CellState state) {
    static constexpr const char* words[] = {"not run", "not finished", "failed", "measured"};
    return words[static_cast<std::size_t>(state)];
}

std::string over_what(const Figures& figures) {
    if (!figures.measured || !figures.measured->half_width) return "";
    return fmt::format("{} {}", figures.values.size(), figures.over_seeds ? "seeds" : "repeats");
}

std::string figure_text(double value) {
    const auto size = std::abs(value);
    if (size >= 1e5) return fmt::format("{:.3g}", value);
    if (size == 0 || size >= 0.1 || !std::isfinite(value)) return fmt::format("{:.2f}", value);
    return fmt::format("{:.2g}", value);
}

std::string paper_text(const PaperFigure& figure) {
    if (!figure.at_hand) return "not at hand";
    if (!figure.value) return "";
    const auto number = [](double value) {
        return std::abs(value) >= 1e5 ? fmt::format("{:.3g}", value) : fmt::format("{:.2f}", value);
    };
    return number(*figure.value) + (figure.half_width ? " ± " + number(*figure.half_width) : "");
}

std::string origin_of(const FilledTable& table, std::size_t dataset) {
    std::set<std::string> origins;
    for (const auto& row : table.rows)
        if (row[dataset].row) origins.insert(row[dataset].row->origin.text());
    origins.erase("");
    return fmt::format("{}", fmt::join(origins, "; "));
}

std::vector<std::string> near_chance_lines(const FilledTable& table) {
    std::vector<std::string> lines;
    for (std::size_t c = 0; c < table.paper->columns.size(); ++c) {
        std::map<std::string, std::vector<std::string>> rows;  // by what is said of them
        for (std::size_t r = 0; r < table.rows.size(); ++r)
            if (const auto& said = table.rows[r][c].near_chance; !said.empty())
                rows[said].push_back(table.paper->rows[r].name);
        for (const auto& [said, names] : rows)
            lines.push_back(
                fmt::format("{} ({}): {}", table.paper->columns[c].dataset, fmt::join(names, "; "), said));
    }
    return lines;
}

std::vector<std::string> provenance(const CellGroup& group) {
    std::vector<std::string> lines;
    if (!group.row) return lines;
    const auto& row = *group.row;
    lines.push_back(fmt::format("sweep {}, row {}", row.sweep, row.name));
    if (group.state == CellState::failed) lines.push_back("failed: " + row.why);
    std::string seeds;
    for (const auto& run : row.runs)
        if (!run.scored.is_null()) seeds += (seeds.empty() ? "" : ", ") + std::to_string(run.seed);
    const auto figures = first_measured(group);
    if (figures.repeats > 0)
        seeds += fmt::format("; {} of generation and scoring", counted(figures.repeats, "repeat"));
    if (!seeds.empty()) lines.push_back("seeds " + seeds);
    if (const auto over = over_what(figures); !over.empty()) lines.push_back("± over " + over);
    std::string settings;
    for (const auto& [key, value] : row.settings.items())
        settings += fmt::format("{}{}={}", settings.empty() ? "" : " ", key,
                                value.is_string() ? value.get<std::string>() : value.dump());
    if (!settings.empty()) lines.push_back("settings: " + settings);
    const auto origin = row.origin.text();
    lines.push_back("data " + row.data + (origin.empty() ? "" : " (" + origin + ")"));
    if (const auto* run = row.shown()) {
        if (!run->run.empty()) lines.push_back("run " + run->run.string());
        add_score_lines(run->scored, lines);
    }
    return lines;
}

}  // namespace actformer::reports
