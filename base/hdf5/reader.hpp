// Arrays, texts and attributes out of an HDF5 file; errors as exceptions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {

/// What a path within a file may have, a link's target too: the library takes stack for every part, and time for every two of them.
inline constexpr std::size_t most_path_parts = 32, longest_path = 4096;

/// Whether a path has more of either.
bool is_long_path(std::string_view path);

/// A file to read. Every member throws Error, naming the file, for what is missing, of another shape, or damaged. No more
/// memory is taken than the file's size accounts for, and nothing outside the file is read: external links, external storage and
/// virtual arrays are refused.
///
/// A file that ends in a checksum (see Writer) is read whole once and compared with it before HDF5 sees any of it; files without one,
/// as other programs write them, are read as they are. One without whose attribute `program` names this program is refused, but for
/// those with an attribute `dataset`: theirs stand in that.
class Reader {
  public:
    /// Throws Error that tells a file which another program writes from a damaged one.
    explicit Reader(const std::filesystem::path& path);

    /// A file in memory, which it copies; `name` is for messages.
    Reader(std::string_view image, const std::string& name);

    /// Names directly in the root group, sorted.
    std::vector<std::string> names() const;

    /// For whoever reads all of `names`: throws Error where they hold more together than such a file can, as when many are of one array.
    void expect_room_for(const std::vector<std::string>& names) const;
    bool is_array(const std::string& name) const;
    bool has(const std::string& name) const;
    Shape shape(const std::string& name) const;
    bool holds_doubles(const std::string& name) const;  ///< numbers of 8 bytes with a fraction

    /// Where in the file an array begins that lies there in one piece; none of others.
    std::optional<std::uint64_t> offset(const std::string& name) const;

    template <typename T>
    std::vector<T> read(const std::string& name) const {
        const auto array = open(name);
        auto values = room<T>(array.numbers, name);
        read_into(array, type_of<T>(), values.data());
        return values;
    }

    /// `count` entries along the first axis, from `first` on. The array stays open for the next call. Of an array in checksummed chunks
    /// every chunk must be there, and be as it was written.
    std::vector<float> read_rows(const std::string& name, std::uint64_t first, std::uint64_t count) const;

    /// Of fixed or variable length; of variable length in one piece, as h5py writes them unless told otherwise.
    std::vector<std::string> read_strings(const std::string& name) const;

    /// Of the root group, or of the array `of`.
    bool has_attribute(const std::string& name, const std::string& of = "/") const;

    /// Whole numbers in an attribute, one or many; the same of numbers with a fraction or without, and of texts of either length.
    std::vector<std::int64_t> attribute_numbers(const std::string& name, const std::string& of = "/") const;
    std::vector<float> attribute_floats(const std::string& name, const std::string& of = "/") const;
    std::vector<std::string> attribute_texts(const std::string& name, const std::string& of = "/") const;

    /// Called with an array's name and its stored bytes in order, a chunk or a megabyte at a time.
    using See = std::function<void(const std::string& name, std::string_view bytes)>;

    /// The checksum of Contents, of all that is in the file. Every byte of every array is read, and shown to `see`. Throws Error
    /// where a chunk's own checksum is wrong.
    std::string contents(const See& see = {}) const;

    /// The same without the values of `array`, which are not read: only their type and shape count.
    std::string metadata(const std::string& array) const;

  private:
    struct Attribute;
    struct Array {
        std::string name;
        Handle set, type;
        Shape shape;
        std::size_t numbers = 0;  ///< or texts
        Shape checked_chunk{};    ///< of an array in chunks with checksums; else empty
        mutable std::vector<float>
            chunk{};  ///< the one read last of them, for the next rows; where read_rows() reads them itself
        mutable std::uint64_t chunk_at = 0;  ///< its first row
    };

    /// Memory for `count` values of the array `name`.
    template <typename T>
    std::vector<T> room(std::uint64_t count, const std::string& name) const try {
        return std::vector<T>(count);
    } catch (const std::exception&) {
        fail("'{}' takes {} MiB, and there is not so much memory; end other programs, or split the file",
             name, ((count >> 10) * sizeof(T)) >> 10);
    }
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
        throw Error("{}: {}", path_, fmt::format(text, std::forward<Args>(args)...));
    }

    void refuse_own_without_checksum() const;
    Array open(const std::string& name) const;
    void refuse_links_away(const std::string& name) const;
    void refuse_links_away(const std::string& name, int depth, int& followed) const;
    void check_layout(Array& array) const;
    static bool has_checked_rows(const Array& array);
    void read_checked_rows(const Array& array, std::uint64_t first, std::span<float> values) const;
    Attribute open_attribute(const std::string& name, const std::string& of,
                             std::initializer_list<H5T_class_t> kinds, const char* what) const;
    void read_attribute(const Attribute& attribute, hid_t as, void* to) const;
    void read_into(const Array& array, hid_t type, void* to) const;
    std::string bytes_at(std::uint64_t offset, std::uint64_t size) const;  ///< fewer where the file ends
    std::string checksum_of(const Array& array, const See& see) const;
    std::string contents_but(const std::string& without, const See& see) const;
    std::vector<std::string> read_variable_strings(const Array& array) const;
    std::vector<std::string> variable_attribute(const Attribute& attribute, const std::string& name,
                                                const std::string& of) const;
    std::vector<std::string> variable_texts(std::string_view references, std::size_t count,
                                            const std::string& where) const;

    std::string path_;
    std::string image_;  ///< of a file in memory
    Handle file_;
    std::uint64_t bytes_ = 0;  ///< of the file
    mutable std::map<std::string, Array> open_;
};

}  // namespace actformer::hdf5
