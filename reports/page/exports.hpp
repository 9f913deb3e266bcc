// The tables for other programs and for papers.
#pragma once

#include "reports/page/tables.hpp"

namespace actformer::reports {

/// {"tables": [{"id", "title", "rows": [{"name", "groups": [{"dataset", "state", "provenance": [..], "metrics": {"fid_mean":
/// {"mean", "ci95", "repeats", "best", "paper"}}}]}]}], "notices": [..]}; mean and ci95 null where nothing was measured.
nlohmann::ordered_json to_json(const std::vector<FilledTable>& tables,
                               const std::vector<std::string>& notices);

/// One line a cell: table,row,dataset,metric,state,mean,ci95,repeats,paper.
std::string to_csv(const std::vector<FilledTable>& tables);

/// A `table` with booktabs rules each: measured figures, intervals in small print, the best of a column in bold, "--" for what
/// was not run. The paper's figures are not in it: who publishes shows their own.
std::string to_latex(const std::vector<FilledTable>& tables);

}  // namespace actformer::reports
