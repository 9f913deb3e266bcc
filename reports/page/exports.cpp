#include "reports/page/exports.hpp"

#include <fmt/format.h>

#include <set>
#include <tuple>

#include "base/text/csv.hpp"
#include "base/text/printable.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;

Json figures_json(const Figures& figures) {
    Json out{{"mean", nullptr},
             {"ci95", nullptr},
             {"over", over_what(figures)},
             {"repeats", figures.repeats},
             {"best", figures.best},
             {"paper", nullptr},
             {"paper_ci95", nullptr},
             {"paper_at_hand", figures.paper.at_hand}};
    if (figures.measured) {
        out["mean"] = figures.measured->mean;
        if (figures.measured->half_width) out["ci95"] = *figures.measured->half_width;
    }
    if (figures.paper.value) out["paper"] = *figures.paper.value;
    if (figures.paper.half_width) out["paper_ci95"] = *figures.paper.half_width;
    return out;
}

Json group_json(const CellGroup& group, const PaperColumns& columns) {
    Json out{{"dataset", columns.dataset}, {"state", in_words(group.state)}};
    out["origin"] = group.row ? group.row->origin.text() : "";
    out["near_chance"] = group.near_chance;
    out["provenance"] = provenance(group);
    for (std::size_t m = 0; m < columns.metrics.size(); ++m)
        out["metrics"][columns.metrics[m].name] = figures_json(group.figures[m]);
    return out;
}

/// mean,ci95,over,repeats,paper,paper_ci95; what there is not is empty.
std::string csv_figures(const Figures& figures) {
    const auto text = [](const std::optional<double>& value) {
        return value ? fmt::format("{}", *value) : std::string();
    };
    const auto& [measured, paper] = std::tie(figures.measured, figures.paper);
    return fmt::format("{},{},{},{},{},{}", measured ? fmt::format("{}", measured->mean) : "",
                       measured ? text(measured->half_width) : "", over_what(figures), figures.repeats,
                       paper.at_hand ? text(paper.value) : "not at hand", text(paper.half_width));
}

/// A group may have been scored without one of its metrics.
const char* state_of(const CellGroup& group, std::size_t metric) {
    const bool none = group.state == CellState::measured && !group.figures[metric].measured;
    return none ? "not measured" : in_words(group.state);
}

std::string latex_text(const std::string& text) {
    std::string out;
    for (const char c : printable(text)) {
        if (std::string_view("&%$#_{}").find(c) != std::string_view::npos)
            out += std::string("\\") + c;
        else if (c == '\\')
            out += "\\textbackslash{}";
        else if (c == '~' || c == '^')
            out += fmt::format("\\{}{{}}", c);
        else
            out += c;
    }
    return out;
}

/// A row's first cell: behind "\\" a bracket or an asterisk would be its argument.
std::string latex_row_name(const std::string& name) {
    return (name.starts_with('[') || name.starts_with('*') ? "{}" : "") + latex_text(name);
}

/// "FIDa_m" -> "FIDa$_m$"
std::string latex_heading(const ColumnMetric& metric) {
    const auto& text = metric.heading;
    const auto low = text.find('_');
    const auto* const arrow = metric.better == eval::Direction::lower    ? " $\\downarrow$"
                              : metric.better == eval::Direction::higher ? " $\\uparrow$"
                                                                         : " $\\rightarrow$";
    if (low == std::string::npos) return latex_text(text) + arrow;
    return latex_text(text.substr(0, low)) + "$_{" + latex_text(text.substr(low + 1)) + "}$" + arrow;
}

std::string latex_cell(const CellGroup& group, const Figures& figures) {
    if (group.state != CellState::measured || !figures.measured) return "--";
    auto out = figure_text(figures.measured->mean);
    if (figures.best) out = "\\textbf{" + out + "}";
    if (figures.measured->half_width)
        out += "{\\scriptsize\\,$\\pm$" + figure_text(*figures.measured->half_width) + "}";
    return out;
}

/// "NTU-2P (stand-in)"
std::string with_origin(const FilledTable& table, std::size_t column) {
    const auto origin = origin_of(table, column);
    const auto& name = table.paper->columns[column].dataset;
    return origin.empty() ? name : fmt::format("{} ({})", name, origin);
}

