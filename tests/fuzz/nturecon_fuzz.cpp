// libFuzzer: any bytes as a pickle of NTURecon.
// Whatever they hold, clips or rejections of one line come of them, and clips hold as many numbers as they say.
#include <cstdint>
#include <memory>

#include "ingest/formats/nturecon/nturecon_format.hpp"
#include "tests/fuzz/pickled_clips.hpp"

using namespace actformer::ingest;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr auto pickle = "S001C001P001R001A001_body0.pkl";
    static const auto format =
        ready(std::make_unique<NtuReconFormat>("x", RotationalTarget{}), {file_of(pickle, {})});
    read_pickle(*format, pickle, Input(data, size).text());
    return 0;
}
