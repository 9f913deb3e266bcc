// libFuzzer: any bytes as a .skeleton file. What the reader accepts must hold together.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "base/files/file.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"

using namespace actformer::ingest;

namespace {

void demand(bool holds) {
    if (!holds) std::abort();
}

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
    const auto text = std::make_unique<char[]>(size + actformer::text_padding);
    std::memcpy(text.get(), data, size);
    std::visit([](const auto& result) { check(result); }, read_skeleton({text.get(), size}));
    return 0;
}
