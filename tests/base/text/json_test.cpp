#include "base/text/json.hpp"

#include <gtest/gtest.h>

using namespace actformer;
using Json = nlohmann::ordered_json;

TEST(Json, WholeNumbersAreThoseThatATypeHolds) {
    EXPECT_EQ(whole_number<int>(Json::parse("-2147483648")), -2147483647 - 1);
    EXPECT_EQ(whole_number<std::uint32_t>(Json::parse("4294967295")), 4294967295U);
    EXPECT_EQ(whole_number<std::uint64_t>(Json::parse("18446744073709551615")), ~std::uint64_t{0});
    for (const auto* other : {"4294967296", "-1", "1.0", "5e27", "\"1\"", "true", "null", "[1]"}) {
        EXPECT_THROW(whole_number<std::uint32_t>(Json::parse(other)), Json::exception) << other;
    }
    EXPECT_THROW(whole_number<int>(Json::parse("2147483648")), Json::exception);
    EXPECT_THROW(whole_number<std::int64_t>(Json::parse("9223372036854775808")), Json::exception);
}

TEST(Json, CountsAreWholeNumbersHoweverDeep) {
    EXPECT_NO_THROW(
        expect_counts(Json::parse(R"({"a": [1, {"b": [18446744073709551615, "x", null]}], "c": "1.5"})")));
    for (const auto* other : {R"({"a": [1, {"b": [1.5]}]})", "[[-1]]", "5e27"})
        EXPECT_THROW(expect_counts(Json::parse(other)), Json::exception) << other;
}
