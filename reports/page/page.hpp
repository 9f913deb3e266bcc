// The report: one HTML file that needs nothing but itself.
#pragma once

#include <string>
#include <string_view>

#include "reports/page/details.hpp"
#include "reports/page/tables.hpp"

namespace actformer::reports {

/// Words that every page has, of page.html, by which a report is told from others' pages.
inline constexpr std::string_view in_every_page = "<a class=\"skip\" href=\"#main\">Skip to the tables</a>";

/// Tables, their note and the panels below them put into reports/page/assets/page.html. `data` as details() gives it.
std::string page(const std::string& title, const std::vector<FilledTable>& tables,
                 const std::vector<std::string>& notices, const nlohmann::ordered_json& data);

}  // namespace actformer::reports
