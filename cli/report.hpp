// What `actformer report` writes, for the commands that end in a report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace actformer::cli {

struct ReportOptions {
    std::vector<std::filesystem::path> folders;   ///< of sweeps and trainings
    std::filesystem::path out{}, csv{}, latex{};  ///< empty: not written
    std::string title = "ActFormer, measured";
    double motion_megabytes = 12;
    bool force = false;  ///< replace files of others, too
    bool json = false;
    bool filled_only =
        false;  ///< leave out tables that nothing was run for; they are where no row is for the papers' ones
};

/// Says on standard error which files it wrote and what is missing. Whether rows are still to be measured. Throws Error for folders without
/// results.
bool write_report(const ReportOptions& options);

}  // namespace actformer::cli
