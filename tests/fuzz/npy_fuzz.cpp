// libFuzzer: any bytes as a .npy and as an .npz file. What is taken must hold together, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "base/numpy/npz.hpp"
#include "ingest/formats/motions/joint_array.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::fuzzing;

namespace {

void check(const NumpyArray& array, std::string_view bytes) {
    if (array.kind == NumpyArray::Kind::other) return;
    demand(array.values.size() == array.elements() * array.size && array.values.size() <= bytes.size());
    if (array.numbers()) demand(array.all_numbers().size() == array.elements());
    if (array.kind == NumpyArray::Kind::text) demand(array.all_texts().size() == array.elements());
    for (const char* axes : {"", "nctkp", "kct"}) try {
            const JointArray joints(array, 2, axes);
            double pose[6];
            joints.pose(joints.clips() - 1, joints.frames() - 1, joints.persons() - 1, pose);
            joints.pose(0, 0, 0, pose);
            const auto* end = joints.end_of_clip(joints.clips() - 1);
            demand(end >= array.values.data() && end <= array.values.data() + array.values.size());
        } catch (const Error& e) {
            demand_one_line(e.what());
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size);
    const auto bytes = input.text();
    try_to([&] { check(read_npy(bytes), bytes); });
    for (const bool heads : {true, false})
        try_to([&] {
            read_npz(bytes, {.heads_only = heads}, [](const std::string&, const NumpyArray& array) {
                if (!array.values.empty()) demand(array.elements() * array.size == array.values.size());
            });
        });
    return 0;
}
