// The files of reports/tables, embedded at build.
#pragma once

#include <string_view>
#include <vector>

namespace actformer::reports {

/// Text of reports/tables/NAME; empty where there is no such file.
std::string_view table_file(std::string_view name);

/// Names of all of them.
std::vector<std::string_view> table_file_names();

}  // namespace actformer::reports
