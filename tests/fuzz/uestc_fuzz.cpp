// libFuzzer: any bytes as the pickle of UESTC.
// Whatever they hold, clips or rejections of one line come of them, and clips hold as many numbers as they say.
#include <cstdint>
#include <memory>

#include "ingest/formats/uestc/uestc_format.hpp"
#include "tests/fuzz/pickled_clips.hpp"

using namespace actformer::ingest;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr auto pickle = "vibe_cache_refined.pkl";
    static const auto format =
        ready(std::make_unique<UestcFormat>("x", RotationalTarget{}),
              {file_of(pickle, {}), file_of("names.txt", "a0_d2_p001_c2_color.avi\n"),
               file_of("num_frames_min.txt", "2\n"), file_of("action_classes.txt", "squat\n")});
    read_pickle(*format, pickle, Input(data, size).text());
    return 0;
}
