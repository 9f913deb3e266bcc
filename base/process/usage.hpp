// What this process has used so far.
#pragma once

namespace actformer {

/// Seconds of processors, all threads together.
double processor_seconds();

/// The most memory it ever held, in MiB.
double peak_memory_mib();

}  // namespace actformer
