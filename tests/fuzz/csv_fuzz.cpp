// libFuzzer: any bytes as a .csv file of joints. What is taken must be whole, what is refused is one line.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "ingest/formats/motions/csv_motion.hpp"

using namespace actformer;

namespace {

void demand(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // In an allocation of just the promised size, so that the sanitizer sees any byte read beyond it.
    const auto text = std::make_unique<char[]>(size + text_padding);
    std::copy(data, data + size, text.get());
    try {
        const auto motion = ingest::read_csv_motion({text.get(), size}, {"hips", "knee"});
        demand(motion.frames > 0 && motion.persons > 0 && motion.joints == 2);
        demand(motion.positions.size() == motion.frames * motion.persons * 6);
        for (const double x : motion.positions) demand(std::isfinite(x) || std::isnan(x));
    } catch (const Error& e) {
        demand(std::string_view(e.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
