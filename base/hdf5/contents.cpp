#include "base/hdf5/contents.hpp"

#include <algorithm>
#include <numeric>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/hdf5/checked_chunk.hpp"
#include "base/hdf5/reader.hpp"
#include "base/text/printable.hpp"

namespace actformer::hdf5 {
namespace {

constexpr auto other_kind = "neither numbers nor texts of one length: not written by actformer";

std::string text_of(hid_t type, const Shape& shape) {
    return fmt::format("{} ({}) ", name_of_type(type), fmt::join(shape, ", "));
}

/// Every link below the root: "clip", "clip/label", ...
struct Links {
    std::map<std::string, H5L_type_t> kinds;
    std::string too_long;  ///< the path that ended the visit
};

/// The library calls this before it descends, and goes no further where it is not 0.
herr_t add_link(hid_t, const char* path, const H5L_info_t* info, void* to) {
    auto& links = *static_cast<Links*>(to);
    if (is_long_path(path)) {
        links.too_long = path;
        return 1;
    }
    links.kinds[path] = info->type;
    return 0;
}

herr_t add_name(hid_t, const char* name, const H5A_info_t*, void* names) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return 0;
}

Shape shape_of(hid_t space) {
    const int rank = H5Sget_simple_extent_ndims(space);
    Shape shape(static_cast<std::size_t>(std::max(rank, 0)));
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    return shape;
}

std::size_t bytes_of(hid_t type, hid_t space) {
    return static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0)) *
           H5Tget_size(type);
}

/// What is wrong with an attribute; empty where nothing is.
std::string add_attributes(hid_t object, const std::string& path, Contents& contents) {
    std::vector<std::string> names;
    if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names) < 0)
        return fmt::format("the attributes of '{}' cannot be read: damaged", path);
    for (const auto& name : names) {
        const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
        const Handle type(attribute ? H5Aget_type(attribute.get()) : -1, H5Tclose);
        const Handle space(attribute ? H5Aget_space(attribute.get()) : -1, H5Sclose);
        if (type && name_of_type(type.get()).empty())
            return fmt::format("attribute '{}' is {}", name, other_kind);
        if (!type || !space || H5Aget_storage_size(attribute.get()) < bytes_of(type.get(), space.get()))
            return fmt::format("attribute '{}' cannot be read: damaged", name);
        std::string values(bytes_of(type.get(), space.get()), '\0');
        if (!values.empty() && H5Aread(attribute.get(), type.get(), values.data()) < 0)
            return fmt::format("attribute '{}' cannot be read: damaged", name);
        contents.add_attribute(path, name, type.get(), shape_of(space.get()), values);
    }
    return {};
}

/// An array's bytes, in order, a piece at a time.
class Pieces {
  public:
    Pieces(const Handle& set, const Handle& type, const Shape& shape)
        : set_(set), type_(type), shape_(shape), size_(H5Tget_size(type.get())) {
        row_ =
            std::accumulate(shape.begin() + (shape.empty() ? 0 : 1), shape.end(), size_, std::multiplies<>());
    }

    /// Calls `use` with each piece. False where one cannot be read or is not what it was.
    template <typename Use>
    bool each(const Use& use) {
        if (std::find(shape_.begin(), shape_.end(), 0U) != shape_.end()) return true;
        return plain_chunks() ? each_chunk(use) : each_part(use);
    }

  private:
    /// Chunks of whole rows of 4-byte values with their checksum behind.
    bool plain_chunks() {
        const Handle plan(H5Dget_create_plist(set_.get()), H5Pclose);
        const auto chunk = checked_chunk_of(plan.get(), shape_.size());
        if (size_ != 4 || chunk.empty()) return false;
        rows_a_chunk_ = chunk[0];
        return std::equal(chunk.begin() + 1, chunk.end(), shape_.begin() + 1);
    }

    template <typename Use>
    bool each_chunk(const Use& use) {
        std::vector<float> chunk(rows_a_chunk_ * row_ / size_ + 1);
        Shape at(shape_.size(), 0);
        for (; at[0] < shape_[0]; at[0] += rows_a_chunk_) {
            if (!read_checked_chunk(set_.get(), at, chunk)) return false;
            use({reinterpret_cast<const char*>(chunk.data()),
                 std::min(rows_a_chunk_, shape_[0] - at[0]) * row_});
        }
        return true;
    }

