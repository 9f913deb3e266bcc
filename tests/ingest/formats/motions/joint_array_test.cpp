#include "ingest/formats/motions/joint_array.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "base/error.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

/// Numbers 0 1 2 ... in memory.
struct Counting {
    explicit Counting(std::vector<std::uint64_t> shape, bool fortran = false) {
        array.size = sizeof(double);
        array.shape = std::move(shape);
        array.fortran_order = fortran;
        numbers.resize(array.elements());
        std::iota(numbers.begin(), numbers.end(), 0.0);
        array.values = {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
    }
    std::vector<double> numbers;
    NumpyArray array;
};

/// Where NumPy would find element `index`.
double element(const Counting& of, const std::vector<std::uint64_t>& index) {
    std::uint64_t at = 0;
    const auto rank = index.size();
    for (std::size_t i = 0; i < rank; ++i) {
        const auto axis = of.array.fortran_order ? rank - 1 - i : i;
        at = at * of.array.shape[axis] + index[axis];
    }
    return static_cast<double>(at);
}

std::string fault(std::vector<std::uint64_t> shape, const std::string& axes = {}) {
    try {
        const Counting of(std::move(shape));
        JointArray(of.array, 4, axes);
        return "taken";
    } catch (const Error& e) {
        return e.what();
    }
}

}  // namespace

TEST(JointArray, FindsEveryNumberWhateverTheAxes) {
    constexpr std::uint64_t n = 2, t = 5, p = 3, k = 4;
    for (const std::string axes : {"ntpkc", "nctkp", "kctpn", "tpkc", "ntkc", "tkc", "cktn", "kct"})
        for (const bool fortran : {false, true}) {
            std::vector<std::uint64_t> shape;
            for (const char axis : axes)
                shape.push_back(axis == 'n' ? n : axis == 't' ? t : axis == 'p' ? p : axis == 'k' ? k : 3);
            const Counting of(shape, fortran);
            const JointArray array(of.array, k, axes);
            ASSERT_EQ(array.clips(), axes.find('n') == std::string::npos ? 1 : n);
            ASSERT_EQ(array.persons(), axes.find('p') == std::string::npos ? 1 : p);
            ASSERT_EQ(array.frames(), t);
            EXPECT_FALSE(array.guessed());
            std::vector<double> pose(3 * k);
            for (std::uint64_t clip = 0; clip < array.clips(); ++clip)
                for (std::uint64_t frame = 0; frame < t; ++frame)
                    for (std::uint64_t person = 0; person < array.persons(); ++person) {
                        array.pose(clip, frame, person, pose.data());
                        for (std::uint64_t joint = 0; joint < k; ++joint)
                            for (std::uint64_t c = 0; c < 3; ++c) {
                                std::vector<std::uint64_t> index;
                                for (const char axis : axes)
                                    index.push_back(axis == 'n'   ? clip
                                                    : axis == 't' ? frame
                                                    : axis == 'p' ? person
                                                    : axis == 'k' ? joint
                                                                  : c);
                                ASSERT_EQ(pose[3 * joint + c], element(of, index)) << axes << fortran;
                            }
                    }
        }
}

TEST(JointArray, TellsUsualShapesApart) {
    const auto what = [](std::vector<std::uint64_t> shape) {
        const Counting of(std::move(shape));
        const JointArray array(of.array, 4, "");
        return fmt::format("{} {} {}{}", array.clips(), array.frames(), array.persons(),
                           array.guessed() ? "?" : "");
    };
    EXPECT_EQ(what({7, 4, 3}), "1 7 1");
    EXPECT_EQ(what({7, 12}), "1 7 1");
    EXPECT_EQ(what({8, 7, 2, 4, 3}), "8 7 2");
    EXPECT_EQ(what({60, 2, 4, 3}), "1 60 2?");
    EXPECT_EQ(what({8, 60, 4, 3}), "8 60 1?");
    EXPECT_EQ(what({2, 6, 4, 3}), "2 6 1?");
    // joints of a frame that share an axis are read as those that do not
    const Counting joined({2, 12});
    std::vector<double> pose(12), wanted(12);
    JointArray(joined.array, 4, "").pose(0, 1, 0, pose.data());
    std::iota(wanted.begin(), wanted.end(), 12.0);
    EXPECT_EQ(pose, wanted);
}

TEST(JointArray, RefusesOtherShapes) {
    for (const auto& shape : std::vector<std::vector<std::uint64_t>>{
             {}, {12}, {7, 5, 3}, {7, 4, 2}, {7, 13}, {7, 3, 4}, {1, 2, 7, 2, 4, 3}, {0, 4, 3}, {7, 0, 4, 3}})
        EXPECT_NE(fault(shape).find("no array of 4 joints: (T, 4, 3), (T, P, 4, 3)"), std::string::npos)
            << fault(shape);
    EXPECT_NE(fault({7, 4, 3}, "ntkc").find("the axes are to be ntkc"), std::string::npos);
    EXPECT_NE(fault({7, 3, 4}, "tkc").find("the axes are to be tkc"), std::string::npos);
    EXPECT_EQ(fault({7, 3, 4}, "tck"), "taken");
    for (const char* axes : {"tk c", "tkk", "kc", "ntpkcx", "t"})
        EXPECT_THROW(check_axes(axes), Error) << axes;
    for (const char* axes : {"", "tkc", "tk", "nctkp"}) EXPECT_NO_THROW(check_axes(axes)) << axes;
    NumpyArray text;
    text.kind = NumpyArray::Kind::text;
    text.shape = {7, 4, 3};
    EXPECT_THROW(JointArray(text, 4, ""), Error);
}
