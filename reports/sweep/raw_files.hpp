// Which raw files a sweep's ingest would read.
#pragma once

#include <filesystem>
#include <string>

namespace actformer::reports {

/// Checksum of the files at `raw`, a file or a folder: their paths below it, sizes and times of change, by which an ingest too knows that
/// its work is done. The folder `left_out` is passed over, and so are datasets, trainings and sweeps, and hidden files. Files that cannot be
/// looked at do not count: the ingest will say why.
std::string listing_of(const std::filesystem::path& raw, const std::filesystem::path& left_out);

}  // namespace actformer::reports
