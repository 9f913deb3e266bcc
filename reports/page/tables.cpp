#include "reports/page/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "eval/scoring/score_report.hpp"
#include "reports/sweep/reading.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;

/// The repeats of one metric over all runs that have scores.
std::vector<double> repeats_of(const MeasuredRow& row, const std::string& metric) {
    std::vector<double> values;
    const double scale = metric == "accuracy" ? 100 : 1;
    for (const auto& run : row.runs)
        for (const auto& value : list(member(run.scored, metric.c_str()), "repeats"))
            if (value.is_number()) values.push_back(scale * value.get<double>());
    return values;
}

CellState state_of(const MeasuredRow& row) {
    if (row.shown()) return CellState::measured;
    return row.status == "failed" ? CellState::failed : CellState::waiting;
}

void fill(CellGroup& group, const PaperColumns& columns, const MeasuredRow& row) {
    group.row = &row;
    group.state = state_of(row);
    for (std::size_t m = 0; m < columns.metrics.size(); ++m) {
        const auto values = repeats_of(row, columns.metrics[m]);
        auto& figures = group.figures[m];
        figures.repeats = values.size();
        figures.measured = values.empty() ? std::nullopt : std::optional(eval::interval(values));
    }
}

FilledTable empty_table(const PaperTable& paper) {
    FilledTable table{&paper, {}};
    for (const auto& row : paper.rows) {
        auto& groups = table.rows.emplace_back(paper.columns.size());
        for (std::size_t c = 0; c < paper.columns.size(); ++c) {
            groups[c].figures.resize(paper.columns[c].metrics.size());
            for (std::size_t m = 0; m < row.figures[c].size(); ++m)
                groups[c].figures[m].paper = row.figures[c][m];
        }
    }
    return table;
}

/// Marks the figures whose value, which `of` gives where there is one, is the best of all rows'.
template <typename Of>
void mark_best(FilledTable& table, std::size_t column, std::size_t metric, Of of, bool Figures::*mark) {
    const double sign = smaller_is_better(table.paper->columns[column].metrics[metric]) ? 1 : -1;
    std::optional<double> best;
    const auto value = [&](const std::vector<CellGroup>& row) -> std::optional<double> {
        return of(row[column].figures[metric]);
    };
    for (const auto& row : table.rows)
        if (const auto v = value(row); v && (!best || sign * *v < sign * *best)) best = v;
    for (auto& row : table.rows)
        if (const auto v = value(row); v && *v == *best) row[column].figures[metric].*mark = true;
}

void mark_best(FilledTable& table) {
    const auto measured = [](const Figures& f) {
        return f.measured && std::isfinite(f.measured->mean) ? std::optional(f.measured->mean) : std::nullopt;
    };
    for (std::size_t c = 0; c < table.paper->columns.size(); ++c)
        for (std::size_t m = 0; m < table.paper->columns[c].metrics.size(); ++m) {
            mark_best(table, c, m, measured, &Figures::best);
            mark_best(
                table, c, m, [](const Figures& f) { return f.paper; }, &Figures::paper_best);
        }
}

/// What the scores say of where they come from.
void add_score_lines(const Json& scored, std::vector<std::string>& lines) {
    const auto& from = member(scored, "provenance");
    const auto &real = member(from, "real"), &eyes = member(from, "recogniser");
    if (!member(real, "fingerprint").is_null())
        lines.push_back(fmt::format("real side: {}, split {}, fingerprint {}", text(real, "dataset"),
                                    text(real, "split"), text(real, "fingerprint").substr(0, 16)));
    if (!member(eyes, "checksum").is_null())
        lines.push_back("recogniser: checksum " + text(eyes, "checksum").substr(0, 16));
    if (!member(from, "version").is_null()) lines.push_back("actformer " + text(from, "version"));
}

}  // namespace

std::vector<FilledTable> fill_tables(Measured& measured) {
    std::vector<FilledTable> tables;
    for (const auto& paper : paper_tables()) tables.push_back(empty_table(paper));
    for (const auto& row : measured.rows)
        for (const auto& name : row.fills) {
            Cell cell;
            try {
                cell = find_cell(name);
            } catch (const Error& error) {
                measured.notices.push_back(fmt::format("{}: {}", row.name, error.what()));
                continue;
            }
            const auto table = static_cast<std::size_t>(cell.table - paper_tables().data());
            auto& group = tables[table].rows[cell.row][cell.columns];
            if (group.row)
                measured.notices.push_back(
                    fmt::format("{} is filled by ‘{}’ of {} and by ‘{}’ of {}: the latter is shown", name,
                                group.row->name, group.row->sweep, row.name, row.sweep));
            fill(group, cell.table->columns[cell.columns], row);
        }
    for (auto& table : tables) mark_best(table);
    return tables;
}

const char* in_words(CellState state) {
    static constexpr const char* words[] = {"not run", "not finished", "failed", "measured"};
    return words[static_cast<std::size_t>(state)];
}

std::string heading_of(const std::string& metric) {
    if (metric == "accuracy") return "Acc. %";
    const auto* found = eval::find_metric(metric);
    return found ? std::string(found->heading) : metric;
}

bool smaller_is_better(const std::string& metric) {
    const auto* found = eval::find_metric(metric);
    return found && found->direction == eval::Direction::lower;
}

std::string figure_text(double value) {
    const auto size = std::abs(value);
    if (size == 0 || size >= 0.1 || !std::isfinite(value)) return fmt::format("{:.2f}", value);
    return fmt::format("{:.2g}", value);
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
    lines.push_back("data " + row.data);
    if (const auto* run = row.shown()) {
        if (!run->run.empty()) lines.push_back("run " + run->run.string());
        add_score_lines(run->scored, lines);
    }
    return lines;
}

}  // namespace actformer::reports
