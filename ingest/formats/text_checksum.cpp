#include "ingest/formats/text_checksum.hpp"

#include <functional>

namespace actformer::ingest {

void TextChecksum::take_until(const char* here) {
    const char* const end = text_.data() + text_.size();
    if (std::less<>()(here, text_.data() + taken_) || std::less<>()(end, here)) return;
    const auto read = static_cast<std::size_t>(here - text_.data());
    sum_.add(text_.substr(taken_, read - taken_));
    taken_ = read;
}

}  // namespace actformer::ingest
