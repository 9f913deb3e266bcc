// The report: one HTML file that needs nothing but itself.
#pragma once

#include <string>

#include "reports/page/details.hpp"
#include "reports/page/tables.hpp"

namespace actformer::reports {

/// Tables, their note and the panels below them put into reports/page/assets/page.html. `data` as details() gives it.
std::string page(const std::string& title, const std::vector<FilledTable>& tables,
                 const std::vector<std::string>& notices, const nlohmann::ordered_json& data);

}  // namespace actformer::reports
