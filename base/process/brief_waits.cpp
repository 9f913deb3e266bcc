#include "base/process/brief_waits.hpp"

#include <cstdlib>

namespace actformer {

void wait_briefly() {
    if (!std::getenv("OMP_WAIT_POLICY")) ::setenv("GOMP_SPINCOUNT", "400", 0);
    ::setenv("OMP_WAIT_POLICY", "passive", 0);
    ::setenv("OPENBLAS_THREAD_TIMEOUT", "4", 0);
}

}  // namespace actformer
