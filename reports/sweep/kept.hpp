// Whether what a sweep's jobs made is still there as they made it.
#pragma once

#include <functional>

#include "reports/sweep/results.hpp"

namespace actformer::reports {

/// Of the job in `folder`: weights, configurations, motions, features, scores and what describes its datasets, by their paths below
/// it, each with its checksum. For done.json. Shards are not read: their dataset has their checksums.
nlohmann::ordered_json checksums_of_results(const std::filesystem::path& folder);

/// Why a job that is done has to be done again: the file that is not as the job made it. Empty where all are, and of jobs done by
/// versions that noted no checksums.
std::string fault_of_results(const std::filesystem::path& folder);

/// As statuses(), but such jobs wait to be done again; `say` hears why.
std::vector<JobStatus> checked_statuses(const Plan& plan, const std::filesystem::path& out,
                                        const std::function<void(const Job&, const std::string& why)>& say);

/// Removes what a job made, all but its lock.
void discard_results(const std::filesystem::path& folder);

}  // namespace actformer::reports
