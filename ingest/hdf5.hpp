// A thin face on the HDF5 library: handles that close themselves, arrays in and out, errors as exceptions.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/hdf5_memory.hpp"

namespace actformer::ingest::hdf5 {

/// An HDF5 identifier, closed by the function that fits its kind.
class Handle {
  public:
    Handle() = default;
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Handle();
    Handle(Handle&& other) noexcept;
    Handle& operator=(Handle&& other) noexcept;
    hid_t get() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

  private:
    hid_t id_ = -1;
    herr_t (*close_)(hid_t) = nullptr;
};

template <typename T>
hid_t type_of();
template <>
inline hid_t type_of<float>() {
    return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t type_of<std::uint32_t>() {
    return H5T_NATIVE_UINT32;
}
template <>
inline hid_t type_of<std::uint64_t>() {
    return H5T_NATIVE_UINT64;
}

template <>
inline hid_t type_of<std::int64_t>() {
    return H5T_NATIVE_INT64;
}
template <>
inline hid_t type_of<double>() {
    return H5T_NATIVE_DOUBLE;
}

using Shape = std::vector<hsize_t>;

/// A file to read. Every member throws Error, naming the file, for what is missing, of another shape, or damaged.
class Reader {
  public:
    explicit Reader(const std::filesystem::path& path);

    /// Names directly in the root group, sorted.
    std::vector<std::string> names() const;
    bool is_array(const std::string& name) const;
    bool has(const std::string& name) const;
    Shape shape(const std::string& name) const;

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

    bool has_attribute(const std::string& name) const;

    /// Whole numbers in an attribute of the root group, one or many; the same of other numbers and of texts.
    std::vector<std::int64_t> attribute_numbers(const std::string& name) const;
    std::vector<float> attribute_floats(const std::string& name) const;
    std::vector<std::string> attribute_texts(const std::string& name) const;

  private:
    struct Attribute;
    Attribute open_attribute(const std::string& name, H5T_class_t kind, const char* what) const;
    static std::size_t elements(const Shape& shape);
    Handle open(const std::string& name) const;
    void read_into(const std::string& name, hid_t type, void* to) const;
    std::vector<std::string> read_variable_strings(const Handle& set, const Handle& type,
                                                   const std::string& name) const;

    std::filesystem::path path_;
    Handle file_;
};

/// A new file; the same calls give the same bytes.
class Writer {
  public:
    explicit Writer(std::size_t expected_bytes);         ///< in memory, for image()
    explicit Writer(const std::filesystem::path& path);  ///< on disk, for finish()

    /// `rows_a_chunk` rows of the first axis share a checksummed chunk; 0 stores the array in one piece.
    template <typename T>
    void write(const std::string& name, const Shape& shape, std::span<const T> values,
               hsize_t rows_a_chunk = 0) {
        write_from(name, type_of<T>(), shape, values.data(), rows_a_chunk);
    }

    void write_strings(const std::string& name, const std::vector<std::string>& values);
    void attribute(const std::string& name, const std::string& value);
    void attribute(const std::string& name, std::int64_t value);
    void attribute(const std::string& name, const std::vector<std::int64_t>& values);
    void attribute(const std::string& name, const std::vector<float>& values);
    void attribute(const std::string& name, const std::vector<std::string>& values);

    /// A chunked, checksummed array that lies in memory in pieces, each some whole rows of the first axis.
    void write_pieces(const std::string& name, const Shape& shape,
                      const std::vector<std::span<const float>>& pieces, hsize_t rows_a_chunk);

    /// Rows from `first` on of an array of `shape`, which is made when the first of them come.
    void write_rows(const std::string& name, const Shape& shape, std::uint64_t first,
                    std::span<const float> values);

    /// Calls `use` with the bytes of a file in memory, which begin at a page.
    void image(const std::function<void(std::string_view)>& use);

    /// Closes a file on disk. False where not all of it could be written.
    bool finish();

  private:
    void attribute_from(const std::string& name, hid_t type, const Handle& space, const void* value);
    Handle create(const std::string& name, hid_t type, const Shape& shape, hsize_t rows_a_chunk);
    void write_from(const std::string& name, hid_t type, const Shape& shape, const void* values,
                    hsize_t rows_a_chunk);
    std::unique_ptr<FileMemory> memory_;  ///< of a file that is not on disk
    Handle file_;                         ///< behind the memory, which it needs to the end
};

}  // namespace actformer::ingest::hdf5
