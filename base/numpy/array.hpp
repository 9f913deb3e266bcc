// A NumPy array where it lies: in a file's text, of any type and order.
#pragma once

#include <cstdint>
#include <optional>
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

    /// Takes a type as NumPy spells it, as in "<f4"; false where it is none.
    bool take_type(std::string_view spelled);

    bool numbers() const { return kind == Kind::real || kind == Kind::whole || kind == Kind::natural; }
    std::uint64_t elements() const;

    /// What all elements take; none where 64 bits cannot count them.
    std::optional<std::uint64_t> bytes() const;

    /// "(60, 2, 25, 3)"
    std::string shape_text() const;

    /// Elements that lie `stride` elements apart, `first` being the index of the first in memory. They must lie in the array.
    void copy(std::uint64_t first, std::uint64_t stride, std::uint64_t count, double* to) const;

    /// All numbers, or all texts (cut at their first zero), in memory order.
    std::vector<double> all_numbers() const;
    std::vector<std::string> all_texts() const;
};

}  // namespace actformer
