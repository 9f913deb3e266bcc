#include "reports/page/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/text/printable.hpp"

namespace actformer::reports {
namespace {

bool is_measured(const std::vector<std::vector<CellGroup>>& rows, std::size_t column) {
    return std::ranges::any_of(rows, [&](const auto& row) { return row[column].row != nullptr; });
}

struct Arrow {
    const char *text, *title;
};

Arrow arrow(eval::Direction better) {
    switch (better) {
        case eval::Direction::lower:
            return {"↓", "lower is better"};
        case eval::Direction::higher:
            return {"↑", "higher is better"};
        default:
            return {"→", "nearest to real motions is best"};
    }
}

/// A line a dataset column: on which data it was measured, or that nothing was.
std::string data_lines(const FilledTable& table) {
    std::string out, none;
    for (std::size_t c = 0; c < table.paper->columns.size(); ++c) {
        const auto& name = table.paper->columns[c].dataset;
        if (!is_measured(table.rows, c)) {
            none += (none.empty() ? "" : ", ") + name;
            continue;
        }
        std::set<std::string> data;
        for (const auto& row : table.rows)
            if (row[c].row) data.insert(fmt::format("{} (split {})", row[c].row->data, row[c].row->split));
        const auto origin = origin_of(table, c);
        out += fmt::format("<p class=\"data\"><b>{}</b>{}, measured on {}</p>\n", escaped(name),
                           origin.empty() ? "" : " (" + escaped(origin) + ")",
                           escaped(fmt::format("{}", fmt::join(data, "; "))));
    }
    if (!none.empty()) out += fmt::format("<p class=\"data\">Nothing was run for {}.</p>\n", escaped(none));
    return out;
}

/// What stands under a table whose figures mean little.
std::string warnings(const FilledTable& table) {
    std::string out;
    for (const auto& line : near_chance_lines(table))
        out += "<p class=\"warning\">" + escaped(line) + "</p>\n";
    return out;
}

std::string head(const FilledTable& table) {
    std::string groups, metrics;
    for (std::size_t c = 0; c < table.paper->columns.size(); ++c) {
        const auto& column = table.paper->columns[c];
        const auto origin = origin_of(table, c);
        groups +=
            fmt::format("<th class=\"group first\" scope=\"colgroup\" colspan=\"{}\">{}{}</th>",
                        column.metrics.size(), escaped(column.dataset),
                        origin.empty() ? "" : " <small class=\"origin\">" + escaped(origin) + "</small>");
        for (std::size_t m = 0; m < column.metrics.size(); ++m) {
            const auto [text, title] = arrow(column.metrics[m].better);
            metrics += fmt::format(
                "<th scope=\"col\"{}>{}&nbsp;<span class=\"arrow\" title=\"{}\">{}</span></th>",
                m == 0 ? " class=\"first\"" : "", escaped(column.metrics[m].heading), title, text);
        }
    }
    return fmt::format("<thead><tr><th rowspan=\"2\"></th>{}</tr>\n<tr>{}</tr></thead>\n", groups, metrics);
}

std::string tip(const CellGroup& group) {
    const auto lines = provenance(group);
    if (lines.empty()) return "";
    std::string text = "<b>" + escaped(group.row->name) + "</b>";
    for (const auto& line : lines) text += "<br>" + escaped(line);
    if (!group.near_chance.empty()) text += "<br>the recogniser is near chance on real motions";
    return "<span class=\"tip\" role=\"tooltip\">" + text + "</span>";
}

std::string value(const CellGroup& group, const Figures& figures) {
    if (group.state != CellState::measured) return in_words(group.state);
    if (!figures.measured) return "not measured";
    auto out = "<span class=\"value\">" + figure_text(figures.measured->mean) + "</span>";
    if (figures.measured->half_width)
        out += "<span class=\"ci\">± " + figure_text(*figures.measured->half_width) + "</span>";
    return out;
}

std::string cell(const CellGroup& group, std::size_t metric) {
    const auto& figures = group.figures[metric];
    static constexpr const char* states[] = {"not-run", "waiting", "failed", "measured"};
    std::string classes = states[static_cast<std::size_t>(group.state)];
    if (group.state == CellState::measured && !figures.measured) classes = "waiting";
    if (metric == 0) classes = "first " + classes;
    if (figures.best) classes += " best";
    auto out = fmt::format("<td class=\"{}\"{}>{}", classes, group.row ? " tabindex=\"0\"" : "",
                           value(group, figures));
    if (const auto paper = paper_text(figures.paper); !paper.empty())
        out += fmt::format("<span class=\"paper{}\" title=\"as the paper prints it\">{}</span>",
                           figures.paper_best ? " best" : "", paper);
    return out + tip(group) + "</td>";
}

std::string body(const FilledTable& table) {
    std::string out = "<tbody>\n";
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        out += "<tr><th scope=\"row\">" + escaped(table.paper->rows[r].name) + "</th>";
        for (const auto& group : table.rows[r])
            for (std::size_t m = 0; m < group.figures.size(); ++m) out += cell(group, m);
        out += "</tr>\n";
    }
    return out + "</tbody>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : printable(text)) switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                out += c;
        }
    return out;
}

