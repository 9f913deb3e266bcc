// libFuzzer: any bytes as a recording in AMASS's layout. What is taken can be resampled, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "ingest/formats/babel/amass_file.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size);
    try {
        read_amass_file(input.text(), [](const AmassRecording& recording) {
            const auto& file = recording.motion;
            demand(file.frames > 0 && recording.fps >= 1 && (file.joints == 22 || file.joints == 24));
            if (file.frames > 1000) return;  // takes too long
            const auto motion = resampled(file, recording.fps, 30);
            demand(motion.frames > 0 && motion.rotations.size() == motion.frames * smpl_joints);
        });
    } catch (const Error& e) {
        demand_one_line(e.what());
    }
    return 0;
}
