// A training by itself, as a row of the report.
#pragma once

#include <filesystem>
#include <optional>

#include "reports/page/measured.hpp"

namespace actformer::reports {

/// The folder that `actformer train -o FOLDER` writes, as a row that has curves and no scores; none where it is no such folder. While the
/// training goes on the row waits; one that ended before its last epoch is "stopped".
std::optional<MeasuredRow> training_row(const std::filesystem::path& folder);

}  // namespace actformer::reports
