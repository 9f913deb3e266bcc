// Arrays, texts and attributes out of an HDF5 file; errors as exceptions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {

/// A file to read. Every member throws Error, naming the file, for what is missing, of another shape, or damaged.
class Reader {
  public:
    explicit Reader(const std::filesystem::path& path);

    /// Names directly in the root group, sorted.
    std::vector<std::string> names() const;
    bool is_array(const std::string& name) const;
    bool has(const std::string& name) const;
    Shape shape(const std::string& name) const;

    /// Where in the file an array begins that lies there in one piece; none of others.
    std::optional<std::uint64_t> offset(const std::string& name) const;

    template <typename T>
    std::vector<T> read(const std::string& name) const {
        std::vector<T> values(elements(shape(name)));
        read_into(name, type_of<T>(), values.data());
        return values;
    }

    /// `count` entries along the first axis, from `first` on.
    std::vector<float> read_rows(const std::string& name, std::uint64_t first, std::uint64_t count) const;

    /// Of fixed or variable length.
    std::vector<std::string> read_strings(const std::string& name) const;

    /// Of the root group, or of the array `of`.
    bool has_attribute(const std::string& name, const std::string& of = "/") const;

    /// Whole numbers in an attribute, one or many; the same of other numbers and of texts.
    std::vector<std::int64_t> attribute_numbers(const std::string& name, const std::string& of = "/") const;
    std::vector<float> attribute_floats(const std::string& name, const std::string& of = "/") const;
    std::vector<std::string> attribute_texts(const std::string& name, const std::string& of = "/") const;

  private:
    struct Attribute;
    Attribute open_attribute(const std::string& name, const std::string& of, H5T_class_t kind,
                             const char* what) const;
    static std::size_t elements(const Shape& shape);
    Handle open(const std::string& name) const;
    void read_into(const std::string& name, hid_t type, void* to) const;
    std::vector<std::string> read_variable_strings(const Handle& set, const Handle& type,
                                                   const std::string& name) const;

    std::filesystem::path path_;
    Handle file_;
};

}  // namespace actformer::hdf5
