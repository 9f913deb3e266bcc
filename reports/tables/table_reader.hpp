// Reads one table's YAML (paper_tables.hpp says what it holds). For reports/tables alone.
#pragma once

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "reports/tables/paper_tables.hpp"
#include "reports/tables/yaml_place.hpp"

namespace actformer::reports {

/// What a file of tables may have. Rows and tables that are others' again (YAML's aliases) take a few bytes there, and memory here.
inline constexpr std::size_t most_tables = 1000, most_columns = 100, most_figures = 100'000;

/// Turns the YAML of one table into a table.
class TableReader {
    using Node = YAML::Node;

  public:
    /// `room`: figures that may still be read, of which it takes its own.
    TableReader(const Node& root, const YamlPlace& place, std::string id, std::size_t& room)
        : place_(place), root_(root), room_(room) {
        table_.id = std::move(id);
        place_.expect_map(root_, "a table");
    }

    /// One of a paper, which says what it is.
    PaperTable read() {
        for (const auto* key : {"title", "caption", "source", "order"}) needed(key);
        return read_own();
    }

    PaperTable read_own() {
        check_keys(root_, {"title", "caption", "source", "order", "metrics", "columns", "real", "rows"});
        table_.title = text("title", table_.id);
        table_.caption = text("caption", "");
        table_.source = text("source", "");
        if (const auto order = root_["order"])
            table_.order = place_.as<int>(order, "order", "a whole number");
        read_columns();
        read_rows();
        if (const auto real = root_["real"]) table_.real = row_called(real);
        return std::move(table_);
    }

    /// The rows that `table` has not got.
    void add_rows_to(PaperTable& table) {
        table_.columns = table.columns;
        read_rows();
        std::map<std::string, std::size_t> places;
        for (const auto& row : table.rows) places.emplace(row.name, places.size());
        for (auto& row : table_.rows) {
            const auto found = places.find(row.name);
            if (found == places.end())
                table.rows.push_back(std::move(row));
            else if (const PaperRow blank{row.name, empty_figures()};
                     row.figures != blank.figures && row.figures != table.rows[found->second].figures)
                place_.fail(root_["rows"],
                            fmt::format("{} has a row '{}' with other figures", table.id, row.name));
        }
    }

  private:
    std::vector<std::vector<PaperFigure>> empty_figures() const {
        std::vector<std::vector<PaperFigure>> out;
        for (const auto& column : table_.columns) out.emplace_back(column.metrics.size());
        return out;
    }
    void check_keys(const Node& map, const std::vector<std::string>& known) const {
        for (const auto& item : map) {
            const auto key = item.first.Scalar();
            if (std::ranges::find(known, key) == known.end())
                place_.fail(item.first,
                            fmt::format("there is no key '{}'; there are {}", key, fmt::join(known, ", ")));
        }
    }
    void check_new(const Node& where, const std::string& name, std::set<std::string>& seen) const {
        if (!seen.insert(name).second) place_.fail(where, fmt::format("'{}' comes twice", name));
    }
    /// As a part of a cell's name.
    void check_name(const Node& where, const std::string& name) const {
        if (name.empty() || name.find('/') != std::string::npos)
            place_.fail(where, fmt::format("'{}': a name must not be empty nor hold a /", name));
    }

    Node needed(const char* key) const {
        const auto node = root_[key];
        if (!node) place_.fail(root_, fmt::format("has no '{}'", key));
        return node;
    }
    std::string text(const char* key, const std::string& otherwise) const {
        return root_[key] ? place_.as<std::string>(root_[key], key, "a text") : otherwise;
    }

    const eval::Metric& scored(const Node& where) const try {
        return scored_metric(place_.as<std::string>(where, "metrics", "names of metrics"));
    } catch (const Error& e) {
        place_.fail(where, e.what());
    }
    ColumnMetric metric(const Node& where) const {
        ColumnMetric out(scored(where));
        const auto metrics = root_["metrics"];
        if (!metrics || !metrics[out.name]) return out;
        const auto own = metrics[out.name];
        if (own["heading"]) out.heading = place_.as<std::string>(own["heading"], "heading", "a text");
        if (own["scale"]) out.scale = place_.as<double>(own["scale"], "scale", "a number");
        if (own["better"]) out.better = better(own["better"]);
        return out;
    }
    eval::Direction better(const Node& node) const {
        const auto said = place_.as<std::string>(node, "better", "a text");
        for (const auto one :
             {eval::Direction::lower, eval::Direction::higher, eval::Direction::nearest_real})
            if (said == name_of(one)) return one;
        place_.fail(node,
                    fmt::format("'better' must be lower, higher or nearest to real, and not '{}'", said));
    }

