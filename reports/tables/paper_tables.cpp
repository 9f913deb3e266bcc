#include "reports/tables/paper_tables.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace actformer::reports {
namespace {

const std::vector<std::string> three{"accuracy", "fid_mean", "fid_whole"};
const std::vector<std::string> five{"accuracy", "fid_mean", "fid_whole", "fida_mean", "fida_whole"};
const std::vector<std::string> group{"fida_whole"};  // GTA Combat's one figure a group size

std::vector<PaperColumns> with_groups() {
    return {{"NTU-2P", five}, {"GTA-2P", group}, {"GTA-3P", group}, {"GTA-4P", group}, {"GTA-5P", group}};
}

PaperTable single_person() {
    return {
        "table1",
        "Single person",
        {{"NTU-13", three}, {"NTURecon-1P", three}, {"NTU-1P", three}, {"BABEL", three}},
        {{"Action2Motion",
          {{94.9, 4.40, 2.01}, {41.97, 23.86, 18.35}, {8.34, 56.13, 46.13}, {6.04, 17.03, 6.05}}},
         {"CSGN", {{85.9, 8.07, 3.64}, {20.02, 36.02, 27.51}, {38.99, 17.01, 7.14}, {7.02, 20.11, 9.17}}},
         {"ACTOR", {{97.1, 5.35, 1.18}, {39.69, 37.87, 19.58}, {35.56, 32.89, 9.63}, {3.44, 55.66, 36.27}}},
         {"ActFormer",
          {{99.9, 4.28, 1.11}, {49.12, 20.35, 8.86}, {42.01, 12.53, 3.57}, {13.49, 11.21, 2.55}}}}};
}

PaperTable several_persons() {
    return {"table2",
            "Several persons",
            with_groups(),
            {{"Action2Motion", {{16.85, 15.07, 10.12, 26.25, 20.31}, {}, {}, {}, {}}},
             {"CSGN", {{55.12, 6.10, 3.88, 8.96, 3.20}, {1.15}, {1.73}, {2.09}, {4.02}}},
             {"ACTOR", {{63.04, 13.56, 6.72, 19.14, 8.16}, {}, {}, {}, {}}},
             {"ActFormer", {{69.65, 3.77, 3.27, 7.12, 2.46}, {1.04}, {1.13}, {1.58}, {2.23}}}}};
}

PaperTable generator_parts() {
    return {"table3",
            "Parts of the generator, single person",
            {{"NTU-1P", three}},
            {{"Gaussian prior", {{37.55, 17.25, 6.01}}},
             {"graph convolutions in the generator", {{32.97, 18.68, 6.09}}},
             {"fixed PE", {{37.57, 18.38, 5.55}}},
             {"full", {{42.01, 12.53, 3.57}}}}};
}

PaperTable person_parts() {
    return {"table4",
            "Discriminator and positions, two persons",
            {{"NTU-2P", five}},
            {{"AvgPool D", {{53.85, 20.42, 8.33, 25.35, 10.09}}},
             {"MaxPool D", {{60.19, 10.71, 4.01, 17.26, 5.42}}},
             {"SelfAtt D", {{51.53, 19.96, 8.27, 24.91, 8.75}}},
             {"fixed PE", {{61.42, 4.86, 3.64, 7.71, 2.78}}},
             {"independent PE", {{67.19, 4.08, 3.38, 7.00, 2.62}}},
             {"full", {{69.65, 3.77, 3.27, 7.12, 2.46}}}}};
}

PaperTable interaction_parts() {
    return {
        "table5",
        "Latents and interaction, several persons",
        with_groups(),
        {{"without shared z", {{56.35, 14.79, 5.73, 20.69, 7.26}, {1.26}, {1.36}, {1.84}, {2.42}}},
         {"interaction by concatenation", {{56.46, 7.63, 4.33, 11.51, 3.57}, {1.15}, {1.37}, {2.23}, {7.62}}},
         {"complete", {{69.65, 3.77, 3.27, 7.12, 2.46}, {1.04}, {1.13}, {1.58}, {2.23}}}}};
}

template <typename Items, typename Name>
std::size_t index_of(const Items& items, const std::string& wanted, Name name, const std::string& cell,
                     const char* what) {
    std::string all;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (name(items[i]) == wanted) return i;
        all += (all.empty() ? "" : ", ") + name(items[i]);
    }
    throw Error("cell '{}': there is no {} '{}'; there are {}", cell, what, wanted, all);
}

}  // namespace

const std::vector<PaperTable>& paper_tables() {
    static const std::vector<PaperTable> tables{single_person(), several_persons(), generator_parts(),
                                                person_parts(), interaction_parts()};
    return tables;
}

Cell find_cell(const std::string& name) {
    const auto first = name.find('/'), last = name.rfind('/');
    if (first == std::string::npos || first == last)
        throw Error("cell '{}': a table, a row and a dataset are expected, as in table3/full/NTU-1P", name);
    const auto& tables = paper_tables();
    Cell cell;
    cell.table = &tables[index_of(
        tables, name.substr(0, first), [](const PaperTable& t) { return t.id; }, name, "table")];
    cell.row = index_of(
        cell.table->rows, name.substr(first + 1, last - first - 1), [](const PaperRow& r) { return r.name; },
        name, "row");
    cell.columns = index_of(
        cell.table->columns, name.substr(last + 1), [](const PaperColumns& c) { return c.dataset; }, name,
        "dataset");
    return cell;
}

}  // namespace actformer::reports
