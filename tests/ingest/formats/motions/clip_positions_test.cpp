// Positions of one clip: what was not seen is filled in as a plain computation does it.
#include "ingest/formats/motions/clip_positions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace actformer;
using namespace actformer::ingest;

namespace {

const Topology chain{{"hips", "knee", "foot"}, {-1, 0, 1}};
constexpr std::size_t joints = 3;
const double unseen = std::nan("");

struct Array {
    Array(std::uint64_t clips, std::uint64_t frames_, std::uint64_t persons_, unsigned seed = 1)
        : frames(frames_), persons(persons_), numbers(clips * frames_ * persons_ * joints * 3) {
        std::mt19937 random(seed);
        for (auto& x : numbers) x = std::uniform_real_distribution<double>(-2, 2)(random);
        shape = {clips, frames, persons, joints, 3};
    }
    double* body(std::uint64_t t, std::uint64_t p, std::uint64_t clip = 0) {
        return &numbers[((clip * frames + t) * persons + p) * joints * 3];
    }
    void forget(std::uint64_t t, std::uint64_t p, double with = unseen) {
        std::fill(body(t, p), body(t, p) + joints * 3, with);
    }

    std::variant<ClipPositions, Rejection> read(PositionsRequest request, std::uint64_t clip = 0) {
        return read_from(reinterpret_cast<const char*>(numbers.data()), sizeof(double), request, clip);
    }
    /// From memory that holds these numbers as floating point of `size` bytes.
    std::variant<ClipPositions, Rejection> read_from(const char* from, std::size_t size,
                                                     PositionsRequest request, std::uint64_t clip = 0) const {
        NumpyArray array;
        array.size = size;
        array.shape = shape;
        array.values = {from, numbers.size() * size};
        request.topology = &chain;
        return read_positions(JointArray(array, joints, "ntpkc"), clip, request);
    }
    ClipPositions taken(const PositionsRequest& request = {}, std::uint64_t clip = 0) {
        auto out = read(request, clip);
        if (const auto* why = std::get_if<Rejection>(&out)) throw std::runtime_error(why->reason);
        return std::get<ClipPositions>(std::move(out));
    }
    std::string refused(const PositionsRequest& request = {}) {
        const auto out = read(request);
        return std::holds_alternative<Rejection>(out) ? std::get<Rejection>(out).reason : "taken";
    }

    std::uint64_t frames, persons;
    std::vector<double> numbers;
    std::vector<std::uint64_t> shape;
};

PositionsRequest of_persons(std::uint32_t persons, bool limbs = true) {
    PositionsRequest request;
    request.persons = persons;
    request.limbs = limbs;
    return request;
}

/// What `clip` says of a joint relative to its parent, or of the root to the first root.
double limb(Array& clip, std::uint64_t t, std::uint64_t p, std::size_t j, std::size_t d) {
    return clip.body(t, p)[3 * j + d] - (j == 0 ? clip.body(0, 0)[d] : clip.body(t, p)[3 * (j - 1) + d]);
}

}  // namespace

TEST(ClipPositions, BecomeLimbsOrStayPositions) {
    Array clip(1, 5, 2);
    const auto limbs = clip.taken(of_persons(2)), positions = clip.taken(of_persons(2, false));
    EXPECT_EQ(limbs.frames, 5U);
    EXPECT_FALSE(limbs.filled);
    for (std::uint64_t t = 0; t < 5; ++t)
        for (std::uint64_t p = 0; p < 2; ++p)
            for (std::size_t j = 0; j < joints; ++j)
                for (std::size_t d = 0; d < 3; ++d) {
                    const auto at = ((t * 2 + p) * joints + j) * 3 + d;
                    EXPECT_FLOAT_EQ(limbs.values[at], static_cast<float>(limb(clip, t, p, j, d)));
                    EXPECT_FLOAT_EQ(positions.values[at],
                                    static_cast<float>(clip.body(t, p)[3 * j + d] - clip.body(0, 0)[d]));
                }
    double mean = 0;
    for (std::uint64_t t = 0; t < 5; ++t)
        mean += std::hypot(limb(clip, t, 1, 2, 0), limb(clip, t, 1, 2, 1), limb(clip, t, 1, 2, 2)) / 5;
    EXPECT_NEAR(positions.bone_length[joints + 2], mean, 1e-6);
    EXPECT_EQ(positions.bone_length[0], 0);
}

TEST(ClipPositions, AreTurnedAndScaled) {
    Array clip(1, 2, 1);
    auto request = of_persons(1, false);
    request.scale = 0.01;
    request.axes = {1, 3, -2};  // z is up: y of the dataset is z, and z of it -y
    const auto out = clip.taken(request);
    const double* from = clip.body(1, 0) + 3;
    const double* origin = clip.body(0, 0);
    const float* to = &out.values[(joints + 1) * 3];
    EXPECT_NEAR(to[0], 0.01 * (from[0] - origin[0]), 1e-8);
    EXPECT_NEAR(to[1], 0.01 * (from[2] - origin[2]), 1e-8);
    EXPECT_NEAR(to[2], -0.01 * (from[1] - origin[1]), 1e-8);
}

