// libFuzzer: HDF5 files of any arrays and attributes, read as motions. The library makes them from what the bytes choose: byte by
// byte hostile files crash the library itself (1.10.8), whatever we do.
#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "base/error.hpp"
#include "base/hdf5/file_memory.hpp"
#include "base/hdf5/reader.hpp"
#include "tests/fuzz/any_hdf5.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

std::vector<char> any_file(Choices& choose) {
    const auto file = new_file();
    for (const auto* name : {"A001_0", "A002_0", "names"})
        if (choose.more()) add_array(file.get(), name, choose);
    if (choose.below(4) == 1)
        H5Lcreate_soft(choose.below(2) ? "/A001_0" : "/soft", file.get(), "soft", H5P_DEFAULT, H5P_DEFAULT);
    for (const auto* name : {"parents", "persons", "bone_length", "fps", "joints", "class_names"})
        if (choose.more()) add_attribute(file.get(), name, choose);
    return image_of(file);
}

/// Calls `act`; an Error must be one line.
template <typename Act>
void attempt(const Act& act) {
    try {
        act();
    } catch (const Error& e) {
        const std::string_view why = e.what();
        demand(!why.empty() && why.find('\n') == std::string_view::npos);
    }
}

void read_array(const hdf5::Reader& file, const std::string& name) {
    const auto shape = file.shape(name);
    const auto count = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
    attempt([&] { demand(file.read_strings(name).size() == count); });
    demand(file.read<float>(name).size() == count);
    if (!shape.empty() && shape[0] > 0)
        demand(file.read_rows(name, shape[0] - 1, 1).size() == count / shape[0]);
}

void read_all(const hdf5::Reader& file) {
    for (const auto& name : file.names()) {
        attempt([&] { file.is_array(name); });
        attempt([&] { read_array(file, name); });
    }
    for (const auto* name : {"parents", "persons"}) attempt([&] { file.attribute_numbers(name); });
    for (const auto* name : {"bone_length", "fps"}) attempt([&] { file.attribute_floats(name); });
    for (const auto* name : {"joints", "class_names"}) attempt([&] { file.attribute_texts(name); });
    attempt([&] { file.contents(); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hdf5::silence();
    Choices choose(data, size);
    const auto image = any_file(choose);
    attempt([&] { read_all(hdf5::Reader({image.data(), image.size()}, "motions.h5")); });
    return 0;
}
