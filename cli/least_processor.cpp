// Compiled for the oldest processor there is.
#include "cli/least_processor.hpp"

#include <cstdio>
#include <cstdlib>

#include "base/process/processor_level.hpp"

namespace actformer::cli {

void expect_least_processor() {
    if (runs_here(ACTFORMER_LEAST)) return;
    std::fputs("actformer: this processor is older than " ACTFORMER_LEAST
               ", which the program was built for; build it from its sources\n",
               stderr);
    std::exit(1);
}

}  // namespace actformer::cli
