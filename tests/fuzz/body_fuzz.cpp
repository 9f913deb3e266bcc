// libFuzzer: any bytes as a body model's file. What is taken must hold together, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "ingest/smpl/body_file.hpp"
#include "ingest/smpl/model_arrays.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size);
    const auto bytes = input.text();
    try_to([&] {
        const auto body = parse_smpl_body(bytes, "body");
        for (const auto v : body.faces) demand(v < body.skin.vertices());
        demand(body.rest().offsets.size() == 72 && body.skin.first.size() == body.skin.vertices() + 1);
    });
    // Few inputs get past all that a model must have: its arrays on their own, by the reader that it would choose.
    const auto read = bytes.starts_with("PK") ? read_model_npz : read_model_pickle;
    try_to([&] {
        for (const auto& [name, array] : read(bytes, {"a", "b", "J_regressor", "shapedirs", "f"})) {
            std::uint64_t meant = 1;
            for (const auto n : array.shape) meant *= n;
            demand(meant == array.values.size());
        }
    });
    return 0;
}
