#include "base/hdf5/contents.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>

#include "base/checksum/checksum.hpp"
#include "base/checksum/fletcher32.hpp"
#include "base/error.hpp"
#include "base/hdf5/reader.hpp"

namespace actformer::hdf5 {
namespace {

constexpr auto other_kind = "neither numbers nor texts of one length: not written by actformer";

std::string text_of(hid_t type, const Shape& shape, const std::string& values_checksum) {
    return fmt::format("{} ({}) {}", name_of_type(type), fmt::join(shape, ", "), values_checksum);
}

/// Every link below the root: "clip", "clip/label", ...
herr_t add_link(hid_t, const char* path, const H5L_info_t* info, void* links) {
    (*static_cast<std::map<std::string, H5L_type_t>*>(links))[path] = info->type;
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
    /// Chunks of whole rows of 4-byte values with their checksum behind: read past the library's filters, which take ten times as long.
    bool plain_chunks() {
        const Handle plan(H5Dget_create_plist(set_.get()), H5Pclose);
        if (size_ != 4 || H5Pget_layout(plan.get()) != H5D_CHUNKED || H5Pget_nfilters(plan.get()) != 1)
            return false;
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        if (H5Pget_filter2(plan.get(), 0, &flags, &values, nullptr, 0, nullptr, &config) !=
            H5Z_FILTER_FLETCHER32)
            return false;
        Shape chunk(shape_.size());
        H5Pget_chunk(plan.get(), static_cast<int>(chunk.size()), chunk.data());
        rows_a_chunk_ = chunk[0];
        return std::equal(chunk.begin() + 1, chunk.end(), shape_.begin() + 1);
    }

    template <typename Use>
    bool each_chunk(const Use& use) {
        const auto numbers = rows_a_chunk_ * row_ / size_;
        std::vector<float> chunk(numbers + 1);
        Shape at(shape_.size(), 0);
        for (; at[0] < shape_[0]; at[0] += rows_a_chunk_) {
            hsize_t stored = 0;
            std::uint32_t left_out = 0, sum = 0;
            if (H5Dget_chunk_storage_size(set_.get(), at.data(), &stored) < 0 ||
                stored != chunk.size() * size_ ||
                H5Dread_chunk(set_.get(), H5P_DEFAULT, at.data(), &left_out, chunk.data()) < 0)
                return false;
            std::memcpy(&sum, &chunk.back(), sizeof sum);
            if (left_out != 0 || sum != fletcher32(std::span(chunk).first(numbers))) return false;
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
    const auto kind = H5Tget_class(type);
    const auto bits = 8 * H5Tget_size(type);
    if (kind == H5T_STRING && H5Tis_variable_str(type) == 0) return fmt::format("text{}", bits / 8);
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) return {};
    const auto* order = H5Tget_order(type) == H5T_ORDER_BE ? "be" : "";
    if (kind == H5T_FLOAT) return fmt::format("float{}{}", bits, order);
    return fmt::format("{}int{}{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", bits, order);
}

void Contents::add_group(const std::string& path) {
    said_[path] = "group";
}

void Contents::add_array(const std::string& path, hid_t type, const Shape& shape,
                         const std::string& values_checksum) {
    said_[path] = text_of(type, shape, values_checksum);
}

// No name of a group or array ends with a slash, so that no attribute is taken for one.
void Contents::add_attribute(const std::string& path, const std::string& name, hid_t type, const Shape& shape,
                             std::string_view values) {
    said_[path + "/\n" + name] = text_of(type, shape, actformer::checksum(values));
}

std::string Contents::checksum() const {
    Checksum all;
    for (const auto& [what, said] : said_) all.add(fmt::format("{} {}\n{}\n", what.size(), what, said));
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
    std::map<std::string, H5L_type_t> links;
    if (H5Lvisit(file_.get(), H5_INDEX_NAME, H5_ITER_INC, add_link, &links) < 0)
        fail("its list of contents cannot be read: damaged");
    Contents contents;
    const auto add_attributes_of = [&](const Handle& object, const std::string& path) {
        if (const auto fault = add_attributes(object.get(), path, contents); !fault.empty())
            fail("{}", fault);
    };
    add_attributes_of(Handle(H5Gopen2(file_.get(), "/", H5P_DEFAULT), H5Gclose), "");
    for (const auto& [path, kind] : links) {
        if (kind != H5L_TYPE_HARD) fail("'{}' is a link: not written by actformer", path);
        if (is_array(path)) {
            const auto array = open(path);
            contents.add_array(path, array.type.get(), array.shape, checksum_of(array, see));
            add_attributes_of(array.set, path);
            continue;
        }
        const Handle group(H5Gopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Gclose);
        if (!group) fail("'{}' is neither group nor array: not written by actformer", path);
        contents.add_group(path);
        add_attributes_of(group, path);
    }
    return contents.checksum();
}

}  // namespace actformer::hdf5
