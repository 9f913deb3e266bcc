#include "base/hdf5/reader.hpp"

#include <algorithm>
#include <fstream>
#include <limits>

#include "base/checksum/own_checksum.hpp"
#include "base/hdf5/attribute_bytes.hpp"
#include "base/hdf5/checked_chunk.hpp"
#include "base/hdf5/opening.hpp"
#include "base/hdf5/variable_texts.hpp"
#include "base/text/printable.hpp"

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

/// a * b, or the largest number where that is less than the product.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    std::uint64_t out = 0;
    return __builtin_mul_overflow(a, b, &out) ? std::numeric_limits<std::uint64_t>::max() : out;
}

std::uint64_t product(const Shape& shape) {
    std::uint64_t out = 1;
    for (const auto extent : shape) out = product(out, extent);
    return out;
}

/// Whether a chunk may be smaller in the file than in memory: the other two filters keep its size.
bool compressed(hid_t plan) {
    for (int i = 0; i < H5Pget_nfilters(plan); ++i) {
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        const auto filter =
            H5Pget_filter2(plan, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &config);
        if (filter != H5Z_FILTER_FLETCHER32 && filter != H5Z_FILTER_SHUFFLE) return true;
    }
    return false;
}

// Deflate makes no more of a byte. Of motion it makes two or three; much memory is taken for no more than a hundred.
constexpr std::uint64_t most_compressed = 1032, most_of_much = 100, much = std::uint64_t{1} << 30;

constexpr int most_links = 16;     // one behind the other; the library follows no more
constexpr int most_followed = 64;  // on the way to one array

/// Where a link within the file leads, from the root.
std::string target_of(const std::string& link, const std::string& to) {
    const auto folder = link.find_last_of('/');
    return to.starts_with('/') || folder == std::string::npos ? to : link.substr(0, folder + 1) + to;
}

/// From 1.12 on the library wants to know which fields.
herr_t info_by_name(hid_t file, const char* name, H5O_info_t& info) {
#if H5_VERSION_GE(1, 12, 0)
    return H5Oget_info_by_name(file, name, &info, H5O_INFO_BASIC, H5P_DEFAULT);
#else
    return H5Oget_info_by_name(file, name, &info, H5P_DEFAULT);
#endif
}

/// Where an object's header lies in the file. From 1.12 on the older function alone tells it.
std::optional<std::uint64_t> header_address(hid_t file, const char* name) {
#if H5_VERSION_GE(1, 12, 0)
    H5O_info1_t info;
    const bool known = H5Oget_info_by_name1(file, name, &info, H5P_DEFAULT) >= 0;
#else
    H5O_info_t info;
    const bool known = H5Oget_info_by_name(file, name, &info, H5P_DEFAULT) >= 0;
#endif
    return known ? std::optional<std::uint64_t>(info.addr) : std::nullopt;
}

}  // namespace

bool is_long_path(std::string_view path) {
    return path.size() > longest_path ||
           std::ranges::count(path, '/') >= static_cast<std::ptrdiff_t>(most_path_parts);
}

Reader::Reader(const std::filesystem::path& path)
    : path_(path.string()), file_(open_to_read(path)), bytes_(std::filesystem::file_size(path)) {
    if (!has_checksum_line(path)) refuse_own_without_checksum();
}

Reader::Reader(std::string_view image, const std::string& name)
    : path_(name), image_(image), file_(open_in_memory(image, name)), bytes_(image.size()) {
    if (!has_checksum_line(image)) refuse_own_without_checksum();
}

void Reader::refuse_own_without_checksum() const {
    if (!has_attribute("program") || has_attribute("dataset")) return;
    std::vector<std::string> program;
    try {
        program = attribute_texts("program");
    } catch (const Error&) {  // no text: another program's
    }
    if (program.size() == 1 && names_this_program(program[0]))
        fail(
            "damaged: its checksum is missing; make it again, or copy it again. If you changed it, remove "
            "its attribute 'program'");
}

std::vector<std::string> Reader::names() const {
    std::vector<std::string> names;
    if (H5Literate(file_.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names) < 0)
        fail("its list of contents cannot be read: damaged");
    return names;
}

