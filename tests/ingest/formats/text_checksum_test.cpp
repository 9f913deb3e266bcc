#include "ingest/formats/text_checksum.hpp"

#include <gtest/gtest.h>

#include "ingest/formats/format.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

std::string text_of(std::size_t bytes) {
    std::string text(bytes, '\0');
    for (std::size_t i = 0; i < bytes; ++i) text[i] = static_cast<char>(i * i % 251);
    return text;
}

}  // namespace

TEST(TextChecksum, IsThatOfTheWholeTextHoweverItWasReleased) {
    const auto text = text_of(100'000), other = text_of(10);
    for (const std::vector<std::size_t>& places : {std::vector<std::size_t>{100'000},
                                                   {0, 1, 300, 300, 70'001, 100'000},
                                                   {90'000, 20, 95'000, 0, 100'000}}) {
        TextChecksum sum(text);
        RawText raw;
        raw.text = text;
        raw.checksum = &sum;
        for (const auto place : places) {
            raw.release(text.data() + place);
            raw.release(other.data() + other.size());  // of no concern
        }
        EXPECT_EQ(sum.hex(), checksum(text));
    }
}

TEST(TextChecksum, IsThatOfWhatWasReleased) {
    const auto text = text_of(5'000);
    TextChecksum sum(text);
    EXPECT_EQ(sum.hex(), checksum(""));
    sum.take_until(text.data() + 4'000);
    EXPECT_EQ(sum.hex(), checksum(std::string_view(text).substr(0, 4'000)));
    TextChecksum empty({});
    empty.take_until(nullptr);
    EXPECT_EQ(empty.hex(), checksum(""));
}
