// What the report shows of every row below the tables: scores by class, confusions, curves, projections, motions.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/page/measured.hpp"

namespace actformer::reports {

struct DetailOptions {
    std::size_t motion_bytes = 12'000'000;  ///< that all motions together may add to the page
    std::uint32_t most_samples = 4;         ///< motions a class, real and generated
};

/// The page's data: {"version", "class_columns", "rows", "projections", "topologies", "motion_sets"}; reports/page/assets/page.js draws it. What is
/// missing or damaged is left out, with a line in the notices of `measured`.
nlohmann::ordered_json details(Measured& measured, const DetailOptions& options = {});

}  // namespace actformer::reports
