// The page's files of reports/page/assets, embedded at build.
#pragma once

#include <string_view>

namespace actformer::reports {

/// Text of reports/page/assets/NAME; empty where there is no such file.
std::string_view page_part(std::string_view name);

}  // namespace actformer::reports
