#include "base/hdf5/reader.hpp"

#include <algorithm>
#include <numeric>

#include "base/error.hpp"

namespace actformer::hdf5 {
namespace {

/// `count` strings of `size` bytes, ended by zeros where they are shorter.
std::vector<std::string> unpacked(const std::vector<char>& text, std::size_t count, std::size_t size) {
    std::vector<std::string> values;
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const char* begin = text.data() + i * size;
        values.emplace_back(begin, std::find(begin, begin + size, '\0'));
    }
    return values;
}

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* names) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return 0;
}

}  // namespace

Reader::Reader(const std::filesystem::path& path) : path_(path) {
    silence();
    if (!std::filesystem::exists(path)) throw Error("{}: no such file", path.string());
    file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file_) throw Error("{}: not an HDF5 file, or damaged", path.string());
}

std::vector<std::string> Reader::names() const {
    std::vector<std::string> names;
    if (H5Literate(file_.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names) < 0)
        throw Error("{}: its list of contents cannot be read: damaged", path_.string());
    return names;
}

bool Reader::has(const std::string& name) const {
    for (auto slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
        if (H5Lexists(file_.get(), name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

bool Reader::is_array(const std::string& name) const {
    H5O_info_t info;
    return H5Oget_info_by_name(file_.get(), name.c_str(), &info, H5P_DEFAULT) >= 0 &&
           info.type == H5O_TYPE_DATASET;
}

Handle Reader::open(const std::string& name) const {
    if (!has(name)) throw Error("{}: holds no '{}'", path_.string(), name);
    Handle set(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set) throw Error("{}: '{}' is no array, or damaged", path_.string(), name);
    return set;
}

Shape Reader::shape(const std::string& name) const {
    const auto set = open(name);
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    const int rank = space ? H5Sget_simple_extent_ndims(space.get()) : -1;
    if (rank < 0) throw Error("{}: '{}' has no shape: damaged", path_.string(), name);
    Shape shape(rank);
    H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
    return shape;
}

std::optional<std::uint64_t> Reader::offset(const std::string& name) const {
    const auto at = H5Dget_offset(open(name).get());
    return at == HADDR_UNDEF ? std::nullopt : std::optional<std::uint64_t>(at);
}

std::size_t Reader::elements(const Shape& shape) {
    return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

void Reader::read_into(const std::string& name, hid_t type, void* to) const {
    const auto set = open(name);
    const Handle stored(H5Dget_type(set.get()), H5Tclose);
    const auto kind = H5Tget_class(stored.get());
    if (kind != H5T_INTEGER && kind != H5T_FLOAT)
        throw Error("{}: '{}' holds no numbers", path_.string(), name);
    if (H5Dread(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) < 0)
        throw Error("{}: '{}' cannot be read: damaged", path_.string(), name);
}

std::vector<float> Reader::read_rows(const std::string& name, std::uint64_t first,
                                     std::uint64_t count) const {
    const auto set = open(name);
    auto extent = shape(name);
    if (extent.empty() || first + count > extent[0] || first + count < first)
        throw Error("{}: '{}' has no rows {} to {}", path_.string(), name, first, first + count);
    Shape start(extent.size(), 0);
    start[0] = first;
    extent[0] = count;
    std::vector<float> values(elements(extent));
    if (values.empty()) return values;
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    const Handle memory(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
    if (H5Dread(set.get(), H5T_NATIVE_FLOAT, memory.get(), space.get(), H5P_DEFAULT, values.data()) < 0)
        throw Error("{}: '{}' cannot be read at row {}: damaged; see actformer inspect --verify",
                    path_.string(), name, first);
    return values;
}

std::vector<std::string> Reader::read_strings(const std::string& name) const {
    const auto set = open(name);
    const Handle stored(H5Dget_type(set.get()), H5Tclose);
    if (H5Tget_class(stored.get()) != H5T_STRING) throw Error("{}: '{}' holds no text", path_.string(), name);
    if (H5Tis_variable_str(stored.get()) > 0) return read_variable_strings(set, stored, name);
    const auto count = elements(shape(name)), size = H5Tget_size(stored.get());
    std::vector<char> text(count * size);
    if (H5Dread(set.get(), stored.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
        throw Error("{}: '{}' cannot be read: damaged", path_.string(), name);
    return unpacked(text, count, size);
}

struct Reader::Attribute {
    Handle handle, type;
    std::size_t count = 0;
    std::string where;

    void read(hid_t as, void* to) const {
        if (count > 0 && H5Aread(handle.get(), as, to) < 0) throw Error("{} cannot be read: damaged", where);
    }
};

bool Reader::has_attribute(const std::string& name, const std::string& of) const {
    return H5Aexists_by_name(file_.get(), of.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

Reader::Attribute Reader::open_attribute(const std::string& name, const std::string& of, H5T_class_t kind,
                                         const char* what) const {
    const auto where = of == "/" ? path_.string() : fmt::format("{}: '{}'", path_.string(), of);
    if (!has_attribute(name, of)) throw Error("{}: has no attribute '{}'", where, name);
    Attribute attribute{
        Handle(H5Aopen_by_name(file_.get(), of.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose),
        {},
        0,
        fmt::format("{}: attribute '{}'", where, name)};
    attribute.type = Handle(H5Aget_type(attribute.handle.get()), H5Tclose);
    const Handle space(H5Aget_space(attribute.handle.get()), H5Sclose);
    if (!attribute.type || H5Tget_class(attribute.type.get()) != kind || !space)
        throw Error("{} holds no {}", attribute.where, what);
    attribute.count =
        static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space.get()), 0));
    return attribute;
}

std::vector<std::string> Reader::read_variable_strings(const Handle& set, const Handle& type,
                                                       const std::string& name) const {
    std::vector<char*> texts(elements(shape(name)), nullptr);
    if (H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()) < 0)
        throw Error("{}: '{}' cannot be read: damaged", path_.string(), name);
    std::vector<std::string> values;
    for (const char* text : texts) values.emplace_back(text ? text : "");
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, texts.data());
    return values;
}

std::vector<std::int64_t> Reader::attribute_numbers(const std::string& name, const std::string& of) const {
    const auto attribute = open_attribute(name, of, H5T_INTEGER, "whole numbers");
    std::vector<std::int64_t> values(attribute.count);
    attribute.read(H5T_NATIVE_INT64, values.data());
    return values;
}

std::vector<float> Reader::attribute_floats(const std::string& name, const std::string& of) const {
    const auto attribute = open_attribute(name, of, H5T_FLOAT, "numbers");
    std::vector<float> values(attribute.count);
    attribute.read(H5T_NATIVE_FLOAT, values.data());
    return values;
}

std::vector<std::string> Reader::attribute_texts(const std::string& name, const std::string& of) const {
    const auto attribute = open_attribute(name, of, H5T_STRING, "text");
    if (H5Tis_variable_str(attribute.type.get()) != 0)
        throw Error("{} holds no fixed-length strings", attribute.where);
    const auto size = H5Tget_size(attribute.type.get());
    std::vector<char> text(attribute.count * size);
    attribute.read(attribute.type.get(), text.data());
    return unpacked(text, attribute.count, size);
}

}  // namespace actformer::hdf5
