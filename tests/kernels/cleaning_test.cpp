// The cleaning kernels against a plain computation in double.
#include "kernels/cleaning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/larger.hpp"

using namespace actformer;
using kernels::ClipBatch;

namespace {

/// Ragged clips with gaps inside, before and after, and odd time steps.
struct Sample {
    ClipBatch batch;
    std::vector<float> limbs;

    Sample(std::uint32_t persons, std::uint32_t joints, const std::vector<std::uint32_t>& frames,
           unsigned seed, float step = 1) {
        std::mt19937 random(seed);
        std::normal_distribution<float> normal;
        batch.persons = persons;
        batch.joints = joints;
        batch.frames = frames;
        batch.first = {0};
        for (const auto n : frames) {
            batch.step.push_back(step);
            for (std::uint32_t p = 0; p < persons; ++p) {
                std::vector<std::uint32_t> seen;
                for (std::uint32_t t = 0; t < n; ++t)
                    if (random() % 3 != 0) seen.push_back(t);
                if (seen.empty()) seen.push_back(random() % n);
                for (const auto t : seen) {
                    batch.times.push_back(static_cast<float>(t));
                    for (std::uint32_t i = 0; i < joints * 3; ++i) limbs.push_back(normal(random));
                }
                batch.first.push_back(static_cast<std::uint32_t>(batch.times.size()));
            }
        }
    }
};

using Rows = std::vector<std::vector<double>>;  // [frame of all clips * P + person][K * 3]

Rows plain_fill(const Sample& s) {
    Rows rows;
    const std::size_t numbers = s.batch.joints * 3;
    for (std::size_t clip = 0; clip < s.batch.clips(); ++clip)
        for (std::uint32_t t = 0; t < s.batch.frames[clip]; ++t)
            for (std::uint32_t p = 0; p < s.batch.persons; ++p) {
                const double time = double{s.batch.step[clip]} * t;
                const auto sequence = clip * s.batch.persons + p;
                std::size_t before = s.batch.first[sequence], after = s.batch.first[sequence + 1] - 1;
                for (auto i = s.batch.first[sequence]; i < s.batch.first[sequence + 1]; ++i)
                    if (s.batch.times[i] <= time) before = i;
                for (auto i = s.batch.first[sequence + 1]; i-- > s.batch.first[sequence];)
                    if (s.batch.times[i] >= time) after = i;
                if (s.batch.times[before] > time) after = before;
                if (s.batch.times[after] < time) before = after;
                const double span = double{s.batch.times[after]} - s.batch.times[before];
                const double w = span > 0 ? (time - s.batch.times[before]) / span : 0;
                std::vector<double> row(numbers);
                for (std::size_t i = 0; i < numbers; ++i)
                    row[i] = (1 - w) * s.limbs[before * numbers + i] + w * s.limbs[after * numbers + i];
                rows.push_back(row);
            }
    return rows;
}

Rows plain_smooth(const Sample& s, const Rows& rows, double sigma, int radius) {
    std::vector<double> taps;
    double sum = 0;
    for (int r = -radius; r <= radius; ++r) sum += taps.emplace_back(std::exp(-r * r / (2 * sigma * sigma)));
    Rows out(rows.size(), std::vector<double>(rows[0].size(), 0.0));
    std::size_t begin = 0;
    for (const auto frames : s.batch.frames) {
        const int n = static_cast<int>(frames);
        for (int t = 0; t < n; ++t)
            for (std::size_t p = 0; p < s.batch.persons; ++p)
                for (int r = -radius; r <= radius; ++r) {
                    int at = t + r;
                    while (at < 0 || at >= n) at = at < 0 ? -1 - at : 2 * n - 1 - at;
                    const auto& from = rows[(begin + at) * s.batch.persons + p];
                    auto& to = out[(begin + t) * s.batch.persons + p];
                    for (std::size_t i = 0; i < to.size(); ++i) to[i] += taps[r + radius] / sum * from[i];
                }
        begin += frames;
    }
    return out;
}

struct PlainResult {
    std::vector<double> motion, bones;
};

PlainResult plain_normalise(const Sample& s, const Rows& rows) {
    PlainResult out;
    std::size_t begin = 0;
    const std::size_t persons = s.batch.persons, joints = s.batch.joints;
    for (const auto frames : s.batch.frames) {
        double mean[3] = {};
        std::vector<double> bones(persons * joints, 0.0);
        for (std::size_t row = begin * persons; row < (begin + frames) * persons; ++row) {
            for (std::size_t d = 0; d < 3; ++d)
                mean[d] += rows[row][d] / static_cast<double>(frames * persons);
            for (std::size_t k = 1; k < joints; ++k)
                bones[row % persons * joints + k] +=
                    std::hypot(rows[row][3 * k], rows[row][3 * k + 1], rows[row][3 * k + 2]) / frames;
        }
        for (std::size_t row = begin * persons; row < (begin + frames) * persons; ++row)
            for (std::size_t k = 0; k < joints; ++k) {
                const double length =
                    std::hypot(rows[row][3 * k], rows[row][3 * k + 1], rows[row][3 * k + 2]) + 1e-4;
                for (std::size_t d = 0; d < 3; ++d)
                    out.motion.push_back(k == 0 ? rows[row][d] - mean[d] : rows[row][3 * k + d] / length);
            }
        out.bones.insert(out.bones.end(), bones.begin(), bones.end());
        begin += frames;
    }
    return out;
}

std::vector<float> flat(const kernels::LimbRows& rows, std::size_t numbers) {
    const auto padded = rows.values.download();
    std::vector<float> out;
    for (std::size_t at = 0; at < padded.size(); at += rows.pitch)
        out.insert(out.end(), padded.begin() + at, padded.begin() + at + numbers);
    return out;
}

template <typename A, typename B>
double largest_difference(const A& a, const B& b) {
    EXPECT_EQ(a.size(), b.size());
    EXPECT_FALSE(b.empty());
    double largest = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = test::larger(largest, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    return largest;
}

std::vector<double> flat(const Rows& rows) {
    std::vector<double> out;
    for (const auto& row : rows) out.insert(out.end(), row.begin(), row.end());
    return out;
}

kernels::Buffer<float> on(kernels::Device& device, const std::vector<float>& limbs) {
    auto buffer = kernels::limb_buffer(device, limbs.size() / 3, 1);
    buffer.upload(limbs);
    return buffer;
}

const kernels::Smoothing unsmoothed{0, 12};
const std::vector<std::uint32_t> ragged{1, 2, 5, 12, 13, 25, 26, 103, 300, 1};

}  // namespace

// Numbers are of order 1 to 4 and float32 has 6e-8 relative precision; a blend rounds three times, a smoothing adds 25 terms.
TEST(Cleaning, FillsGapsInsideBeforeAndAfter) {
    for (const auto persons : {1U, 2U, 5U})
        for (const auto joints : {1U, 5U, 16U, 21U, 25U}) {
            const Sample s(persons, joints, ragged, persons * 100 + joints);
            kernels::Device device;
            const auto rows = fill_and_smooth(device, s.batch, on(device, s.limbs), unsmoothed);
            EXPECT_LT(largest_difference(flat(rows, joints * 3), flat(plain_fill(s))), 1e-6);
        }
}

TEST(Cleaning, ResamplesToAnotherFrameRate) {
    for (const float step : {0.25F, 0.8F, 1.5F, 4.0F}) {
        const Sample s(1, 21, {40, 17, 1, 90}, 7, step);
        kernels::Device device;
        const auto rows = fill_and_smooth(device, s.batch, on(device, s.limbs), unsmoothed);
        // times reach 360 frames, where float32 holds 3e-5: limbs that differ by 5 from frame to frame differ by 1e-4
        EXPECT_LT(largest_difference(flat(rows, 63), flat(plain_fill(s))), step == 0.8F ? 2e-4 : 1e-6);
    }
}

TEST(Cleaning, SmoothsWithMirroredEdgesHoweverShortTheClip) {
    for (const auto joints : {3U, 25U}) {
        const Sample s(2, joints, ragged, 3);
        kernels::Device device;
        for (const auto& [sigma, radius] : {std::pair(3.0F, 12U), {0.7F, 3U}, {3.0F, 0U}, {10.0F, 40U}}) {
            const auto rows = fill_and_smooth(device, s.batch, on(device, s.limbs), {sigma, radius});
            const auto plain = plain_smooth(s, plain_fill(s), sigma, static_cast<int>(radius));
            EXPECT_LT(largest_difference(flat(rows, joints * 3), flat(plain)), 2e-6);
        }
    }
}

// A GPU smooths fewer numbers a work-item than a processor; each of them is the same sum.
TEST(Cleaning, SmoothsToTheSameBytesInAnyShape) {
    const Sample s(2, 21, ragged, 11);
    kernels::Device device;
    const auto wide = flat(fill_and_smooth(device, s.batch, on(device, s.limbs), {3, 12, 16}), 63);
    for (const auto vec : {4U, 8U})
        EXPECT_EQ(flat(fill_and_smooth(device, s.batch, on(device, s.limbs), {3, 12, vec}), 63), wide) << vec;
}

TEST(Cleaning, CleansAsThePlainComputationDoes) {
    for (const auto persons : {1U, 2U, 3U})
        for (const auto joints : {2U, 15U, 16U, 21U, 25U, 52U}) {
            const Sample s(persons, joints, ragged, persons * 10 + joints);
            kernels::Device device;
            const auto cleaned = clean(device, s.batch, on(device, s.limbs), {});
            const auto plain = plain_normalise(s, plain_smooth(s, plain_fill(s), 3, 12));
            // A limb whose smoothed length is far under its noise loses digits when it is divided by that length.
            EXPECT_LT(largest_difference(cleaned.motion, plain.motion), 2e-5);
            EXPECT_LT(largest_difference(cleaned.bone_length, plain.bones), 2e-6);
        }
}

TEST(Cleaning, KeepsAZeroLimbZero) {
    Sample s(1, 2, {4}, 1);
    std::fill(s.limbs.begin(), s.limbs.end(), 0.0F);
    kernels::Device device;
    const auto cleaned = clean(device, s.batch, on(device, s.limbs), {});
    EXPECT_EQ(std::vector<float>(cleaned.motion.begin(), cleaned.motion.end()),
              std::vector<float>(4 * 2 * 3, 0.0F));
}

TEST(Cleaning, CleansNothingToNothing) {
    ClipBatch empty;
    empty.joints = 25;
    empty.first = {0};
    kernels::Device device;
    EXPECT_TRUE(clean(device, empty, on(device, {}), {}).motion.empty());
}

TEST(Cleaning, GivesTheSameBytesAlone) {
    const Sample many(2, 25, {50, 60, 70}, 5);
    kernels::Device device;
    const auto together = clean(device, many.batch, on(device, many.limbs), {});
    Sample first = many;
    first.batch.frames.resize(1);
    first.batch.first.resize(3);
    const auto alone = clean(device, first.batch, on(device, first.limbs), {});
    EXPECT_TRUE(std::equal(alone.motion.begin(), alone.motion.end(), together.motion.begin()));
}
