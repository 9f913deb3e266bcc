#include "reports/tables/own_tables.hpp"

#include <algorithm>
#include <cctype>

#include "reports/tables/table_reader.hpp"

namespace actformer::reports {
namespace {

bool same_columns(const PaperTable& a, const PaperTable& b) {
    return std::ranges::equal(a.columns, b.columns, [](const PaperColumns& one, const PaperColumns& other) {
        return one.dataset == other.dataset &&
               std::ranges::equal(one.metrics, other.metrics, {}, &ColumnMetric::name, &ColumnMetric::name);
    });
}

/// Names of tables stand in links and labels of the report as they are.
void check_id(const YAML::Node& where, const std::string& id, const YamlPlace& place) {
    const auto usual = [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '-' || c == '_'); };
    if (id.empty() || !std::ranges::all_of(id, usual))
        place.fail(where, fmt::format("a table cannot be called '{}': letters, digits, - and _", id));
}

void add_own_table(std::vector<PaperTable>& tables, const YAML::Node& node, const std::string& id,
                   const YamlPlace& place, std::size_t& room) {
    check_id(node, id, place);
    place.expect_map(node, fmt::format("table '{}'", id));
    const auto found = std::ranges::find(tables, id, &PaperTable::id);
    const bool new_rows = found != tables.end() && node.size() == 1 && node["rows"];
    if (found == tables.end())
        tables.push_back(TableReader(node, place, id, room).read_own());
    else if (new_rows || same_columns(*found, TableReader(node, place, id, room).read_own()))
        TableReader(node, place, id, room).add_rows_to(*found);
    else
        place.fail(node, fmt::format("there is a table '{}' with other columns: give this one another name, "
                                     "or just rows that it is to get",
                                     id));
}

}  // namespace

std::vector<PaperTable> with_own_tables(std::vector<PaperTable> tables, const YAML::Node& section,
                                        const YamlPlace& place) {
    place.expect_map(section, "tables");
    if (section.size() > most_tables)
        place.fail(section, fmt::format("{} tables; at most {}", section.size(), most_tables));
    std::size_t room = most_figures;
    for (const auto& item : section) add_own_table(tables, item.second, item.first.Scalar(), place, room);
    std::ranges::stable_sort(tables, {}, &PaperTable::order);
    return tables;
}

}  // namespace actformer::reports
