// What the program throws: one line that a user can act on.
#pragma once

#include <fmt/format.h>

#include <stdexcept>

#include "base/text/printable.hpp"

namespace actformer {

/// One clear line naming the file or device, the place in it, and the remedy. What is not printable in it (names of files may hold
/// anything, line ends and a terminal's commands too) is escaped.
class Error : public std::runtime_error {
  public:
    template <typename... Args>
    explicit Error(fmt::format_string<Args...> text, Args&&... args)
        : std::runtime_error(printable(fmt::format(text, std::forward<Args>(args)...))) {}
};

/// A device has not enough memory: a smaller batch may fit.
class OutOfMemory : public Error {
  public:
    using Error::Error;
};

}  // namespace actformer
