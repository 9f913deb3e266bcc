#include "base/hdf5/writer.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/checksum/checksum.hpp"
#include "base/checksum/fletcher32.hpp"
#include "base/checksum/own_checksum.hpp"
#include "base/error.hpp"
#include "base/hdf5/file_on_disk.hpp"

namespace actformer::hdf5 {
namespace {

Handle string_type(std::size_t size) {
    auto type = checked(H5Tcopy(H5T_C_S1), H5Tclose, "making a string type");
    H5Tset_size(type.get(), std::max<std::size_t>(size, 1));
    H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
    return type;
}

/// Of the longest; at least 1.
std::size_t longest(const std::vector<std::string>& values) {
    std::size_t size = 1;
    for (const auto& value : values) size = std::max(size, value.size());
    return size;
}

struct Packed {
    std::size_t size;
    std::string text;
};

Packed packed(const std::vector<std::string>& values) {
    Packed all{longest(values), {}};
    all.text.resize(values.size() * all.size, '\0');
    for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(all.text.data() + i * all.size, all.size);
    return all;
}

}  // namespace

std::size_t packed_size(const std::vector<std::string>& values) {
    return values.size() * longest(values);
}

Writer::Writer(std::size_t expected_bytes) : memory_(std::make_unique<FileMemory>()) {
    create_in(*memory_, expected_bytes);
}

Writer::Writer(FileMemory& memory, std::size_t expected_bytes) {
    create_in(memory, expected_bytes);
}

// Beside the values there are their names and shapes.
void Writer::create_in(FileMemory& memory, std::size_t expected_bytes) {
    silence();
    const auto access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "making a file in memory");
    memory.serve(access.get(), expected_bytes + expected_bytes / 64 + (std::size_t{1} << 20));
    file_ = checked(H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose,
                    "making a file in memory");
}

Writer::Writer(const std::filesystem::path& path, Sync sync) : aside_(std::make_unique<Aside>(path, sync)) {
    silence();
    const auto access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "making a file");
    serve(*aside_, access.get());
    file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
    need(static_cast<bool>(file_), "superblock");
}

Writer::~Writer() = default;
Writer::Writer(Writer&& other) noexcept = default;

void Writer::finish() {
    const bool flushed = H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0;
    need(file_.close() && flushed, "superblock");
    add_checksum();
    aside_->commit();
}

/// Reads back what the library wrote, which went back and forth.
void Writer::add_checksum() {
    const auto size = aside_->size();
    std::string piece(std::size_t{1} << 20, '\0');
    Checksum sum;
    for (std::uint64_t at = 0; at < size; at += piece.size()) {
        piece.resize(std::min<std::uint64_t>(piece.size(), size - at));
        aside_->read_at(at, piece.data(), piece.size());
        sum.add(piece);
    }
    aside_->write_at(size, checksum_line_of(sum));
}

/// The disk's failure, where there was one, also where the library hid it; else what could not be `written`.
void Writer::need(bool written, const std::string& name) const {
    if (aside_) aside_->check();
    if (!written)
        throw Error("{}: writing '{}' failed; is there enough memory?",
                    aside_ ? aside_->path().string() : "HDF5", name);
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
    Handle made(
        H5Dcreate2(file_.get(), name.c_str(), type, space.get(), links.get(), layout.get(), H5P_DEFAULT),
        H5Dclose);
    need(static_cast<bool>(made), name);
    return made;
}

