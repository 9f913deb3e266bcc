// libFuzzer: HDF5 files that are nearly a training's checkpoint, a generator's weights, or measures of motions, given to the readers of these. The
// library makes them (see motions_fuzz.cpp).
#include <cmath>
#include <string>
#include <variant>

#include "base/checksum/own_checksum.hpp"
#include "base/hdf5/file_memory.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/scoring/measures_file.hpp"
#include "model/nn/weights_file.hpp"
#include "model/train/checkpoint.hpp"
#include "tests/fuzz/fuzzing.hpp"
#include "tests/fuzz/nearly_hdf5.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

/// Beside a text that may be any.
void make_checkpoint(hid_t file, Choices& choose) {
    add_attribute_nearly(file, {"step", H5T_STD_I64LE, {}}, choose);
    static constexpr const char* states[] = {R"({"model": "a", "sums": [1]})", R"({"model": 1})", "[1]", "{",
                                             ""};
    const std::string state = states[choose.below(5)];
    const auto type = text_type(state.size() + 1);
    const auto space = space_of({1});
    if (choose.below(4) == 0)
        add_nearly(file, {"progress", type.get(), {1}}, choose);
    else if (const Handle set(
                 H5Dcreate2(file, "progress", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                 H5Dclose);
             set)
        H5Dwrite(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, state.c_str());
    add_nearly(file, {"net.weight", H5T_IEEE_F32LE, {2, 3}}, choose);
    add_nearly(file, {"adam.means", H5T_IEEE_F64LE, {long_extent}}, choose);
}

void make_arrays(hid_t file, Choices& choose) {
    for (const auto* name : {"embedding.weight", "head.bias"})
        add_nearly(file, {name, H5T_IEEE_F32LE, {2, long_extent}}, choose);
}

void make_measures(hid_t file, Choices& choose) {
    for (const auto* name : {"limb_acceleration", "root_acceleration", "root_speed", "foot_sliding"})
        add_nearly(file, {name, H5T_IEEE_F32LE, {3, 1}}, choose);
    add_nearly(file, {"distances", H5T_IEEE_F32LE, {3, 2}}, choose);
}

/// As many numbers as the shape says.
bool is_whole(const model::Array& array) {
    std::size_t numbers = 1;
    for (const auto extent : array.shape) numbers *= static_cast<std::size_t>(extent);
    return std::visit([&](const auto& values) { return values.size() == numbers; }, array.values);
}

void read_checkpoint(const std::string& path) {
    const auto checkpoint = model::read_checkpoint(path);
    if (!checkpoint) return;
    demand(checkpoint->state.is_object());
    for (const auto& array : checkpoint->arrays) demand(is_whole(array));
}

void read_arrays(const std::string& path) {
    for (const auto& array : model::read_arrays(hdf5::Reader(path), path)) {
        demand(is_whole(array));
        for (const auto value : std::get<std::vector<float>>(array.values)) demand(std::isfinite(value));
    }
}

void read_measures(const std::string& path) {
    const auto measures = eval::read_measures(path);
    demand(measures.root_acceleration.size() == measures.size());
    demand(measures.distances.size() == measures.size() * measures.columns);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hdf5::silence();
    static const Hdf5InMemory on_disk;
    Choices choose(data, size);
    const auto kind = choose.below(3);
    constexpr void (*make[])(hid_t, Choices&) = {make_checkpoint, make_arrays, make_measures};
    const auto image = made_file(make[kind], choose);
    on_disk.write(image, checksum_line({image.data(), image.size()}));
    constexpr void (*read[])(const std::string&) = {read_checkpoint, read_arrays, read_measures};
    try_to([&] { read[kind](on_disk.path()); });
    return 0;
}
