// What this program was built of, for --version.
#pragma once

#include <string>

namespace actformer::cli {

/// Of the sources, with a + where they were changed; empty where they were no checkout. Defined in a file that the build writes.
extern const char* const commit;

/// Version, commit, compiler, and the libraries it was built with, a line each.
std::string built_with();

}  // namespace actformer::cli