    template <typename Use>
    bool each_part(const Use& use) {
        if (shape_.empty()) {
            std::string value(size_, '\0');
            if (H5Dread(set_.get(), type_.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()) < 0)
                return false;
            use(value);
            return true;
        }
        const auto rows = std::clamp<hsize_t>((std::size_t{1} << 20) / row_, 1, shape_[0]);
        std::string part(rows * row_, '\0');
        Shape start(shape_.size(), 0), extent = shape_;
        for (; start[0] < shape_[0]; start[0] += rows) {
            extent[0] = std::min(rows, shape_[0] - start[0]);
            const Handle space(H5Dget_space(set_.get()), H5Sclose);
            const Handle memory(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
                                H5Sclose);
            H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
            if (H5Dread(set_.get(), type_.get(), memory.get(), space.get(), H5P_DEFAULT, part.data()) < 0)
                return false;
            use(std::string_view(part).substr(0, extent[0] * row_));
        }
        return true;
    }

    const Handle &set_, &type_;
    const Shape& shape_;
    std::size_t size_, row_;
    hsize_t rows_a_chunk_ = 0;
};

}  // namespace

std::string name_of_type(hid_t type) {
    if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0)
        return fmt::format("text{}", H5Tget_size(type));
    static const std::vector<std::pair<const char*, hid_t>> numbers{
        {"float32", H5T_IEEE_F32LE}, {"uint32", H5T_STD_U32LE},     {"uint64", H5T_STD_U64LE},
        {"int64", H5T_STD_I64LE},    {"float64", H5T_IEEE_F64LE},   {"int32", H5T_STD_I32LE},
        {"int8", H5T_STD_I8LE},      {"uint8", H5T_STD_U8LE},       {"int16", H5T_STD_I16LE},
        {"uint16", H5T_STD_U16LE},   {"float32be", H5T_IEEE_F32BE}, {"float64be", H5T_IEEE_F64BE},
        {"int16be", H5T_STD_I16BE},  {"uint16be", H5T_STD_U16BE},   {"int32be", H5T_STD_I32BE},
        {"uint32be", H5T_STD_U32BE}, {"int64be", H5T_STD_I64BE},    {"uint64be", H5T_STD_U64BE}};
    for (const auto& [name, number] : numbers)
        if (H5Tequal(type, number) > 0) return name;
    return {};
}

void Contents::add_group(const std::string& path) {
    said_[path] = {"group", {}};
}

void Contents::add_array(const std::string& path, hid_t type, const Shape& shape,
                         const std::string& values_checksum) {
    said_[path] = {text_of(type, shape), values_checksum};
}

// No name of a group or array ends with a slash, so that no attribute is taken for one.
void Contents::add_attribute(const std::string& path, const std::string& name, hid_t type, const Shape& shape,
                             std::string_view values) {
    said_[path + "/\n" + name] = {text_of(type, shape), actformer::checksum(values)};
}

std::string Contents::checksum(const std::string& without) const {
    Checksum all;
    for (const auto& [path, said] : said_)
        all.add(fmt::format("{} {}\n{}{}\n", path.size(), path, said.what,
                            path == without && !without.empty() ? std::string() : said.values));
    return all.hex();
}

std::string Reader::checksum_of(const Array& array, const See& see) const {
    if (name_of_type(array.type.get()).empty()) fail("'{}' is {}", array.name, other_kind);
    Checksum sum;
    const auto use = [&](std::string_view piece) {
        sum.add(piece);
        if (see) see(array.name, piece);
    };
    if (!Pieces(array.set, array.type, array.shape).each(use))
        fail("'{}' cannot be read, or is not what its checksum says: damaged", array.name);
    return sum.hex();
}

std::string Reader::contents(const See& see) const {
    return contents_but({}, see);
}

std::string Reader::metadata(const std::string& array) const {
    return contents_but(array, {});
}

std::string Reader::contents_but(const std::string& without, const See& see) const {
    Links links;
    if (H5Lvisit(file_.get(), H5_INDEX_NAME, H5_ITER_INC, add_link, &links) < 0)
        fail("its list of contents cannot be read: damaged");
    if (!links.too_long.empty())
        fail("{} is a path of more than {} parts or {} bytes: not written by actformer",
             in_quotes(links.too_long), most_path_parts, longest_path);
    Contents contents;
    const auto add_attributes_of = [&](const Handle& object, const std::string& path) {
        if (const auto fault = add_attributes(object.get(), path, contents); !fault.empty())
            fail("{}", fault);
    };
    add_attributes_of(Handle(H5Gopen2(file_.get(), "/", H5P_DEFAULT), H5Gclose), "");
    for (const auto& [path, kind] : links.kinds) {
        if (kind != H5L_TYPE_HARD) fail("'{}' is a link: not written by actformer", path);
        if (is_array(path)) {
            const auto array = open(path);
            contents.add_array(path, array.type.get(), array.shape,
                               path == without ? std::string() : checksum_of(array, see));
            add_attributes_of(array.set, path);
            continue;
        }
        const Handle group(H5Gopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Gclose);
        if (!group) fail("'{}' is neither group nor array: not written by actformer", path);
        contents.add_group(path);
        add_attributes_of(group, path);
    }
    return contents.checksum(without);
}

}  // namespace actformer::hdf5
