#include "ingest/hdf5.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "ingest/fletcher32.hpp"
#include "kernels/error.hpp"

namespace actformer::ingest::hdf5 {
namespace {

/// The library would print its own stack of errors beside ours, and at exit complain of files that a full disk left open.
void silence() {
    static const bool once = H5dont_atexit() >= 0;
    static_cast<void>(once);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Handle checked(hid_t id, herr_t (*close)(hid_t), const char* what) {
    if (id < 0) throw Error("HDF5: {} failed; is there enough memory?", what);
    return {id, close};
}

Handle string_type(std::size_t size) {
    auto type = checked(H5Tcopy(H5T_C_S1), H5Tclose, "making a string type");
    H5Tset_size(type.get(), std::max<std::size_t>(size, 1));
    H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
    return type;
}

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

struct Packed {
    std::size_t size = 1;
    std::string text;
};

Packed packed(const std::vector<std::string>& values) {
    Packed all;
    for (const auto& value : values) all.size = std::max(all.size, value.size());
    all.text.resize(values.size() * all.size, '\0');
    for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(all.text.data() + i * all.size, all.size);
    return all;
}

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* names) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return 0;
}

}  // namespace

Handle::~Handle() {
    if (id_ >= 0 && close_) close_(id_);
}

Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Handle& Handle::operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
}

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

    void read(hid_t as, void* to, const std::string& where) const {
        if (count > 0 && H5Aread(handle.get(), as, to) < 0) throw Error("{} cannot be read: damaged", where);
    }
};

bool Reader::has_attribute(const std::string& name) const {
    return H5Aexists(file_.get(), name.c_str()) > 0;
}

Reader::Attribute Reader::open_attribute(const std::string& name, H5T_class_t kind, const char* what) const {
    if (!has_attribute(name)) throw Error("{}: has no attribute '{}'", path_.string(), name);
    Attribute attribute{Handle(H5Aopen(file_.get(), name.c_str(), H5P_DEFAULT), H5Aclose), {}, 0};
    attribute.type = Handle(H5Aget_type(attribute.handle.get()), H5Tclose);
    const Handle space(H5Aget_space(attribute.handle.get()), H5Sclose);
    if (!attribute.type || H5Tget_class(attribute.type.get()) != kind || !space)
        throw Error("{}: attribute '{}' holds no {}", path_.string(), name, what);
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

std::vector<std::int64_t> Reader::attribute_numbers(const std::string& name) const {
    const auto attribute = open_attribute(name, H5T_INTEGER, "whole numbers");
    std::vector<std::int64_t> values(attribute.count);
    attribute.read(H5T_NATIVE_INT64, values.data(), fmt::format("{}: attribute '{}'", path_.string(), name));
    return values;
}

std::vector<float> Reader::attribute_floats(const std::string& name) const {
    const auto attribute = open_attribute(name, H5T_FLOAT, "numbers");
    std::vector<float> values(attribute.count);
    attribute.read(H5T_NATIVE_FLOAT, values.data(), fmt::format("{}: attribute '{}'", path_.string(), name));
    return values;
}

std::vector<std::string> Reader::attribute_texts(const std::string& name) const {
    const auto attribute = open_attribute(name, H5T_STRING, "text");
    if (H5Tis_variable_str(attribute.type.get()) != 0)
        throw Error("{}: attribute '{}' holds no fixed-length strings", path_.string(), name);
    const auto size = H5Tget_size(attribute.type.get());
    std::vector<char> text(attribute.count * size);
    attribute.read(attribute.type.get(), text.data(),
                   fmt::format("{}: attribute '{}'", path_.string(), name));
    return unpacked(text, attribute.count, size);
}

// Beside the values there are their names and shapes.
Writer::Writer(std::size_t expected_bytes)
    : memory_(std::make_unique<FileMemory>(expected_bytes + expected_bytes / 64 + (std::size_t{1} << 20))) {
    silence();
    const auto access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "making a file in memory");
    memory_->serve(access.get());
    file_ = checked(H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose,
                    "making a file in memory");
}

Writer::Writer(const std::filesystem::path& path) {
    silence();
    file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    if (!file_) throw Error("{}: cannot be written; is the folder there, and yours to write?", path.string());
}

bool Writer::finish() {
    const bool written = H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0;
    file_ = {};
    return written;
}

Handle Writer::create(const std::string& name, hid_t type, const Shape& shape, hsize_t rows_a_chunk) {
    const auto space = checked(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                               H5Sclose, "describing an array");
    const auto layout = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "describing an array");
    H5Pset_obj_track_times(layout.get(), false);  // the same data must give the same bytes
    if (rows_a_chunk > 0 && shape[0] > 0) {
        auto chunk = shape;
        chunk[0] = std::min(rows_a_chunk, shape[0]);
        H5Pset_chunk(layout.get(), static_cast<int>(chunk.size()), chunk.data());
        H5Pset_fletcher32(layout.get());
    }
    const auto links = checked(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "describing an array");
    H5Pset_create_intermediate_group(links.get(), 1);
    return checked(
        H5Dcreate2(file_.get(), name.c_str(), type, space.get(), links.get(), layout.get(), H5P_DEFAULT),
        H5Dclose, "adding an array");
}

