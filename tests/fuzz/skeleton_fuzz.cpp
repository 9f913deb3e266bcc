// libFuzzer: any bytes as a .skeleton file. What the reader accepts must hold together.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "base/files/file.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer::ingest;
using namespace actformer::fuzzing;

namespace {

void check(const SkeletonFile& file) {
    for (const auto& body : file.bodies) {
        demand(!body.times.empty() && body.limbs.size() == body.times.size() * ntu_joints * 3);
        for (std::size_t i = 0; i < body.times.size(); ++i)
            demand(body.times[i] < file.frames && (i == 0 || body.times[i - 1] < body.times[i]));
        for (const float number : body.limbs) demand(std::isfinite(number));
    }
}

void check(const Rejection& why) {
    demand(!why.reason.empty() && why.reason.find('\n') == std::string::npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // In an allocation of just the promised size, so that the sanitizer sees any byte read beyond it.
    const Input input(data, size, actformer::text_padding);
    std::visit([](const auto& result) { check(result); }, read_skeleton(input.text()));
    return 0;
}
