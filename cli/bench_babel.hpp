// actformer bench ingest --format babel.
#pragma once

#include <string>

namespace actformer::cli {

struct BabelBench {
    double hours = 0.5;     ///< of recordings
    double many_hours = 0;  ///< also so much of linked recordings, to watch the memory
    std::string peer, python, folder, device;
    int repeats = 3;
    unsigned threads = 0;
    bool json = false;
};

/// Ingests made-up recordings in AMASS's layout, beside NumPy and SciPy on as many threads.
void bench_babel(const BabelBench& bench);

}  // namespace actformer::cli
