// Tables of a user's own beside the papers', and a user's rows in those.
#pragma once

#include <vector>

#include "reports/tables/paper_tables.hpp"
#include "reports/tables/yaml_place.hpp"

namespace actformer::reports {

/// `tables` with those of a sweep's own section `tables` before them, and with its rows in them; a method stands beside the papers' so:
///
///   table1: {rows: {Mine: {}}}        # a row behind those that there are; `fills: [table1/Mine/NTU-1P]` fills it
///   cmu:                              # a table, as in paper_tables.hpp; title, caption, source and order may be left out
///     columns: [{dataset: CMU, metrics: [accuracy, fid_mean]}]
///     rows: {ActFormer: {}, Mine: {}}
///
/// A row that is there already stays, and may not come with other figures. Throws Error as read_table() does.
std::vector<PaperTable> with_own_tables(std::vector<PaperTable> tables, const YAML::Node& section,
                                        const YamlPlace& place);

}  // namespace actformer::reports
