// libFuzzer: any bytes as an HDF5 file, of which the attribute "names" of the object at the address in the first two bytes is read past
// the library, and the texts of variable length that it leads to. Bytes beyond the file are not there, and texts are no larger than it.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/hdf5/attribute_bytes.hpp"
#include "base/hdf5/variable_texts.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) return 0;
    const std::uint64_t address = data[0] | data[1] << 8;
    const Input input(data + 2, size - 2);
    const auto text = input.text();
    const hdf5::FileBytes file = [text](std::uint64_t offset, std::uint64_t count) {
        return std::string(text.substr(std::min<std::uint64_t>(offset, text.size()), count));
    };
    const auto references = hdf5::attribute_bytes(address, "names", file);
    if (!references) return 0;
    demand(references->size() <= text.size());
    std::vector<std::string> texts;
    if (!hdf5::read_variable_texts(*references, file, text.size(), texts)) return 0;
    std::size_t all = 0;
    for (const auto& one : texts) all += one.size();
    demand(texts.size() == references->size() / 16 && all <= text.size());
    return 0;
}
