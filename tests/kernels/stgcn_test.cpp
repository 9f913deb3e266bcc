// Every building block of the network against its definition in double.
#include "kernels/stgcn.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/peak.hpp"

using namespace actformer;
using namespace actformer::kernels;

namespace {

std::vector<float> made(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<float> out(count);
    for (auto& v : out) v = normal(random);
    return out;
}

/// Panels with numbers in their first `width` channels and zeros beyond, rows included.
struct MadePanels {
    Buffer<float> memory;
    Panels panels;
    std::vector<float> values;

    MadePanels(const Stgcn& kernels, std::uint32_t count, std::size_t rows, std::uint32_t width,
               unsigned seed)
        : panels{{}, count, kernels.rows(rows), kernels.pitch(width)},
          values(std::size_t{count} * panels.rows * panels.pitch, 0.0F) {
        const auto numbers = made(count * rows * width, seed);
        for (std::size_t p = 0; p < count; ++p)
            for (std::size_t r = 0; r < rows; ++r)
                for (std::size_t c = 0; c < width; ++c) at(p, r, c) = numbers[(p * rows + r) * width + c];
        memory = Buffer<float>(kernels.device(), values);
        panels.memory = memory.memory();
    }

    float& at(std::size_t panel, std::size_t row, std::size_t channel) {
        return values[(panel * panels.rows + row) * panels.pitch + channel];
    }
    void fetch() { memory.download(values); }
};

const std::vector<Tiles> shapes{{16, 6, 4, 32, 1, false, 16, 8}, {16, 8, 2, 8, 1, false, 16, 8},
                                {4, 8, 1, 1, 64, true, 1, 64},   {1, 3, 5, 2, 4, true, 1, 1},
                                {8, 4, 3, 3, 2, false, 4, 2},    {2, 1, 1, 1, 1, false, 2, 1}};

}  // namespace

// Sums of up to 192 products of order 1: float32 loses some 1e-6 of the sum's standard deviation, 14.
TEST(Multiply, AddsUpItsSegments) {
    Device device;
    for (const auto& tiles : shapes) {
        Stgcn kernels(device, tiles);
        constexpr std::uint32_t rows = 37, depth = 13, columns = 21, sets = 2;
        MadePanels a(kernels, 4, rows, depth, 1), out(kernels, 3, rows, columns, 2);
        const auto weights = made(sets * depth * columns, 3);
        const auto packed = kernels.pack(weights, sets, depth, columns);
        const std::vector<std::uint32_t> first{0, 1, 3, 6}, segments{2, 0, 0, 1, 1, 0, 3, 1, 3, 0, 2, 1};
        const auto scale = made(6, 4), bias = made(std::size_t{3} * out.panels.pitch, 5);
        const Problems problems{Buffer<std::uint32_t>(device, first), Buffer<std::uint32_t>(device, segments),
                                Buffer<float>(device, scale), 3};
        for (const bool graph : {false, true}) {
            if (graph)
                kernels.multiply_graph(a.panels, packed, problems, Buffer<float>(device, bias), out.panels,
                                       rows);
            else
                kernels.multiply(a.panels, packed, problems, out.panels, rows);
            out.fetch();
            for (std::size_t p = 0; p < 3; ++p)
                for (std::size_t r = 0; r < rows; ++r)
                    for (std::size_t c = 0; c < columns; ++c) {
                        double sum = 0;
                        for (auto s = first[p]; s < first[p + 1]; ++s) {
                            for (std::size_t k = 0; k < depth; ++k)
                                sum += double{a.at(segments[2 * s], r, k)} *
                                       weights[(segments[2 * s + 1] * depth + k) * columns + c];
                            if (graph) sum *= scale[s];
                        }
                        if (graph) sum = std::max(0.0, sum + bias[p * out.panels.pitch + c]);
                        ASSERT_NEAR(out.at(p, r, c), sum, 1e-4) << describe(tiles);
                    }
        }
    }
}

TEST(Gather, MixesJointsBehindThem) {
    Device device;
    for (const auto& tiles : shapes) {
        Stgcn kernels(device, tiles);
        constexpr std::uint32_t joints = 3, sequences = 2, frames = 7, width = 5;
        const std::vector<std::uint32_t> first{0, 2, 3}, source{0, 2, 1};
        const std::vector<float> share{0.25F, -2, 3};
        const Mixture mixture{Buffer<std::uint32_t>(device, first), Buffer<std::uint32_t>(device, source),
                              Buffer<float>(device, share), 2};
        MadePanels x(kernels, joints + 2, sequences * frames, width, 1);
        const auto before = x;
        kernels.gather(x.panels, mixture, x.panels, joints, sequences, frames, 1);
        x.fetch();
        MadePanels stepped(kernels, 2, sequences * 4, width, 2);
        kernels.gather(x.panels, mixture, stepped.panels, 0, sequences, frames, 2);
        stepped.fetch();
        for (std::size_t r = 0; r < sequences * frames; ++r)
            for (std::size_t c = 0; c < width; ++c) {
                for (std::size_t k = 0; k < joints; ++k)
                    ASSERT_EQ(x.at(k, r, c), MadePanels(before).at(k, r, c));
                ASSERT_NEAR(x.at(3, r, c), 0.25F * x.at(0, r, c) - 2 * x.at(2, r, c), 1e-5);
                ASSERT_NEAR(x.at(4, r, c), 3 * x.at(1, r, c), 1e-5);
                const auto n = r / frames, t = r % frames;
                if (t % 2 == 0) {
                    ASSERT_NEAR(stepped.at(1, n * 4 + t / 2, c), 3 * x.at(1, r, c), 1e-5);
                }
            }
    }
}