/// The paper's, what the motions of each column are, and which recognisers are near chance on real ones.
std::string latex_caption(const FilledTable& table) {
    std::vector<std::string> sentences;
    if (!table.paper->caption.empty()) sentences.push_back(table.paper->caption);
    for (std::size_t c = 0; c < table.paper->columns.size(); ++c)
        if (const auto origin = origin_of(table, c); !origin.empty())
            sentences.push_back(fmt::format("{}: {}", table.paper->columns[c].dataset, origin));
    std::set<std::string> over;
    for (const auto& row : table.rows)
        for (const auto& group : row)
            for (const auto& figures : group.figures) over.insert(over_what(figures));
    over.erase("");
    if (!over.empty()) sentences.push_back(fmt::format("Intervals of 95 % over {}", fmt::join(over, " or ")));
    for (auto& line : near_chance_lines(table)) sentences.push_back(std::move(line));
    return fmt::format("{}", fmt::join(sentences, ". "));
}

std::string latex_table(const FilledTable& table) {
    std::string kinds = "l", groups, rules, metrics;
    std::size_t column = 2;
    for (std::size_t c = 0; c < table.paper->columns.size(); ++c) {
        const auto& one = table.paper->columns[c];
        kinds += std::string(one.metrics.size(), 'r');
        groups += fmt::format(" & \\multicolumn{{{}}}{{c}}{{{}}}", one.metrics.size(),
                              latex_text(with_origin(table, c)));
        rules += fmt::format("\\cmidrule(lr){{{}-{}}} ", column, column + one.metrics.size() - 1);
        column += one.metrics.size();
        for (const auto& metric : one.metrics) metrics += " & " + latex_heading(metric);
    }
    auto out = fmt::format(
        "\\begin{{table}}\n\\centering\n\\begin{{tabular}}{{{}}}\n\\toprule\n{} \\\\\n{}\n{} "
        "\\\\\n\\midrule\n",
        kinds, groups, rules, metrics);
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        out += latex_row_name(table.paper->rows[r].name);
        for (const auto& group : table.rows[r])
            for (const auto& figures : group.figures) out += " & " + latex_cell(group, figures);
        out += " \\\\\n";
    }
    return out +
           fmt::format("\\bottomrule\n\\end{{tabular}}\n\\caption{{{}}}\n\\label{{tab:{}}}\n\\end{{table}}\n",
                       latex_text(latex_caption(table)), table.paper->id);
}

}  // namespace

nlohmann::ordered_json to_json(const std::vector<FilledTable>& tables,
                               const std::vector<std::string>& notices) {
    Json out{{"tables", Json::array()}, {"notices", notices}};
    for (const auto& table : tables) {
        Json rows = Json::array();
        for (std::size_t r = 0; r < table.rows.size(); ++r) {
            Json groups = Json::array();
            for (std::size_t c = 0; c < table.rows[r].size(); ++c)
                groups.push_back(group_json(table.rows[r][c], table.paper->columns[c]));
            rows.push_back({{"name", table.paper->rows[r].name}, {"groups", groups}});
        }
        out["tables"].push_back({{"id", table.paper->id},
                                 {"title", table.paper->title},
                                 {"caption", table.paper->caption},
                                 {"source", table.paper->source},
                                 {"rows", rows}});
    }
    return out;
}

std::string to_csv(const std::vector<FilledTable>& tables) {
    std::string out(csv_beginning);
    out += "state,mean,ci95,over,repeats,paper,paper_ci95,origin,near_chance\n";
    for (const auto& table : tables)
        for (std::size_t r = 0; r < table.rows.size(); ++r)
            for (std::size_t c = 0; c < table.rows[r].size(); ++c) {
                const auto& group = table.rows[r][c];
                const auto& columns = table.paper->columns[c];
                for (std::size_t m = 0; m < columns.metrics.size(); ++m)
                    out += fmt::format(
                        "{},{},{},{},{},{},{},{}\n", table.paper->id, csv_cell(table.paper->rows[r].name),
                        csv_cell(columns.dataset), columns.metrics[m].name, state_of(group, m),
                        csv_figures(group.figures[m]), csv_cell(group.row ? group.row->origin.text() : ""),
                        csv_cell(group.near_chance));
            }
    return out;
}

std::string to_latex(const std::vector<FilledTable>& tables) {
    std::string out(latex_beginning);
    out += "; needs the package booktabs.\n";
    for (const auto& table : tables) out.append("\n").append(latex_table(table));
    return out;
}

}  // namespace actformer::reports
