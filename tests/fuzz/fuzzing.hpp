// What the fuzzers share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "base/error.hpp"

namespace actformer::fuzzing {

inline void demand(bool holds) {
    if (!holds) std::abort();
}

/// What is refused is refused in one line.
inline void demand_one_line(std::string_view message) {
    demand(!message.empty() && message.find('\n') == std::string_view::npos);
}

template <typename Read>
void try_to(Read read) {
    try {
        read();
    } catch (const Error& e) {
        demand_one_line(e.what());
    }
}

/// The bytes in an allocation of just that size, and of `padding` zeros where a reader may load past its end, so that the sanitizer
/// sees any byte read beyond.
class Input {
  public:
    Input(const std::uint8_t* data, std::size_t size, std::size_t padding = 0)
        : bytes_(std::make_unique<char[]>(size + padding)), size_(size) {
        std::copy(data, data + size, bytes_.get());
    }
    std::string_view text() const { return {bytes_.get(), size_}; }

  private:
    std::unique_ptr<char[]> bytes_;
    std::size_t size_;
};

}  // namespace actformer::fuzzing
