// libFuzzer: any bytes as a .csv file of joints. What is taken must be whole, what is refused is one line.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "ingest/formats/motions/csv_motion.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // In an allocation of just the promised size, so that the sanitizer sees any byte read beyond it.
    const Input input(data, size, text_padding);
    try {
        const auto motion = ingest::read_csv_motion(input.text(), {"hips", "knee"});
        demand(motion.frames > 0 && motion.persons > 0 && motion.joints == 2);
        demand(motion.positions.size() == motion.frames * motion.persons * 6);
        for (const double x : motion.positions) demand(std::isfinite(x) || std::isnan(x));
    } catch (const Error& e) {
        demand_one_line(e.what());
    }
    return 0;
}
