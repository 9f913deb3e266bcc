// HDF5 files made by the library from what a fuzzer's bytes choose.
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/hdf5/handle.hpp"

namespace actformer::fuzzing {

using hdf5::Handle;

/// Numbers out of the fuzzer's bytes; zeros behind the last.
class Choices {
  public:
    Choices(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
    bool more() const { return at_ < end_; }
    unsigned below(unsigned n) { return at_ < end_ ? *at_++ % n : 0; }

  private:
    const std::uint8_t *at_, *end_;
};

inline Handle any_type(Choices& choose) {
    static const hid_t numbers[] = {H5T_STD_I8LE,  H5T_STD_U16BE,  H5T_STD_I32LE,  H5T_STD_U64LE,
                                    H5T_STD_B32LE, H5T_IEEE_F32LE, H5T_IEEE_F32BE, H5T_IEEE_F64LE};
    const auto kind = choose.below(std::size(numbers) + 2);
    Handle type(H5Tcopy(kind < std::size(numbers) ? numbers[kind] : H5T_C_S1), H5Tclose);
    if (kind == std::size(numbers)) H5Tset_size(type.get(), 1 + choose.below(9));
    if (kind > std::size(numbers)) H5Tset_size(type.get(), H5T_VARIABLE);
    return type;
}

inline hdf5::Shape any_shape(Choices& choose) {
    hdf5::Shape shape(choose.below(5));
    for (auto& extent : shape) extent = choose.below(6);
    return shape;
}

inline Handle space_of(const hdf5::Shape& shape) {
    if (shape.empty()) return Handle(H5Screate(H5S_SCALAR), H5Sclose);
    return Handle(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
}

/// Enough bytes for any array above, of numbers or of texts; null texts where they are of variable length.
inline std::vector<char> values_for(hid_t type, char with) {
    return std::vector<char>(std::size_t{6 * 6 * 6 * 6 * 16}, H5Tis_variable_str(type) > 0 ? '\0' : with);
}

inline void add_array(hid_t file, const char* name, Choices& choose) {
    const auto type = any_type(choose);
    const auto shape = any_shape(choose);
    const Handle space = space_of(shape), plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const auto layout = choose.below(4);
    if (layout == 1) H5Pset_layout(plan.get(), H5D_COMPACT);
    if (layout > 1 && !shape.empty()) {
        hdf5::Shape chunk(shape);
        for (auto& extent : chunk)
            extent = 1 + choose.below(static_cast<unsigned>(std::max<hsize_t>(extent, 1)));
        H5Pset_chunk(plan.get(), static_cast<int>(chunk.size()), chunk.data());
        if (choose.below(2)) H5Pset_shuffle(plan.get());
        if (choose.below(2)) H5Pset_deflate(plan.get(), 6);
        if (choose.below(2)) H5Pset_fletcher32(plan.get());
    }
    const Handle set(H5Dcreate2(file, name, type.get(), space.get(), H5P_DEFAULT, plan.get(), H5P_DEFAULT),
                     H5Dclose);
    if (set && choose.below(4))
        H5Dwrite(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                 values_for(type.get(), static_cast<char>(choose.below(256))).data());
}

inline void add_attribute(hid_t file, const char* name, Choices& choose) {
    const auto type = any_type(choose);
    const auto space = space_of(any_shape(choose));
    const Handle attribute(H5Acreate2(file, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    if (attribute && choose.below(4))
        H5Awrite(attribute.get(), type.get(),
                 values_for(type.get(), static_cast<char>(choose.below(256))).data());
}

/// A new file in memory.
inline Handle new_file() {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_core(access.get(), 4096, false);
    return Handle(H5Fcreate("fuzz", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
}

inline std::vector<char> image_of(const Handle& file) {
    H5Fflush(file.get(), H5F_SCOPE_GLOBAL);
    std::vector<char> image(static_cast<std::size_t>(H5Fget_file_image(file.get(), nullptr, 0)));
    H5Fget_file_image(file.get(), image.data(), image.size());
    return image;
}

}  // namespace actformer::fuzzing
