// Compiled for the oldest processor there is.
#include "cli/least_processor.hpp"

#include "base/process/processor_level.hpp"

namespace actformer::cli {

void expect_least_processor() {
    expect_processor(ACTFORMER_LEAST);
}

}  // namespace actformer::cli
