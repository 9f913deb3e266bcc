// libFuzzer: any bytes as a pickle. What is taken must hold together, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "base/pickle/pickle.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

/// Some of the values, and all bytes of their arrays.
void walk(const PickleValue& value, int depth, int& left) {
    if (depth == 0 || left-- <= 0) return;
    demand(!value.what().empty());
    if (value.is_text()) value.text();
    if (value.is_array()) {
        const auto& array = value.array();
        demand(array.values.size() == array.elements() * array.size);
        if (array.numbers()) demand(array.all_numbers().size() == array.elements());
        if (array.kind == NumpyArray::Kind::text) array.all_texts();
    }
    if (value.is_sequence())
        for (std::size_t i = 0; i < value.size() && left > 0; ++i) walk(value[i], depth - 1, left);
    if (value.is_dict())
        for (std::size_t i = 0; i < value.size() && left > 0; ++i) {
            walk(value.entry(i).first, depth - 1, left);
            walk(value.entry(i).second, depth - 1, left);
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size);
    PickleLimits limits;
    limits.memory = 32 << 20;
    limits.unpacked = 1 << 20;
    try {
        const Pickle pickle(input.text(), limits);
        int left = 1000;
        walk(pickle.root(), 20, left);
        pickle.root().find("x");
    } catch (const Error& e) {
        demand_one_line(e.what());
    }
    return 0;
}
