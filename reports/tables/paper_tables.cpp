#include "reports/tables/paper_tables.hpp"

#include <algorithm>
#include <filesystem>

#include "base/text/suggestion.hpp"
#include "reports/tables/table_file.hpp"
#include "reports/tables/table_reader.hpp"

namespace actformer::reports {
namespace {

YAML::Node parsed(std::string_view yaml, const std::string& file) {
    try {
        return YAML::Load(std::string(yaml));
    } catch (const YAML::Exception& e) {
        throw Error("{}: line {}: {}", file, e.mark.line + 1, e.msg);
    }
}

template <typename Items, typename Name>
std::size_t index_of(const Items& items, const std::string& wanted, Name name, const std::string& cell,
                     const char* what) {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].*name == wanted) return i;
        all.push_back(items[i].*name);
    }
    throw Error("cell '{}': there is no {} '{}'{}; there are {}", cell, what, wanted, suggestion(wanted, all),
                fmt::join(all, ", "));
}

std::vector<PaperTable> all_tables() {
    std::vector<PaperTable> out;
    for (const auto name : table_file_names())
        out.push_back(read_table(table_file(name), "reports/tables/" + std::string(name)));
    std::ranges::sort(out, {}, &PaperTable::order);
    return out;
}

}  // namespace

PaperTable read_table(std::string_view yaml, const std::string& file) {
    const YamlPlace place{file};
    auto room = most_figures;
    return TableReader(parsed(yaml, file), place, std::filesystem::path(file).stem().string(), room).read();
}

const std::vector<PaperTable>& paper_tables() {
    static const std::vector<PaperTable> tables = all_tables();
    return tables;
}

Cell find_cell(const std::string& name, const std::vector<PaperTable>& tables) {
    const auto first = name.find('/'), last = name.rfind('/');
    if (first == std::string::npos || first == last)
        throw Error("cell '{}': a table, a row and a dataset are expected, as in table3/full/NTU-1P", name);
    Cell cell;
    cell.table = &tables[index_of(tables, name.substr(0, first), &PaperTable::id, name, "table")];
    cell.row =
        index_of(cell.table->rows, name.substr(first + 1, last - first - 1), &PaperRow::name, name, "row");
    cell.columns =
        index_of(cell.table->columns, name.substr(last + 1), &PaperColumns::dataset, name, "dataset");
    return cell;
}

std::string words_of(const Cell& cell) {
    return fmt::format("{} · {} · {}", cell.table->title, cell.table->rows[cell.row].name,
                       cell.table->columns[cell.columns].dataset);
}

}  // namespace actformer::reports