    void read_columns() {
        const auto columns = needed("columns");
        place_.expect_list(columns, "columns");
        if (root_["metrics"]) expect_metrics(root_["metrics"]);
        if (columns.size() == 0) place_.fail(columns, "a table must have columns");
        if (columns.size() > most_columns)
            place_.fail(columns,
                        fmt::format("a table of {} columns; at most {}", columns.size(), most_columns));
        std::set<std::string> seen;
        for (const auto& node : columns) table_.columns.push_back(read_column(node, seen));
        if (!root_["metrics"]) return;
        std::vector<std::string> printed;
        for (const auto& column : table_.columns)
            for (const auto& metric : column.metrics) printed.push_back(metric.name);
        check_keys(root_["metrics"], printed);
    }
    PaperColumns read_column(const Node& node, std::set<std::string>& seen) const {
        place_.expect_map(node, "a column");
        check_keys(node, {"dataset", "metrics"});
        if (!node["dataset"] || !node["metrics"]) place_.fail(node, "a column must say dataset and metrics");
        PaperColumns column;
        column.dataset = place_.as<std::string>(node["dataset"], "dataset", "a text");
        check_name(node, column.dataset);
        check_new(node, column.dataset, seen);
        place_.expect_list(node["metrics"], "metrics");
        std::set<std::string> metrics;
        for (const auto& name : node["metrics"]) {
            column.metrics.push_back(metric(name));
            check_new(name, column.metrics.back().name, metrics);
        }
        if (column.metrics.empty()) place_.fail(node, "a column must have a metric");
        return column;
    }
    void expect_metrics(const Node& metrics) const {
        place_.expect_map(metrics, "metrics");
        for (const auto& item : metrics) {
            place_.expect_map(item.second, "a metric");
            check_keys(item.second, {"heading", "scale", "better"});
        }
    }

    void read_rows() {
        const auto rows = needed("rows");
        place_.expect_map(rows, "rows");
        take_room(rows);
        for (const auto& item : rows) {
            PaperRow row;
            row.name = item.first.Scalar();
            check_name(item.first, row.name);
            place_.expect_map(item.second, fmt::format("row '{}'", row.name));
            check_keys(item.second, datasets());
            for (const auto& column : table_.columns)
                row.figures.push_back(figures(row, column, item.second[column.dataset]));
            table_.rows.push_back(std::move(row));
        }
        if (table_.rows.empty()) place_.fail(rows, "a table must have rows");
    }
    void take_room(const Node& rows) {
        std::size_t figures = 0;
        for (const auto& column : table_.columns) figures += rows.size() * column.metrics.size();
        if (figures > room_)
            place_.fail(rows,
                        fmt::format("more than {} figures, rows times metrics of all tables; leave rows out",
                                    most_figures));
        room_ -= figures;
    }
    std::vector<std::string> datasets() const {
        std::vector<std::string> out;
        for (const auto& column : table_.columns) out.push_back(column.dataset);
        return out;
    }
    std::vector<PaperFigure> figures(const PaperRow& row, const PaperColumns& column,
                                     const Node& node) const {
        const auto count = column.metrics.size();
        if (!node) return std::vector<PaperFigure>(count);
        if (node.IsScalar() && node.Scalar() == "not at hand") return {count, {{}, {}, false}};
        place_.expect_list(node, fmt::format("'{}' of row '{}'", column.dataset, row.name));
        if (node.size() != count)
            place_.fail(node, fmt::format("row '{}', {}: {} figures for {} metrics", row.name, column.dataset,
                                          node.size(), count));
        std::vector<PaperFigure> out;
        for (const auto& one : node) out.push_back(figure(one));
        return out;
    }

    /// "12.53", "12.53 ± 0.2", "-" or "not at hand"
    PaperFigure figure(const Node& node) const {
        const auto said = place_.as<std::string>(node, "a figure", "a number");
        if (said == "-") return {};
        if (said == "not at hand") return {{}, {}, false};
        const std::string sign = " ± ";
        const auto at = said.find(sign);
        PaperFigure out;
        out.value = number(node, said.substr(0, at));
        if (at != std::string::npos) out.half_width = number(node, said.substr(at + sign.size()));
        return out;
    }
    double number(const Node& where, const std::string& said) const {
        double value = 0;
        const auto* end = said.data() + said.size();
        if (const auto read = std::from_chars(said.data(), end, value);
            read.ec == std::errc() && read.ptr == end && value - value == 0)
            return value;
        place_.fail(where, fmt::format("'{}' is no figure: a number, a number ± a number, - (not printed) or "
                                       "not at hand",
                                       where.Scalar()));
    }

    std::size_t row_called(const Node& node) const {
        const auto name = place_.as<std::string>(node, "real", "the name of a row");
        const auto found = std::ranges::find(table_.rows, name, &PaperRow::name);
        if (found == table_.rows.end()) place_.fail(node, fmt::format("real: there is no row '{}'", name));
        return static_cast<std::size_t>(found - table_.rows.begin());
    }

    const YamlPlace& place_;
    Node root_;
    std::size_t& room_;
    PaperTable table_;
};

}  // namespace actformer::reports
