// libFuzzer: any bytes as a joblib file of NTU-13.
// Whatever they hold, clips or rejections of one line come of them, and clips hold as many numbers as they say.
#include <cstdint>
#include <memory>

#include "ingest/formats/ntu13/ntu13_format.hpp"
#include "tests/fuzz/pickled_clips.hpp"

using namespace actformer::ingest;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr auto pickle = "S001C001P001R001A099.pkl";
    static const auto rotations =
        ready(std::make_unique<Ntu13Format>(Ntu13Options{"x", false, {}, false}), {file_of(pickle, {})});
    static const auto joints =
        ready(std::make_unique<Ntu13Format>(Ntu13Options{"x", true, {}, false}), {file_of(pickle, {})});
    const Input input(data, size);
    read_pickle(*rotations, pickle, input.text());
    read_pickle(*joints, pickle, input.text());
    return 0;
}
