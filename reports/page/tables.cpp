#include "reports/page/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "base/text/loose_json.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;

/// The repeats of one metric over all runs that have scores.
std::vector<double> repeats_of(const MeasuredRow& row, const Metric& metric) {
    std::vector<double> values;
    for (const auto& run : row.runs)
        for (const auto& value : loose::list(loose::member(run.scored, metric.name.c_str()), "repeats"))
            if (value.is_number()) values.push_back(metric.scale * value.get<double>());
    return values;
}

/// What real motions come to, the mean over all runs whose scores tell.
std::optional<double> real_value(const MeasuredRow& row, const Metric& metric) {
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
    FilledTable table{&paper, {}};
    for (const auto& row : paper.rows) {
        auto& groups = table.rows.emplace_back(paper.columns.size());
        for (std::size_t c = 0; c < paper.columns.size(); ++c)
            for (const auto& figure : row.figures[c]) groups[c].figures.push_back({{}, 0, {}, figure});
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

/// Marks the rows whose value, which `value` gives where there is one, is the best; `real` gives what real motions have beside it. The
/// row of real motions is no candidate.
template <typename Value, typename Real>
void mark_best(Column column, Value value, Real real, bool Figures::*mark) {
    std::vector<std::optional<double>> distances(column.table.rows.size());
    std::optional<double> best;
    for (std::size_t r = 0; r < distances.size(); ++r) {
        const std::optional<double> mine = value(column.at(r)), ideal = real(column.at(r));
        const bool comparable = ideal || column.better() != eval::Direction::nearest_real;
        if (!mine || !std::isfinite(*mine) || !comparable || column.table.paper->real == r) continue;
        distances[r] = distance_from_best(column.better(), *mine, ideal.value_or(0));
        if (!best || *distances[r] < *best) best = distances[r];
    }
    for (std::size_t r = 0; r < distances.size(); ++r)
        if (distances[r] && *distances[r] == *best) column.at(r).*mark = true;
}

void mark_best(Column column) {
    const auto measured = [](const Figures& f) {
        return f.measured ? std::optional(f.measured->mean) : std::nullopt;
    };
    const auto printed = [](const Figures& f) { return f.paper.value; };
    const auto real_row = column.table.paper->real;
    const auto measured_real = real_row ? measured(column.at(*real_row)) : std::nullopt;
    const auto printed_real = real_row ? printed(column.at(*real_row)) : std::nullopt;
    mark_best(
        column, measured, [&](const Figures& f) { return f.real ? f.real : measured_real; }, &Figures::best);
    mark_best(
        column, printed, [&](const Figures&) { return printed_real; }, &Figures::paper_best);
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

CellGroup measured_group(const PaperColumns& columns, const MeasuredRow& row) {
    CellGroup group{state_of(row), &row, std::vector<Figures>(columns.metrics.size())};
    for (std::size_t m = 0; m < columns.metrics.size(); ++m) {
        const auto values = repeats_of(row, columns.metrics[m]);
        auto& figures = group.figures[m];
        figures.repeats = values.size();
        figures.measured = values.empty() ? std::nullopt : std::optional(eval::interval(values));
        figures.real = real_value(row, columns.metrics[m]);
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

const char* in_words(CellState state) {
    static constexpr const char* words[] = {"not run", "not finished", "failed", "measured"};
    return words[static_cast<std::size_t>(state)];
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

std::vector<std::string> provenance(const CellGroup& group) {
    std::vector<std::string> lines;
    if (!group.row) return lines;
    const auto& row = *group.row;
    lines.push_back(fmt::format("sweep {}, row {}", row.sweep, row.name));
    if (group.state == CellState::failed) lines.push_back("failed: " + row.why);
    std::string seeds;
    for (const auto& run : row.runs)
        if (!run.scored.is_null()) seeds += (seeds.empty() ? "" : ", ") + std::to_string(run.seed);
    if (!seeds.empty())
        lines.push_back(
            fmt::format("seeds {}; {} repeats of generation and scoring", seeds, group.figures[0].repeats));
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
