// Whether a sweep's rows name splits that their datasets have.
#pragma once

#include <filesystem>

#include "reports/sweep/plan.hpp"

namespace actformer::reports {

/// Throws Error where a row or recogniser of the sweep in `file` names a split that its dataset has not. Looks at the datasets that are there,
/// those that were made in `out` before among them.
void check_splits(const std::filesystem::path& file, const Plan& plan, const std::filesystem::path& out);

}  // namespace actformer::reports
