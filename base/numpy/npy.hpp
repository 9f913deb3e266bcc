// NumPy's .npy files (format versions 1 to 3): a header in Python's syntax, then the numbers of one array. Nothing in them is run.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace actformer {

/// An array as it lies in memory.
struct NumpyArray {
    enum class Kind {
        real,
        whole,
        natural,
        text,
        other
    };  ///< float, int, uint or bool, bytes or Unicode, anything else
    Kind kind = Kind::real;
    std::size_t size = 4;  ///< bytes an element
    bool big_endian = false;
    bool wide = false;           ///< text: four bytes a character, and not one
    bool fortran_order = false;  ///< the first axis varies fastest, and not the last
    std::string type;            ///< as the file spells it, as in "<f4"
    std::vector<std::uint64_t> shape;
    std::string_view values;  ///< in memory of the file

    bool numbers() const { return kind == Kind::real || kind == Kind::whole || kind == Kind::natural; }
    std::uint64_t elements() const;

    /// "(60, 2, 25, 3)"
    std::string shape_text() const;

    /// Elements that lie `stride` elements apart, `first` being the index of the first in memory. They must lie in the array.
    void copy(std::uint64_t first, std::uint64_t stride, std::uint64_t count, double* to) const;

    /// All numbers, or all texts (cut at their first zero), in memory order.
    std::vector<double> all_numbers() const;
    std::vector<std::string> all_texts() const;
};

/// What the header in the first of a file's bytes says; the array comes without values. Throws Error as read_npy does.
NumpyArray read_npy_header(std::string_view bytes);

/// Throws Error, saying what is wrong but not in which file, where `bytes` are no such file, cut short or longer than the array,
/// or hold Python objects, which only running them could read. Arrays of other kinds than numbers and texts come without values.
NumpyArray read_npy(std::string_view bytes);

}  // namespace actformer