void Writer::write_from(const std::string& name, hid_t type, const Shape& shape, const void* values,
                        hsize_t rows_a_chunk) {
    auto set = create(name, type, shape, rows_a_chunk);
    if (std::find(shape.begin(), shape.end(), 0U) == shape.end())
        need(H5Dwrite(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, name);
    need(set.close(), name);
    const auto bytes = std::accumulate(shape.begin(), shape.end(), H5Tget_size(type), std::multiplies<>());
    note_array(name, type, shape, checksum({static_cast<const char*>(values), bytes}));
}

void Writer::note_array(const std::string& name, hid_t type, const Shape& shape,
                        const std::string& checksum) {
    for (auto slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
        contents_.add_group(name.substr(0, slash));
    contents_.add_array(name, type, shape, checksum);
}

// Whole chunks go past the library's filters and chunk cache, which copy every byte more often than all else that is done to it.
void Writer::write_pieces(const std::string& name, const Shape& shape,
                          const std::vector<std::span<const float>>& pieces, hsize_t rows_a_chunk) {
    auto set = create(name, H5T_NATIVE_FLOAT, shape, rows_a_chunk);
    const auto row = std::accumulate(shape.begin() + 1, shape.end(), std::size_t{1}, std::multiplies<>());
    const std::size_t numbers = std::min(rows_a_chunk, shape[0]) * row;
    std::vector<float> chunk(numbers + 1);  // the checksum goes behind
    Shape at(shape.size(), 0);
    std::size_t filled = 0;
    Checksum sum;
    const auto write_chunk = [&] {
        sum.add({reinterpret_cast<const char*>(chunk.data()), filled * sizeof(float)});
        std::fill(chunk.begin() + static_cast<std::ptrdiff_t>(filled), chunk.end(), 0.0F);
        chunk.back() = std::bit_cast<float>(fletcher32(std::span(chunk).first(numbers)));
        need(H5Dwrite_chunk(set.get(), H5P_DEFAULT, 0, at.data(), chunk.size() * sizeof(float),
                            chunk.data()) >= 0,
             name);
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
    need(set.close(), name);
    note_array(name, H5T_NATIVE_FLOAT, shape, sum.hex());
}

void Writer::write_rows(const std::string& name, const Shape& shape, std::uint64_t first,
                        std::span<const float> values) {
    auto set = H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0
                   ? checked(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose, "adding to an array")
                   : create(name, H5T_NATIVE_FLOAT, shape, 0);
    Shape start(shape.size(), 0), part = shape;
    start[0] = first;
    part[0] =
        values.size() / std::accumulate(shape.begin() + 1, shape.end(), hsize_t{1}, std::multiplies<>());
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    const Handle memory(H5Screate_simple(static_cast<int>(part.size()), part.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr);
    need(H5Dwrite(set.get(), H5T_NATIVE_FLOAT, memory.get(), space.get(), H5P_DEFAULT, values.data()) >= 0,
         name);
    need(set.close(), name);
}

void Writer::write_strings(const std::string& name, const std::vector<std::string>& values) {
    const auto all = packed(values);
    write_from(name, string_type(all.size).get(), {values.size()}, all.text.data(), 0);
}

void Writer::attribute_from(const std::string& name, const std::string& of, hid_t type, const Shape& shape,
                            const void* value) {
    const auto bytes = std::accumulate(shape.begin(), shape.end(), H5Tget_size(type), std::multiplies<>());
    if (bytes > largest_attribute)
        throw Error("{}: attribute '{}' would take {} bytes, and HDF5 keeps at most {} in one",
                    aside_ ? aside_->path().string() : "HDF5", name, bytes, largest_attribute);
    const Handle space(shape.empty()
                           ? H5Screate(H5S_SCALAR)
                           : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose);
    Handle attribute(H5Acreate_by_name(file_.get(), of.c_str(), name.c_str(), type, space.get(), H5P_DEFAULT,
                                       H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
    need(static_cast<bool>(attribute), name);
    need(H5Awrite(attribute.get(), type, value) >= 0, name);
    need(attribute.close(), name);
    contents_.add_attribute(of == "/" ? std::string() : of, name, type, shape,
                            {static_cast<const char*>(value), bytes});
}

void Writer::attribute(const std::string& name, const std::string& value, const std::string& of) {
    const auto all = packed({value});
    attribute_from(name, of, string_type(all.size).get(), {}, all.text.data());
}

void Writer::attribute(const std::string& name, std::int64_t value, const std::string& of) {
    attribute_from(name, of, H5T_NATIVE_INT64, {}, &value);
}

void Writer::attribute(const std::string& name, const std::vector<std::int64_t>& values,
                       const std::string& of) {
    attribute_from(name, of, H5T_NATIVE_INT64, {values.size()}, values.data());
}

void Writer::attribute(const std::string& name, const std::vector<float>& values, const std::string& of) {
    attribute_from(name, of, H5T_NATIVE_FLOAT, {values.size()}, values.data());
}

void Writer::attribute(const std::string& name, const std::vector<std::string>& values,
                       const std::string& of) {
    const auto all = packed(values);
    attribute_from(name, of, string_type(all.size).get(), {values.size()}, all.text.data());
}

std::string_view Writer::image() {
    void* memory = nullptr;  // of the file itself: a copy would cost as much again
    hsize_t size = 0;
    if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0 ||
        H5Fget_vfd_handle(file_.get(), H5P_DEFAULT, &memory) < 0 || H5Fget_filesize(file_.get(), &size) < 0)
        throw Error("HDF5: a file in memory cannot be read back; is there enough memory?");
    return {*static_cast<const char**>(memory), size};
}

std::string Writer::checked_image() {
    const auto bytes = image();
    return std::string(bytes) + checksum_line(bytes);
}

}  // namespace actformer::hdf5
