// The tables for other programs and for papers.
#pragma once

#include <string_view>

#include "reports/page/tables.hpp"

namespace actformer::reports {

/// {"tables": [{"id", "title", "caption", "source", "rows": [{"name", "groups": [{"dataset", "state", "origin", "near_chance":
/// what near_chance() says of the row, "provenance": [..], "metrics": {"fid_mean": {"mean", "ci95", "over", "repeats", "best", "paper",
/// "paper_ci95", "paper_at_hand"}}}]}]}], "notices": [..]}; null where nothing was measured, or the paper prints nothing.
nlohmann::ordered_json to_json(const std::vector<FilledTable>& tables,
                               const std::vector<std::string>& notices);

/// What CSV and LaTeX tables begin with, by which a report's are told from others'.
inline constexpr std::string_view csv_beginning = "table,row,dataset,metric,",
                                  latex_beginning = "% Written by `actformer report`";

/// One line a cell: table,row,dataset,metric,state,mean,ci95,over,repeats,paper,paper_ci95,origin,near_chance.
std::string to_csv(const std::vector<FilledTable>& tables);

/// A `table` with booktabs rules each: measured figures, intervals in small print, the best of a column in bold, "--" for what
/// was not run; captions have near_chance_lines(). The paper's figures are not in it: a user publishes their own.
std::string to_latex(const std::vector<FilledTable>& tables);

}  // namespace actformer::reports