// float32 is read where it lies; an odd place, a scale and gaps take the way of all others. The same numbers give the same bits.
TEST(ClipPositions, AreTheSameHoweverTheNumbersAreStored) {
    for (const bool gap : {false, true})
        for (const bool limbs : {true, false}) {
            Array array(2, 37, 2, 3);
            std::vector<float> floats(array.numbers.begin(), array.numbers.end());
            floats[5] = 1e-30F;  // beside a number of 1: more bits apart than a double has
            floats[8] = 1;
            array.numbers.assign(floats.begin(), floats.end());
            if (gap) {
                array.forget(20, 1);
                floats.assign(array.numbers.begin(), array.numbers.end());
            }
            auto request = of_persons(2, limbs);
            request.start = 3;
            request.end = 31;
            std::string odd(1, ' ');
            odd.append(reinterpret_cast<const char*>(floats.data()), floats.size() * sizeof(float));
            for (const std::uint64_t clip : {0, 1}) {
                const auto wanted = array.taken(request, clip);
                const auto* aligned = reinterpret_cast<const char*>(floats.data());
                for (const char* from : {aligned, static_cast<const char*>(odd.data()) + 1}) {
                    const auto read = array.read_from(from, sizeof(float), request, clip);
                    ASSERT_TRUE(std::holds_alternative<ClipPositions>(read));
                    EXPECT_EQ(std::get<ClipPositions>(read).values, wanted.values);
                    EXPECT_EQ(std::get<ClipPositions>(read).bone_length, wanted.bone_length);
                    EXPECT_EQ(std::get<ClipPositions>(read).filled, gap && clip == 0);
                }
            }
        }
}

TEST(ClipPositions, FillGapsJointByJoint) {
    Array clip(1, 6, 1), whole = clip;
    clip.body(2, 0)[3] = unseen;  // one number: all of the joint
    clip.body(3, 0)[4] = unseen;
    clip.forget(0, 0, 0.0);
    clip.body(5, 0)[5] = clip.body(5, 0)[6] = unseen;
    const auto out = clip.taken(of_persons(1, false));
    EXPECT_TRUE(out.filled);
    const auto expect = [&](std::uint64_t t, std::size_t j, std::uint64_t a, std::uint64_t b, double weight) {
        for (std::size_t d = 0; d < 3; ++d) {
            const double from = whole.body(a, 0)[3 * j + d], to = whole.body(b, 0)[3 * j + d];
            EXPECT_NEAR(out.values[(t * joints + j) * 3 + d],
                        from + weight * (to - from) - whole.body(1, 0)[d], 1e-6)
                << t << " " << j;
        }
    };
    for (std::size_t j = 0; j < joints; ++j) {
        expect(0, j, 1, 1, 0);
        expect(1, j, 1, 1, 0);
        expect(4, j, 4, 4, 0);
        expect(5, j, j == 0 ? 5 : 4, j == 0 ? 5 : 4, 0);
    }
    expect(2, 0, 2, 2, 0);
    expect(2, 1, 1, 4, 1.0 / 3);
    expect(3, 1, 1, 4, 2.0 / 3);
    expect(3, 2, 3, 3, 0);
}

TEST(ClipPositions, KeepWhoIsSeenMost) {
    Array clip(1, 4, 3);
    clip.forget(1, 0);
    clip.forget(2, 0, 0.0);
    clip.forget(3, 1);
    const auto out = clip.taken(of_persons(2));
    // person 2 in all frames, person 1 in three, person 0 in two
    EXPECT_FLOAT_EQ(out.values[3], static_cast<float>(clip.body(0, 2)[3] - clip.body(0, 2)[0]));
    EXPECT_FLOAT_EQ(out.values[joints * 3 + 3], static_cast<float>(clip.body(0, 1)[3] - clip.body(0, 1)[0]));
    for (std::uint64_t t = 0; t < 4; ++t) {
        clip.forget(t, 0);
        clip.forget(t, 1);
    }
    EXPECT_EQ(clip.refused(of_persons(2)), "1 of 2 persons seen");
    for (std::uint64_t t = 0; t < 4; ++t) clip.forget(t, 2, t % 2 ? unseen : 0.0);
    EXPECT_EQ(clip.refused(of_persons(1)), "no number in it: nobody is seen");
}

TEST(ClipPositions, LosePaddingWhereClipsShareAnArray) {
    Array clip(2, 6, 1);
    clip.forget(2, 0);
    for (std::uint64_t t = 4; t < 6; ++t) clip.forget(t, 0, 0.0);
    EXPECT_EQ(clip.taken().frames, 4U);
    EXPECT_EQ(clip.taken({}, 1).frames, 6U);
    EXPECT_TRUE(clip.taken().filled) << "frame 2";

    Array shorter(1, 6, 1);
    for (std::uint64_t t = 4; t < 6; ++t) shorter.forget(t, 0, t == 4 ? unseen : 0.0);
    EXPECT_EQ(shorter.taken().frames, 4U);
    EXPECT_FALSE(shorter.taken().filled) << "what lies behind a clip's end is no gap";
}

TEST(ClipPositions, AreCutOutOfAClip) {
    Array clip(1, 10, 1);
    PositionsRequest request;
    request.start = 3;
    request.end = 7;
    const auto out = clip.taken(request);
    EXPECT_EQ(out.frames, 4U);
    EXPECT_FLOAT_EQ(out.values[3], static_cast<float>(clip.body(3, 0)[3] - clip.body(3, 0)[0]));
    request.start = 10;
    request.end = {};
    EXPECT_EQ(clip.refused(request), "the labels cut out frames 10 on of 10");
}

TEST(ClipPositions, AreRefusedWhereTheyMakeNoSense) {
    Array far(1, 3, 1), endless = far, never = far;
    far.body(1, 0)[5] = 1e7;
    EXPECT_EQ(far.refused(), "frame 1: 'knee' is at 1e+07 m; see --scale");
    endless.body(2, 0)[0] = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(endless.refused(), "frame 2: 'hips' is at -inf m; see --scale");
    for (std::uint64_t t = 0; t < 3; ++t) never.body(t, 0)[8] = unseen;
    EXPECT_EQ(never.refused(), "'foot' is never seen");
}
