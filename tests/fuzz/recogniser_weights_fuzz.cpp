// libFuzzer: weights of a small ST-GCN or GRU recogniser, of which one tensor and some attributes may be others. The library makes the files (see
// motions_fuzz.cpp).
#include <cmath>
#include <string>
#include <vector>

#include "base/hdf5/file_memory.hpp"
#include "eval/gru/weights.hpp"
#include "eval/stgcn/weights.hpp"
#include "tests/fuzz/fuzzing.hpp"
#include "tests/fuzz/nearly_hdf5.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

constexpr std::uint32_t channels = 3, classes = 2;
const std::vector<int> parents{-1, 0};

void add_ones(hid_t file, const Named& wanted) {
    const auto space = space_of(wanted.shape);
    const Handle set(
        H5Dcreate2(file, wanted.name, wanted.type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    const std::vector<float> ones(numbers_in(wanted.shape), 1);
    H5Dwrite(set.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, ones.data());
}

void add_numbers(hid_t file, const char* name, const std::vector<std::int64_t>& numbers, Choices& choose) {
    const hdf5::Shape shape(numbers.size() > 1, numbers.size());
    if (choose.below(8) == 1) return add_attribute_nearly(file, {name, H5T_STD_I64LE, shape}, choose);
    const auto space = space_of(shape);
    const Handle attribute(H5Acreate2(file, name, H5T_STD_I64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    H5Awrite(attribute.get(), H5T_NATIVE_INT64, numbers.data());
}

/// All `tensors`, one of them not as it should be but where the choice is beyond them.
template <typename Tensor>
void make(hid_t file, const std::vector<Tensor>& tensors, Choices& choose) {
    add_numbers(file, "channels", {channels}, choose);
    add_numbers(file, "classes", {classes}, choose);
    add_numbers(file, "parents", {parents.begin(), parents.end()}, choose);
    add_numbers(file, "center", {0}, choose);
    const auto other = choose.below(256);
    for (std::size_t i = 0; i < tensors.size(); ++i) {
        const hdf5::Shape shape(tensors[i].shape.begin(), tensors[i].shape.end());
        const Named wanted{tensors[i].name.c_str(), H5T_IEEE_F32LE, shape};
        if (i + 1 == other)
            add_nearly(file, wanted, choose);
        else
            add_ones(file, wanted);
    }
}

void make_stgcn(hid_t file, Choices& choose) {
    eval::StgcnShape shape;
    shape.channels = channels;
    shape.classes = classes;
    shape.graph.parents = parents;
    shape.widths.fill(2);
    make(file, eval::stgcn_tensors(shape), choose);
}

void make_gru(hid_t file, Choices& choose) {
    make(file, eval::gru_tensors({channels * 2, 16, 3, classes}), choose);
}

void check(const std::map<std::string, std::vector<float>>& tensors) {
    demand(!tensors.empty());
    for (const auto& [name, values] : tensors)
        for (const auto value : values) demand(std::isfinite(value));
}

void read_stgcn(const std::string& path) {
    check(eval::read_stgcn_weights(path).tensors);
}

void read_gru(const std::string& path) {
    check(eval::read_gru_weights(path).tensors);
}

constexpr void (*makers[])(hid_t, Choices&) = {make_stgcn, make_gru};
constexpr void (*readers[])(const std::string&) = {read_stgcn, read_gru};

/// Weights of which nothing is chosen must be taken, else this throws: nothing behind a refusal of all would be tried.
bool try_sound_ones(const Hdf5InMemory& on_disk) {
    for (const std::size_t kind : {0, 1}) {
        Choices none(nullptr, 0);
        on_disk.write(made_file(makers[kind], none));
        readers[kind](on_disk.path());
    }
    return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hdf5::silence();
    static const Hdf5InMemory on_disk;
    [[maybe_unused]] static const bool tried = try_sound_ones(on_disk);
    Choices choose(data, size);
    const auto kind = choose.below(2);
    on_disk.write(made_file(makers[kind], choose));
    try_to([&] { readers[kind](on_disk.path()); });
    return 0;
}
