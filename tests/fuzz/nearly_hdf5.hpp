// HDF5 files that are nearly what a reader wants, made by the library from what a fuzzer's bytes choose: each array and attribute is as it
// should be, another, elsewhere, or missing, and extents may be far beyond the file.
#pragma once

#include <cstring>
#include <string>

#include "base/hdf5/reader.hpp"
#include "tests/fuzz/any_hdf5.hpp"
#include "tests/fuzz/file_in_memory.hpp"

namespace actformer::fuzzing {

/// A number that stands nowhere else in such files.
constexpr std::uint64_t long_extent = 251;

struct Named {
    const char* name;
    hid_t type;
    hdf5::Shape shape;
};

/// Bytes that the fuzzer chooses, small numbers for the most part, and zeros behind the first few.
inline std::vector<char> chosen_values(hid_t type, std::size_t count, Choices& choose) {
    const auto size = H5Tget_size(type);
    std::vector<char> values(count * size);
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 8); ++i) {
        const auto how = choose.below(8);
        for (std::size_t b = 0; b < size; ++b)
            if (how == 7 || b == 0)
                values[i * size + b] = static_cast<char>(choose.below(how == 7 ? 256 : 4));
    }
    return values;
}

inline std::size_t numbers_in(const hdf5::Shape& shape) {
    std::size_t count = 1;
    for (const auto extent : shape) count *= extent;
    return count;
}

/// An array whose numbers lie elsewhere, or a link.
inline void add_away(hid_t file, const Named& wanted, Choices& choose) {
    const auto how = choose.below(3);
    if (how == 0) {
        H5Lcreate_soft(choose.below(2) ? "/soft" : wanted.name, file, wanted.name, H5P_DEFAULT, H5P_DEFAULT);
        return;
    }
    const auto space = space_of(wanted.shape);
    const Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (how == 1)
        H5Pset_external(plan.get(), "/proc/self/status", 0, H5F_UNLIMITED);
    else
        H5Pset_virtual(plan.get(), space.get(), ".", wanted.name, space.get());
    const Handle set(
        H5Dcreate2(file, wanted.name, wanted.type, space.get(), H5P_DEFAULT, plan.get(), H5P_DEFAULT),
        H5Dclose);
}

/// Wherever the file says `long_extent`, another number.
inline void lengthen(std::vector<char>& image, Choices& choose) {
    constexpr std::uint64_t to[] = {std::uint64_t{1} << 62, 6148914691236517206, std::uint64_t{1} << 40,
                                    ~std::uint64_t{0} - 1,  long_extent + 1,     0};
    const auto other = to[choose.below(std::size(to))];
    for (std::size_t at = 0; at + 8 <= image.size(); ++at)
        if (std::memcmp(&image[at], &long_extent, 8) == 0) std::memcpy(&image[at], &other, 8);
}

/// The array as it should be but for its values, one that is elsewhere, any array, or none.
inline void add_nearly(hid_t file, const Named& wanted, Choices& choose) {
    const auto how = choose.below(8);
    if (how == 7) return;
    if (how == 6) return add_array(file, wanted.name, choose);
    if (how == 5) return add_away(file, wanted, choose);
    const auto space = space_of(wanted.shape);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    const Handle set(
        H5Dcreate2(file, wanted.name, wanted.type, space.get(), links.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    if (set)
        H5Dwrite(set.get(), wanted.type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                 chosen_values(wanted.type, numbers_in(wanted.shape), choose).data());
}

inline void add_attribute_nearly(hid_t object, const Named& wanted, Choices& choose) {
    const auto how = choose.below(8);
    if (how == 7) return;
    if (how == 6) return add_attribute(object, wanted.name, choose);
    const auto space = space_of(wanted.shape);
    const Handle attribute(
        H5Acreate2(object, wanted.name, wanted.type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (attribute)
        H5Awrite(attribute.get(), wanted.type,
                 chosen_values(wanted.type, numbers_in(wanted.shape), choose).data());
}

inline Handle text_type(std::size_t size) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), size);
    return type;
}

inline void add_text(hid_t file, const char* name, const std::string& text) {
    const auto type = text_type(text.size());
    const auto space = space_of({});
    const Handle attribute(H5Acreate2(file, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    H5Awrite(attribute.get(), type.get(), text.data());
}

/// The bytes of a file that `make` fills, now and then with extents beyond it.
inline std::vector<char> made_file(void (*make)(hid_t, Choices&), Choices& choose) {
    const auto file = new_file();
    make(file.get(), choose);
    auto image = image_of(file);
    if (choose.below(4) == 1) lengthen(image, choose);
    return image;
}

/// A file that HDF5's library opens by its path: else readers would refuse all, and nothing be tried.
class Hdf5InMemory {
  public:
    Hdf5InMemory() {
        write(image_of(new_file()));
        demand(hdf5::Reader(path()).names().empty());
    }
    void write(const std::vector<char>& image, std::string_view behind = {}) const {
        std::string bytes(image.begin(), image.end());
        file_.write(bytes.append(behind));
    }
    const std::string& path() const { return file_.path(); }

  private:
    FileInMemory file_;
};

}  // namespace actformer::fuzzing
