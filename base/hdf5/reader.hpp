// Arrays, texts and attributes out of an HDF5 file; errors as exceptions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {

/// A file to read. Every member throws Error, naming the file, for what is missing, of another shape, or damaged. No more
/// memory is taken than the file's size accounts for, and nothing outside the file is read: external links, external storage and
/// virtual arrays are refused.
class Reader {
  public:
    /// Throws Error that tells a file which another program writes from a damaged one.
    explicit Reader(const std::filesystem::path& path);

    /// A file in memory, which it copies; `name` is for messages.
    Reader(std::string_view image, const std::string& name);

    /// Names directly in the root group, sorted.
    std::vector<std::string> names() const;
    bool is_array(const std::string& name) const;
    bool has(const std::string& name) const;
    Shape shape(const std::string& name) const;
    bool holds_doubles(const std::string& name) const;  ///< numbers of 8 bytes with a fraction

    /// Where in the file an array begins that lies there in one piece; none of others.
    std::optional<std::uint64_t> offset(const std::string& name) const;

    template <typename T>
    std::vector<T> read(const std::string& name) const {
        const auto array = open(name);
        std::vector<T> values(array.numbers);
        read_into(array, type_of<T>(), values.data());
        return values;
    }

    /// `count` entries along the first axis, from `first` on. The array stays open for the next call.
    std::vector<float> read_rows(const std::string& name, std::uint64_t first, std::uint64_t count) const;

    /// Of fixed or variable length; of variable length in one piece, as h5py writes them unless told otherwise.
    std::vector<std::string> read_strings(const std::string& name) const;

    /// Of the root group, or of the array `of`.
    bool has_attribute(const std::string& name, const std::string& of = "/") const;

    /// Whole numbers in an attribute, one or many; the same of other numbers and of texts.
    std::vector<std::int64_t> attribute_numbers(const std::string& name, const std::string& of = "/") const;
    std::vector<float> attribute_floats(const std::string& name, const std::string& of = "/") const;
    std::vector<std::string> attribute_texts(const std::string& name, const std::string& of = "/") const;

    /// Called with an array's name and its stored bytes in order, a chunk or a megabyte at a time.
    using See = std::function<void(const std::string& name, std::string_view bytes)>;

    /// The checksum of Contents, of all that is in the file. Every byte of every array is read, and shown to `see`. Throws Error
    /// where a chunk's own checksum is wrong.
    std::string contents(const See& see = {}) const;

  private:
    struct Attribute;
    struct Array {
        std::string name;
        Handle set, type;
        Shape shape;
        std::size_t numbers = 0;  ///< or texts
    };
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
        throw Error("{}: {}", path_, fmt::format(text, std::forward<Args>(args)...));
    }

    Array open(const std::string& name) const;
    void refuse_external_links(const std::string& name) const;
    void check_layout(Array& array) const;
    Attribute open_attribute(const std::string& name, const std::string& of, H5T_class_t kind,
                             const char* what) const;
    void read_attribute(const Attribute& attribute, hid_t as, void* to) const;
    void read_into(const Array& array, hid_t type, void* to) const;
    std::string bytes_at(std::uint64_t offset, std::uint64_t size) const;  ///< fewer where the file ends
    std::string checksum_of(const Array& array, const See& see) const;
    std::vector<std::string> read_variable_strings(const Array& array) const;

    std::string path_;
    std::string image_;  ///< of a file in memory
    Handle file_;
    std::uint64_t bytes_ = 0;  ///< of the file
    mutable std::map<std::string, Array> open_;
};

}  // namespace actformer::hdf5
