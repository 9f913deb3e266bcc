// Arrays, texts and attributes into an HDF5 file, on disk or in memory; errors as exceptions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/aside.hpp"
#include "base/hdf5/contents.hpp"
#include "base/hdf5/file_memory.hpp"
#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {

/// Bytes that an attribute may have: it lies in a header of 64 KiB, beside its name, type and shape.
inline constexpr std::size_t largest_attribute = 65'000;

/// Bytes that texts take in an attribute or array, each as many as the longest.
std::size_t packed_size(const std::vector<std::string>& values);

/// A new file; the same calls give the same bytes. On disk it ends in a line with the checksum of all bytes before, which Reader looks
/// at and other programs pass over; they drop it when they change the file.
class Writer {
  public:
    /// In memory, for image(): in its own, or in `memory` that is used again, by one file at a time.
    explicit Writer(std::size_t expected_bytes);
    Writer(FileMemory& memory, std::size_t expected_bytes);

    /// On disk, an Aside until finish(). Throws Error where nothing can be written at `path`.
    explicit Writer(const std::filesystem::path& path, Sync sync = Sync::now);
    ~Writer();
    Writer(Writer&& other) noexcept;

    /// `rows_a_chunk` rows of the first axis share a checksummed chunk; 0 stores the array in one piece.
    template <typename T>
    void write(const std::string& name, const Shape& shape, std::span<const T> values,
               hsize_t rows_a_chunk = 0) {
        write_from(name, type_of<T>(), shape, values.data(), rows_a_chunk);
    }

    void write_strings(const std::string& name, const std::vector<std::string>& values);

    /// Attributes of the root group, or of the array `of`. Throws Error where one has more than largest_attribute bytes.
    void attribute(const std::string& name, const std::string& value, const std::string& of = "/");
    void attribute(const std::string& name, std::int64_t value, const std::string& of = "/");
    void attribute(const std::string& name, const std::vector<std::int64_t>& values,
                   const std::string& of = "/");
    void attribute(const std::string& name, const std::vector<float>& values, const std::string& of = "/");
    void attribute(const std::string& name, const std::vector<std::string>& values,
                   const std::string& of = "/");

    /// A chunked, checksummed array that lies in memory in pieces, each some whole rows of the first axis.
    void write_pieces(const std::string& name, const Shape& shape,
                      const std::vector<std::span<const float>>& pieces, hsize_t rows_a_chunk);

    /// Rows from `first` on of an array of `shape`, which is made when the first of them come.
    void write_rows(const std::string& name, const Shape& shape, std::uint64_t first,
                    std::span<const float> values);

    /// The checksum of all that was written so far, as Reader::contents() finds it. Not for what write_rows wrote.
    std::string contents() const { return contents_.checksum(); }

    /// The same without the values of `array`, as Reader::metadata() finds it.
    std::string metadata(const std::string& array) const { return contents_.checksum(array); }

    /// The bytes of a file in memory, which begin at a page; until it is written to again or goes. No checksum stands behind them.
    std::string_view image();

    /// The bytes of a file in memory and the checksum behind them.
    std::string checked_image();

    /// Closes a file on disk, which appears at its path. Throws Error where not all of it could be written.
    void finish();

  private:
    void create_in(FileMemory& memory, std::size_t expected_bytes);
    void attribute_from(const std::string& name, const std::string& of, hid_t type, const Shape& shape,
                        const void* value);
    void note_array(const std::string& name, hid_t type, const Shape& shape, const std::string& checksum);
    Handle create(const std::string& name, hid_t type, const Shape& shape, hsize_t rows_a_chunk);
    void write_from(const std::string& name, hid_t type, const Shape& shape, const void* values,
                    hsize_t rows_a_chunk);
    void need(bool written, const std::string& name) const;
    void add_checksum();
    std::unique_ptr<Aside> aside_;        ///< of a file on disk
    std::unique_ptr<FileMemory> memory_;  ///< its own, of a file that is not on disk
    Contents contents_;
    Handle file_;  ///< behind what it lies in, which it needs to the end
};

}  // namespace actformer::hdf5
