// NumPy's .npy files (format versions 1 to 3): a header in Python's syntax, then the numbers of one array. Nothing in them is run.
#pragma once

#include <string_view>

#include "base/numpy/array.hpp"

namespace actformer {

/// What the header in the first of a file's bytes says; the array comes without values. Throws Error as read_npy does.
NumpyArray read_npy_header(std::string_view bytes);

/// Throws Error, saying what is wrong but not in which file, where `bytes` are no such file, cut short or longer than the array,
/// or hold Python objects, which only running them could read. Arrays of other kinds than numbers and texts come without values.
NumpyArray read_npy(std::string_view bytes);

}  // namespace actformer