std::string html_note(const std::vector<FilledTable>& tables, const std::vector<std::string>& notices) {
    std::string out;
    std::set<std::string> data;
    bool stand_in = false, generic = false;
    for (const auto& table : tables)
        for (const auto& row : table.rows)
            for (const auto& group : row)
                if (group.row) {
                    data.insert(group.row->data);
                    const auto& origin = group.row->origin;
                    stand_in = stand_in || origin.kind == ingest::DataOrigin::Kind::stand_in ||
                               group.row->data.find("synthetic people") != std::string::npos;
                    generic = generic || origin.skeleton == "generic";
                }
    out += "<div class=\"note\">\n<p>Every large figure below was measured by actformer";
    if (!data.empty()) out += " on " + escaped(fmt::format("{}", fmt::join(data, "; ")));
    out += ". The small figures are those that the papers print, for comparison only.</p>\n";
    if (stand_in)
        out +=
            "<p>Stand-ins are motion of synthetic people in the place of a dataset: such figures show that "
            "the whole chain works, "
            "and how the methods compare on made-up motion. They cannot be held against the paper's.</p>\n";
    if (generic)
        out +=
            "<p>A generic skeleton turned rotations into joints where no SMPL model file was given: where "
            "joints are, and what "
            "is measured of them, differs a little from the paper's.</p>\n";
    for (const auto& notice : notices) out += "<p class=\"notice\">" + escaped(notice) + "</p>\n";
    return out + "</div>\n";
}

std::string html_links(const std::vector<FilledTable>& tables) {
    const std::string word = "Table ";
    std::string out;
    bool of_rows = false;
    for (const auto& table : tables) {
        std::string text = table.paper->title;
        if (text.starts_with(word)) text.erase(0, word.size());
        if (table.all_rows) {
            if (of_rows) continue;  // they stand together
            of_rows = true;
            text = "all rows";
        }
        out += fmt::format(" <a href=\"#{}\" aria-label=\"{}\">{}</a>", table.paper->id,
                           escaped(table.paper->title), escaped(text));
    }
    return out;
}

std::string html_tables(const std::vector<FilledTable>& tables) {
    std::string out;
    for (const auto& table : tables)
        out += fmt::format(
            "<section class=\"table\" id=\"{}\">\n<h2>{} <small>{}</small></h2>\n<p "
            "class=\"source\">{}</p>\n{}<div "
            "class=\"scroll\"><table>\n{}{}"
            "</table></div>\n{}</section>\n",
            table.paper->id, escaped(table.paper->title), escaped(table.paper->caption),
            escaped(table.paper->source), data_lines(table), head(table), body(table), warnings(table));
    return out;
}

}  // namespace actformer::reports
