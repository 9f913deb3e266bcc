// The checksum of a raw text, taken while a format reads it.
#pragma once

#include <string>
#include <string_view>

#include "base/checksum/checksum.hpp"

namespace actformer::ingest {

/// Takes in what a reader has just read, which is in the processor's cache then: a large file comes through the memory once.
class TextChecksum {
  public:
    explicit TextChecksum(std::string_view text) : text_(text) {}

    /// Takes in what it has not of the text before `here`. Nothing happens where `here` lies elsewhere.
    void take_until(const char* here);

    /// Of what was taken in.
    std::string hex() const { return sum_.hex(); }

  private:
    std::string_view text_;
    std::size_t taken_ = 0;  ///< bytes
    Checksum sum_;
};

}  // namespace actformer::ingest