void Writer::write_from(const std::string& name, hid_t type, const Shape& shape, const void* values,
                        hsize_t rows_a_chunk) {
    const auto set = create(name, type, shape, rows_a_chunk);
    if (std::find(shape.begin(), shape.end(), 0U) == shape.end() &&
        H5Dwrite(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
        throw Error("HDF5: writing '{}' failed; is there space left?", name);
}

// Whole chunks go past the library's filters and chunk cache, which copy every byte more often than all else that is done to it.
void Writer::write_pieces(const std::string& name, const Shape& shape,
                          const std::vector<std::span<const float>>& pieces, hsize_t rows_a_chunk) {
    const auto set = create(name, H5T_NATIVE_FLOAT, shape, rows_a_chunk);
    const auto row = std::accumulate(shape.begin() + 1, shape.end(), std::size_t{1}, std::multiplies<>());
    const std::size_t numbers = std::min(rows_a_chunk, shape[0]) * row;
    std::vector<float> chunk(numbers + 1);  // the checksum goes behind
    Shape at(shape.size(), 0);
    std::size_t filled = 0;
    const auto write_chunk = [&] {
        std::fill(chunk.begin() + static_cast<std::ptrdiff_t>(filled), chunk.end(), 0.0F);
        chunk.back() = std::bit_cast<float>(fletcher32(std::span(chunk).first(numbers)));
        if (H5Dwrite_chunk(set.get(), H5P_DEFAULT, 0, at.data(), chunk.size() * sizeof(float), chunk.data()) <
            0)
            throw Error("HDF5: writing '{}' failed; is there enough memory?", name);
        at[0] += rows_a_chunk;
        filled = 0;
    };
    for (auto piece : pieces)
        while (!piece.empty()) {
            const auto part = piece.first(std::min(piece.size(), numbers - filled));
            std::copy(part.begin(), part.end(), chunk.begin() + static_cast<std::ptrdiff_t>(filled));
            piece = piece.subspan(part.size());
            filled += part.size();
            if (filled == numbers) write_chunk();
        }
    if (filled > 0) write_chunk();
}

void Writer::write_rows(const std::string& name, const Shape& shape, std::uint64_t first,
                        std::span<const float> values) {
    const auto set =
        H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0
            ? checked(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose, "adding to an array")
            : create(name, H5T_NATIVE_FLOAT, shape, 0);
    Shape start(shape.size(), 0), part = shape;
    start[0] = first;
    part[0] =
        values.size() / std::accumulate(shape.begin() + 1, shape.end(), hsize_t{1}, std::multiplies<>());
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    const Handle memory(H5Screate_simple(static_cast<int>(part.size()), part.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr);
    if (H5Dwrite(set.get(), H5T_NATIVE_FLOAT, memory.get(), space.get(), H5P_DEFAULT, values.data()) < 0)
        throw Error("HDF5: writing '{}' failed; is there space left?", name);
}

void Writer::write_strings(const std::string& name, const std::vector<std::string>& values) {
    const auto all = packed(values);
    write_from(name, string_type(all.size).get(), {values.size()}, all.text.data(), 0);
}

void Writer::attribute_from(const std::string& name, hid_t type, const Handle& space, const void* value) {
    const auto attribute =
        checked(H5Acreate2(file_.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                "adding an attribute");
    H5Awrite(attribute.get(), type, value);
}

void Writer::attribute(const std::string& name, const std::string& value) {
    attribute_from(name, string_type(value.size()).get(), Handle(H5Screate(H5S_SCALAR), H5Sclose),
                   value.data());
}

void Writer::attribute(const std::string& name, std::int64_t value) {
    attribute_from(name, H5T_NATIVE_INT64, Handle(H5Screate(H5S_SCALAR), H5Sclose), &value);
}

void Writer::attribute(const std::string& name, const std::vector<std::int64_t>& values) {
    const hsize_t count = values.size();
    attribute_from(name, H5T_NATIVE_INT64, Handle(H5Screate_simple(1, &count, nullptr), H5Sclose),
                   values.data());
}

void Writer::attribute(const std::string& name, const std::vector<float>& values) {
    const hsize_t count = values.size();
    attribute_from(name, H5T_NATIVE_FLOAT, Handle(H5Screate_simple(1, &count, nullptr), H5Sclose),
                   values.data());
}

void Writer::attribute(const std::string& name, const std::vector<std::string>& values) {
    const auto all = packed(values);
    const hsize_t count = values.size();
    attribute_from(name, string_type(all.size).get(), Handle(H5Screate_simple(1, &count, nullptr), H5Sclose),
                   all.text.data());
}

void Writer::image(const std::function<void(std::string_view)>& use) {
    void* memory = nullptr;  // of the file itself: a copy would cost as much again
    hsize_t size = 0;
    if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0 ||
        H5Fget_vfd_handle(file_.get(), H5P_DEFAULT, &memory) < 0 || H5Fget_filesize(file_.get(), &size) < 0)
        throw Error("HDF5: a file in memory cannot be read back; is there enough memory?");
    use({*static_cast<const char**>(memory), size});
}

}  // namespace actformer::ingest::hdf5
