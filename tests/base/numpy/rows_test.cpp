// Rows of arrays in both orders.
#include "base/numpy/rows.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

using namespace actformer;

namespace {

using Numbers = std::vector<double>;

NumpyArray array(const Numbers& numbers, std::vector<std::uint64_t> shape, bool fortran) {
    NumpyArray out;
    out.take_type("<f8");
    out.shape = std::move(shape);
    out.fortran_order = fortran;
    out.values = {reinterpret_cast<const char*>(numbers.data()), 8 * numbers.size()};
    return out;
}

Numbers row(const NumpyArray& array, const std::vector<std::uint64_t>& inner, std::uint64_t i) {
    const NumpyRows rows(array, "x", inner);
    Numbers out(rows.size());
    rows.read(i, out.data());
    return out;
}

}  // namespace

// Element (i, j, k) is 100 i + 10 j + k.
TEST(NumpyRows, AreTheSameInBothOrders) {
    Numbers c, f;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 2; ++k) c.push_back(100 * i + 10 * j + k);
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 2; ++i) f.push_back(100 * i + 10 * j + k);
    const Numbers wanted{100, 101, 110, 111, 120, 121};
    EXPECT_EQ(row(array(c, {2, 3, 2}, false), {3, 2}, 1), wanted);
    EXPECT_EQ(row(array(f, {2, 3, 2}, true), {3, 2}, 1), wanted);
    EXPECT_EQ(row(array({0, 10, 1, 11, 2, 12}, {2, 3}, true), {3}, 1), (Numbers{10, 11, 12}));
    EXPECT_EQ(NumpyRows(array(c, {2, 3, 2}, false), "x", {3, 2}).count(), 2U);
}

TEST(NumpyRows, OfAnotherShapeAreRefused) {
    const Numbers numbers(12);
    for (const auto& inner : {std::vector<std::uint64_t>{6, 2}, {3}, {2, 3}}) try {
            row(array(numbers, {2, 3, 2}, false), inner, 0);
            ADD_FAILURE();
        } catch (const Error& e) {
            EXPECT_TRUE(std::string_view(e.what()).starts_with("'x' is an array of <f8 (2, 3, 2)"))
                << e.what();
        }
}