TEST(FilterPoints, KeepTheFilterApart) {
    // Of a filter with one tap each, the points are those of that tap's power: a wrong table shows here first.
    for (std::size_t tap = 0; tap < 9; ++tap) {
        std::array<double, 9> taps{};
        taps[tap] = 1;
        EXPECT_EQ(filter_points(taps, 1).size(), 40U);
        const auto strided_points = filter_points(taps, 2);
        ASSERT_EQ(strided_points.size(), 16U);
        for (std::size_t i = 0; i < 16; ++i) {
            if (i / 8 != tap % 2) {
                EXPECT_EQ(strided_points[i], 0) << "even taps meet even frames only";
            }
        }
        EXPECT_NEAR(strided_points[tap % 2 * 8 + 2] / strided_points[tap % 2 * 8 + 1],
                    (tap / 2 % 2 ? -1.0 : 1.0), 1e-12);
    }
}

// The filtering at 40 or 8 points loses up to thirty times what plain sums lose: some 3e-5 of the results' deviation.
TEST(Temporal, ConvolvesAsPlainSumsDo) {
    Device device;
    for (const auto& tiles : shapes)
        for (const std::uint32_t stride : {1U, 2U})
            for (const std::uint32_t frames : {1U, 2U, 8U, 17U, 18U, 19U, 36U, 61U}) {
                Stgcn kernels(device, tiles);
                constexpr std::uint32_t joints = 2, sequences = 3, width = 6;
                const auto filter = filtering(stride);
                const auto after = strided(frames, stride),
                           tile_count = (after + filter.tile - 1) / filter.tile;
                const std::size_t rows = joints * sequences * tile_count;
                MadePanels x(kernels, joints, sequences * frames, width, 1);
                MadePanels residual(kernels, joints, sequences * after, width, 2);
                MadePanels points(kernels, filter.points_in, rows, width, 3);
                MadePanels products(kernels, filter.points_out, rows, width, 4);
                MadePanels out(kernels, joints, sequences * after, width, 5);

                std::vector<double> taps(width * width * 9);
                const auto numbers = made(taps.size(), 6);
                std::copy(numbers.begin(), numbers.end(), taps.begin());
                std::vector<float> weights(filter.points_in * width * width);
                for (std::size_t i = 0; i < width * width; ++i) {
                    const auto at = filter_points(std::span<const double, 9>(&taps[i * 9], 9), stride);
                    for (std::size_t p = 0; p < at.size(); ++p)
                        weights[p * width * width + i] = static_cast<float>(at[p]);
                }
                std::vector<std::uint32_t> first{0}, segments;
                for (std::uint32_t p = 0; p < filter.points_out; ++p) {
                    for (auto q = p; q < filter.points_in; q += filter.points_out)
                        segments.insert(segments.end(), {q, q});
                    first.push_back(static_cast<std::uint32_t>(segments.size() / 2));
                }
                const Problems problems{
                    Buffer<std::uint32_t>(device, first), Buffer<std::uint32_t>(device, segments),
                    Buffer<float>(device, std::vector<float>(segments.size() / 2, 1.0F)), filter.points_out};
                const auto bias = made(out.panels.pitch, 7);
                kernels.transform_input(x.panels, points.panels, sequences, frames, stride);
                kernels.multiply(points.panels, kernels.pack(weights, filter.points_in, width, width),
                                 problems, products.panels, rows);
                for (const bool add : {false, true}) {
                    kernels.transform_output(products.panels, Buffer<float>(device, bias),
                                             add ? &residual.panels : nullptr, out.panels, sequences, after,
                                             stride);
                    out.fetch();
                    for (std::size_t k = 0; k < joints; ++k)
                        for (std::size_t n = 0; n < sequences; ++n)
                            for (std::size_t t = 0; t < after; ++t)
                                for (std::size_t o = 0; o < width; ++o) {
                                    double sum = bias[o] + (add ? residual.at(k, n * after + t, o) : 0.0F);
                                    for (std::size_t r = 0; r < 9; ++r) {
                                        if (t * stride + r < 4 || t * stride + r - 4 >= frames) continue;
                                        for (std::size_t i = 0; i < width; ++i)
                                            sum += taps[(i * width + o) * 9 + r] *
                                                   x.at(k, n * frames + t * stride + r - 4, i);
                                    }
                                    ASSERT_NEAR(out.at(k, n * after + t, o), std::max(0.0, sum), 3e-4)
                                        << describe(tiles) << ", stride " << stride << ", frames " << frames;
                                }
                }
            }
}

TEST(Peak, IsANumber) {
    Device device;
    EXPECT_GT(measure_peak(device, 4, 1), 1e6);
}

// As a tuner would try them on a GPU.
TEST(Stgcn, RefusesFiltersThatReachBeyondARow) {
    Device device;
    EXPECT_THROW(Stgcn(device, Tiles{1, 16, 1, 1, 64, true, 2, 64}), Error);
    EXPECT_THROW(Stgcn(device, Tiles{2, 8, 1, 1, 64, true, 4, 64}), Error);
    EXPECT_NO_THROW(Stgcn(device, Tiles{4, 8, 1, 1, 64, true, 4, 64}));
}
