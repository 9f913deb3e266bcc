// libFuzzer: any bytes as the pickle of HumanAct12.
// Whatever they hold, clips or rejections of one line come of them, and clips hold as many numbers as they say.
#include <cstdint>
#include <memory>

#include "ingest/formats/humanact12/humanact12_format.hpp"
#include "tests/fuzz/pickled_clips.hpp"

using namespace actformer::ingest;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using From = HumanAct12Options::From;
    constexpr auto pickle = "humanact12poses.pkl";
    static const auto rotations =
        ready(std::make_unique<HumanAct12Format>(HumanAct12Options{"x", From::rotations, {}, 30, false}),
              {file_of(pickle, {})});
    static const auto joints =
        ready(std::make_unique<HumanAct12Format>(HumanAct12Options{"x", From::joints, {}, 30, false}),
              {file_of(pickle, {})});
    const Input input(data, size);
    read_pickle(*rotations, pickle, input.text());
    read_pickle(*joints, pickle, input.text());
    return 0;
}
