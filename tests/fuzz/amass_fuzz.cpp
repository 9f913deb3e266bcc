// libFuzzer: any bytes as a recording in AMASS's layout. What is taken can be resampled, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "ingest/formats/babel/amass_file.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

void demand(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // In an allocation of just that size, so that the sanitizer sees any byte read beyond it.
    const auto copy = std::make_unique<char[]>(size);
    std::copy(data, data + size, copy.get());
    try {
        read_amass_file({copy.get(), size}, [](const AmassRecording& recording) {
            const auto& file = recording.motion;
            demand(file.frames > 0 && recording.fps >= 1 && (file.joints == 22 || file.joints == 24));
            if (file.frames > 1000) return;  // takes too long
            const auto motion = resampled(file, recording.fps, 30);
            demand(motion.frames > 0 && motion.rotations.size() == motion.frames * smpl_joints);
        });
    } catch (const Error& e) {
        demand(*e.what() != '\0' && std::string_view(e.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
