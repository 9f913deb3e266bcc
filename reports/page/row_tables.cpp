#include "reports/page/row_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "base/text/loose_json.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<const MeasuredRow*>;

/// What the scores say of the real motions' provenance; null where they do not tell.
const Json& of_real_side(const MeasuredRow& row, const char* key) {
    return loose::member(loose::member(loose::member(row.shown()->scored, "provenance"), "real"), key);
}

/// Frames of the real windows.
const Json& window_of(const MeasuredRow& row) {
    return of_real_side(row, "window");
}

std::string in_windows(const Json& frames) {
    return frames.is_number_unsigned() ? fmt::format(", windows of {} frames", frames.get<std::uint64_t>())
                                       : "";
}

/// Against what, and by which recogniser a row was scored: figures of others are not to be held against its own.
using Against = std::tuple<std::string, std::string, std::string, std::string, std::string, std::string>;

Against against(const MeasuredRow& row) {
    const auto& provenance = loose::member(row.shown()->scored, "provenance");
    std::string recognisers;
    for (const char* which : {"recogniser", "single_recogniser"})
        recognisers += loose::member(loose::member(provenance, which), "checksum").dump();
    return {row.sweep,   row.dataset,          row.split, of_real_side(row, "fingerprint").dump(),
            recognisers, window_of(row).dump()};
}

/// Those with scores, in the order in which they come.
std::vector<Rows> held_together(const Measured& measured) {
    std::map<Against, std::size_t> places;
    std::vector<Rows> out;
    for (const auto& row : measured.rows) {
        if (!row.shown()) continue;
        const auto [place, fresh] = places.emplace(against(row), out.size());
        if (fresh) out.emplace_back();
        out[place->second].push_back(&row);
    }
    return out;
}

bool has(const MeasuredRow& row, std::string_view metric) {
    return std::ranges::any_of(row.runs, [&](const MeasuredRun& run) {
        return loose::member(loose::member(run.scored, std::string(metric).c_str()), "mean").is_number();
    });
}

std::vector<ColumnMetric> metrics_of(const Rows& rows) {
    std::vector<ColumnMetric> out;
    for (const auto& metric : eval::metrics())
        if (std::ranges::any_of(rows, [&](const auto* row) { return has(*row, metric.name); }))
            out.emplace_back(metric);
    return out;
}

/// What the scores of real motions, or of real ones against others, say; the mean over all runs that tell.
std::optional<double> of_real_motions(const Rows& rows, const ColumnMetric& metric) {
    double sum = 0, count = 0;
    for (const auto* row : rows)
        for (const auto& run : row->runs)
            for (const char* side : {"real", "floor"})
                if (const auto& value = loose::member(loose::member(run.scored, side), metric.name.c_str());
                    value.is_number()) {
                    sum += metric.scale * value.get<double>();
                    ++count;
                    break;
                }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

PaperTable empty_table(const Rows& rows, std::size_t number) {
    PaperTable out;
    out.id = fmt::format("rows{}", number);
    out.title = fmt::format("Rows on {}", rows[0]->dataset);
    const auto by = loose::text(rows[0]->settings, "recogniser");
    out.caption = fmt::format("All that was scored by {}, split {}{}",
                              by.empty() ? "one recogniser" : "the recogniser " + by, rows[0]->split,
                              in_windows(window_of(*rows[0])));
    out.source = fmt::format(
        "Sweep {}: means and their 95 % intervals, over seeds where several were trained", rows[0]->sweep);
    out.columns = {{rows[0]->dataset, metrics_of(rows)}};
    const std::vector<std::vector<PaperFigure>> none{std::vector<PaperFigure>(out.columns[0].metrics.size())};
    for (const auto* row : rows) out.rows.push_back({row->name, none});
    out.real = out.rows.size();
    out.rows.push_back({"real motions", none});
    return out;
}

CellGroup real_group(const Rows& rows, const PaperColumns& columns) {
    CellGroup out;
    out.state = CellState::measured;
    for (const auto* row : rows)
        if (out.near_chance.empty()) out.near_chance = near_chance(*row);
    for (const auto& metric : columns.metrics) {
        auto& figures = out.figures.emplace_back();
        if (const auto value = of_real_motions(rows, metric)) figures.measured = {*value, std::nullopt};
    }
    return out;
}

}  // namespace

RowTables::RowTables(const Measured& measured) {
    for (const auto& rows : held_together(measured)) {
        const auto& table = tables_.emplace_back(empty_table(rows, tables_.size() + 1));
        auto& filled = filled_.emplace_back(FilledTable{&table, {}, true});
        for (const auto* row : rows) filled.rows.push_back({measured_group(table.columns[0], *row)});
        filled.rows.push_back({real_group(rows, table.columns[0])});
        mark_best(filled);
    }
}

}  // namespace actformer::reports
