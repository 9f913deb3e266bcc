#pragma once

namespace actformer::cli {

/// Ends the program with a line where it was built for a newer processor than this one.
void expect_least_processor();

}  // namespace actformer::cli