bool Reader::has(const std::string& name) const {
    for (auto slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
        if (H5Lexists(file_.get(), name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

/// The library follows no link into another file (see silence()); here they are named, also those that a link within the file leads to.
void Reader::refuse_links_away(const std::string& name) const {
    int followed = 0;
    refuse_links_away(name, 0, followed);
}

/// Sees every link before the library follows it.
void Reader::refuse_links_away(const std::string& name, int depth, int& followed) const {
    if (is_long_path(name))
        fail(
            "{} is a path of more than {} parts or {} bytes, which is not followed; move the array nearer to "
            "the top",
            in_quotes(name), most_path_parts, longest_path);
    for (auto slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
        const auto part = name.substr(0, slash);
        H5L_info_t info{};
        const bool known = H5Lget_info(file_.get(), part.c_str(), &info, H5P_DEFAULT) >= 0;
        if (known && info.type >= H5L_TYPE_UD_MIN)
            fail("'{}' is a link into another file, which is not followed; copy the array into this one",
                 part);
        if (known && info.type == H5L_TYPE_SOFT && depth < most_links) {
            if (++followed > most_followed)
                fail("{} leads over more than {} links, which are not followed; copy the array there",
                     in_quotes(name), most_followed);
            // of a long one as much as tells that it is
            std::string to(std::min(info.u.val_size, longest_path + 2), '\0');
            if (H5Lget_val(file_.get(), part.c_str(), to.data(), to.size(), H5P_DEFAULT) >= 0)
                refuse_links_away(target_of(part, to.substr(0, to.find('\0'))), depth + 1, followed);
        }
        if (slash == std::string::npos) return;
    }
}

bool Reader::is_array(const std::string& name) const {
    refuse_links_away(name);
    H5O_info_t info;
    return info_by_name(file_.get(), name.c_str(), info) >= 0 && info.type == H5O_TYPE_DATASET;
}

void Reader::expect_room_for(const std::vector<std::string>& names) const {
    std::uint64_t bytes = 0;
    for (const auto& name : names) {
        const auto array = open(name);
        bytes += std::min(array.numbers * H5Tget_size(array.type.get()), ~bytes);
    }
    if (bytes > much && bytes > product(bytes_, most_of_much))
        fail("its {} arrays would take {} MiB out of {} MiB: names of one array, or damaged; make it again",
             names.size(), bytes >> 20, bytes_ >> 20);
}

Reader::Array Reader::open(const std::string& name) const {
    refuse_links_away(name);
    if (!has(name)) fail("holds no '{}'", name);
    Array array{name, Handle(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose), {}, {}, 0};
    if (!array.set) fail("'{}' is no array, or damaged", name);
    check_layout(array);
    return array;
}

/// Finds type and shape. Refuses links and storage outside the file before the library follows them, and shapes larger than the file
/// before memory is taken for them.
void Reader::check_layout(Array& array) const {
    const Handle plan(H5Dget_create_plist(array.set.get()), H5Pclose);
    const auto layout = plan ? H5Pget_layout(plan.get()) : H5D_LAYOUT_ERROR;
    if (layout == H5D_VIRTUAL)
        fail("'{}' is a virtual array, whose numbers lie elsewhere; copy them into an array of this file",
             array.name);
    if (layout < 0) fail("'{}' cannot be read: damaged", array.name);
    if (H5Pget_external_count(plan.get()) != 0)
        fail("'{}' keeps its numbers in another file; copy them into an array of this one", array.name);
    array.type = Handle(H5Dget_type(array.set.get()), H5Tclose);
    const Handle space(H5Dget_space(array.set.get()), H5Sclose);
    const int rank = space ? H5Sget_simple_extent_ndims(space.get()) : -1;
    if (rank < 0 || !array.type) fail("'{}' has no shape: damaged", array.name);
    array.shape.resize(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.get(), array.shape.data(), nullptr);
    if (H5Sget_simple_extent_type(space.get()) == H5S_NULL) array.shape = {0};

    const auto numbers = product(array.shape), size = std::uint64_t{H5Tget_size(array.type.get())};
    const std::uint64_t stored = H5Dget_storage_size(array.set.get());
    const auto growth = compressed(plan.get()) ? most_compressed : 1;
    Shape chunk(array.shape.size());
    if (layout == H5D_CHUNKED && numbers > 0 &&
        (H5Pget_chunk(plan.get(), rank, chunk.data()) != rank ||
         product(product(chunk), size) > product(bytes_, growth)))
        fail("'{}' has chunks larger than the file: damaged", array.name);
    if (size == 0 || stored > bytes_ || product(numbers, size) > product(stored, growth))
        fail("'{}' is said to be {} of {} bytes, but {} bytes are stored: damaged, or never filled",
             array.name, fmt::join(array.shape, " x "), size, stored);
    if (numbers * size > much && numbers * size > product(stored, most_of_much))
        fail("'{}' would take {} MiB out of {} MiB; h5repack -f NONE first if that is right", array.name,
             numbers * size >> 20, stored >> 20);
    array.numbers = numbers;
    array.checked_chunk = checked_chunk_of(plan.get(), array.shape.size());
}

/// Whether the array is float32 in checked chunks of whole rows, as this program writes motions.
bool Reader::has_checked_rows(const Array& array) {
    const auto& chunk = array.checked_chunk;
    return !chunk.empty() && H5Tequal(array.type.get(), H5T_IEEE_F32LE) > 0 &&
           std::equal(chunk.begin() + 1, chunk.end(), array.shape.begin() + 1);
}

void Reader::read_checked_rows(const Array& array, std::uint64_t first, std::span<float> values) const {
    const std::uint64_t rows = array.checked_chunk[0], numbers = product(array.checked_chunk),
                        row = numbers / rows;
    Shape at(array.shape.size(), 0);
    for (auto place = first * row; !values.empty();) {
        at[0] = place / numbers * rows;
        if (array.chunk.empty() || array.chunk_at != at[0]) {
            array.chunk.resize(numbers + 1);
            if (!read_checked_chunk(array.set.get(), at, array.chunk)) {
                array.chunk.clear();
                fail(
                    "'{}' is not what its checksum says from row {} on: damaged; see actformer inspect "
                    "--verify",
                    array.name, at[0]);
            }
            array.chunk_at = at[0];
        }
        const std::uint64_t from = place % numbers,
                            count = std::min<std::uint64_t>(values.size(), numbers - from);
        std::copy_n(array.chunk.begin() + static_cast<std::ptrdiff_t>(from), count, values.begin());
        values = values.subspan(count);
        place += count;
    }
}

Shape Reader::shape(const std::string& name) const {
    return open(name).shape;
}

std::optional<std::uint64_t> Reader::offset(const std::string& name) const {
    const auto at = H5Dget_offset(open(name).set.get());
    return at == HADDR_UNDEF ? std::nullopt : std::optional<std::uint64_t>(at);
}

bool Reader::holds_doubles(const std::string& name) const {
    const auto array = open(name);
    return H5Tget_class(array.type.get()) == H5T_FLOAT && H5Tget_size(array.type.get()) == sizeof(double);
}

void Reader::read_into(const Array& array, hid_t type, void* to) const {
    const auto kind = H5Tget_class(array.type.get());
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) fail("'{}' holds no numbers", array.name);
    if (array.numbers > 0 && H5Dread(array.set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) < 0)
        fail("'{}' cannot be read: damaged", array.name);
}

std::vector<float> Reader::read_rows(const std::string& name, std::uint64_t first,
                                     std::uint64_t count) const {
    auto found = open_.find(name);
    if (found == open_.end()) found = open_.emplace(name, open(name)).first;
    const auto& array = found->second;
    auto extent = array.shape;
    if (extent.empty() || first > extent[0] || count > extent[0] - first)
        fail("'{}' has no rows {} to {}", name, first, first + count);
    Shape start(extent.size(), 0);
    start[0] = first;
    extent[0] = count;
    auto values = room<float>(product(extent), name);
    if (values.empty()) return values;
    if (has_checked_rows(array)) {
        read_checked_rows(array, first, values);
        return values;
    }
    const Handle space(H5Dget_space(array.set.get()), H5Sclose);
    const Handle memory(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
    if (H5Dread(array.set.get(), H5T_NATIVE_FLOAT, memory.get(), space.get(), H5P_DEFAULT, values.data()) < 0)
        fail("'{}' cannot be read at row {}: damaged; see actformer inspect --verify", name, first);
    return values;
}

std::vector<std::string> Reader::read_strings(const std::string& name) const {
    const auto array = open(name);
    if (H5Tget_class(array.type.get()) != H5T_STRING) fail("'{}' holds no text", name);
    if (H5Tis_variable_str(array.type.get()) > 0) return read_variable_strings(array);
    const auto size = H5Tget_size(array.type.get());
    auto text = room<char>(array.numbers * size, name);
    if (!text.empty() &&
        H5Dread(array.set.get(), array.type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
        fail("'{}' cannot be read: damaged", name);
    return unpacked(text, array.numbers, size);
}

std::vector<std::string> Reader::read_variable_strings(const Array& array) const {
    if (array.numbers == 0) return {};
    const auto at = H5Dget_offset(array.set.get());
    if (at == HADDR_UNDEF || H5Dget_storage_size(array.set.get()) != array.numbers * 16)
        fail("'{}' holds texts of variable length in pieces; store them at one length, or in one piece",
             array.name);
    return variable_texts(bytes_at(at, array.numbers * 16), array.numbers, fmt::format("'{}'", array.name));
}

/// `count` texts that `references` lead to, of what is at `where`.
std::vector<std::string> Reader::variable_texts(std::string_view references, std::size_t count,
                                                const std::string& where) const {
    std::vector<std::string> texts;
    const auto file = [&](std::uint64_t offset, std::uint64_t size) { return bytes_at(offset, size); };
    if (references.size() < count * 16 ||
        !read_variable_texts(references.substr(0, count * 16), file, bytes_, texts))
        fail("{} cannot be read: damaged", where);
    return texts;
}

std::string Reader::bytes_at(std::uint64_t offset, std::uint64_t size) const {
    size = std::min(size, bytes_ - std::min(offset, bytes_));
    if (!image_.empty()) return image_.substr(std::min<std::uint64_t>(offset, image_.size()), size);
    std::string bytes(size, '\0');
    std::ifstream file(path_, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(offset));
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

struct Reader::Attribute {
    Handle handle, type;
    std::size_t count = 0;
    std::string where;  ///< the file, what it belongs to and its name
};

bool Reader::has_attribute(const std::string& name, const std::string& of) const {
    if (of == "/") return H5Aexists(file_.get(), name.c_str()) > 0;
    return H5Aexists(open(of).set.get(), name.c_str()) > 0;  // open() refuses what lies in other files
}

Reader::Attribute Reader::open_attribute(const std::string& name, const std::string& of,
                                         std::initializer_list<H5T_class_t> kinds, const char* what) const {
    const auto owner = of == "/" ? std::string() : fmt::format("'{}' ", of);
    if (!has_attribute(name, of)) fail("{}has no attribute '{}'", owner, name);
    Attribute attribute{
        Handle(H5Aopen(of == "/" ? file_.get() : open(of).set.get(), name.c_str(), H5P_DEFAULT), H5Aclose),
        {},
        0,
        of == "/" ? fmt::format("attribute '{}'", name) : fmt::format("attribute '{}' of '{}'", name, of)};
    attribute.type = Handle(H5Aget_type(attribute.handle.get()), H5Tclose);
    const Handle space(H5Aget_space(attribute.handle.get()), H5Sclose);
    if (!attribute.type || !space || !std::ranges::count(kinds, H5Tget_class(attribute.type.get())))
        fail("{} holds no {}", attribute.where, what);
    const auto count = std::max<hssize_t>(H5Sget_simple_extent_npoints(space.get()), 0);
    attribute.count = static_cast<std::size_t>(count);
    if (product(attribute.count, H5Tget_size(attribute.type.get())) > bytes_)
        fail("{} is larger than the file: damaged", attribute.where);
    return attribute;
}

void Reader::read_attribute(const Attribute& attribute, hid_t as, void* to) const {
    if (attribute.count > 0 && H5Aread(attribute.handle.get(), as, to) < 0)
        fail("{} cannot be read: damaged", attribute.where);
}

std::vector<std::int64_t> Reader::attribute_numbers(const std::string& name, const std::string& of) const {
    const auto attribute = open_attribute(name, of, {H5T_INTEGER}, "whole numbers");
    std::vector<std::int64_t> values(attribute.count);
    read_attribute(attribute, H5T_NATIVE_INT64, values.data());
    return values;
}

std::vector<float> Reader::attribute_floats(const std::string& name, const std::string& of) const {
    const auto attribute = open_attribute(name, of, {H5T_FLOAT, H5T_INTEGER}, "numbers");
    std::vector<float> values(attribute.count);
    read_attribute(attribute, H5T_NATIVE_FLOAT, values.data());
    return values;
}

std::vector<std::string> Reader::attribute_texts(const std::string& name, const std::string& of) const {
    const auto attribute = open_attribute(name, of, {H5T_STRING}, "text");
    if (H5Tis_variable_str(attribute.type.get()) != 0) return variable_attribute(attribute, name, of);
    const auto size = H5Tget_size(attribute.type.get());
    std::vector<char> text(attribute.count * size);
    read_attribute(attribute, attribute.type.get(), text.data());
    return unpacked(text, attribute.count, size);
}

std::vector<std::string> Reader::variable_attribute(const Attribute& attribute, const std::string& name,
                                                    const std::string& of) const {
    const auto file = [&](std::uint64_t offset, std::uint64_t size) { return bytes_at(offset, size); };
    const auto header = header_address(file_.get(), of.c_str());
    const auto references = header ? attribute_bytes(*header, name, file) : std::nullopt;
    if (!references)
        fail("{} holds text of variable length that is not in the header; write it as numpy.bytes_('...')",
             attribute.where);
    return variable_texts(*references, attribute.count, attribute.where);
}

}  // namespace actformer::hdf5
