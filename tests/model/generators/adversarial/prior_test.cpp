// The prior: covariances of many draws, and what decides on a draw.
#include "model/generators/adversarial/prior.hpp"

#include <ATen/Parallel.h>
#include <gtest/gtest.h>

#include "model/cpu/random_kernel.hpp"

using namespace actformer::model;

namespace {

PriorSettings settings(std::uint32_t channels, std::uint32_t streams = 1) {
    PriorSettings s;
    s.channels = channels;
    s.streams = streams;
    return s;
}

}  // namespace

TEST(RandomKernel, WordsAreFair) {
    std::array<std::int64_t, 64> by_place{};
    std::int64_t ones = 0;
    constexpr int draws = 20000;
    for (std::uint32_t block = 0; block < draws; ++block)
        for (const auto word : cpu::random_words({9, 4, 1}, 3, block)) {
            ones += __builtin_popcount(word);
            ++by_place[word >> 26];
        }
    // 2.56 million fair bits: their deviation is 800. 80,000 words in 64 places: 1250 each, deviation 35.
    EXPECT_NEAR(static_cast<double>(ones), 16.0 * 4 * draws, 5 * 800);
    for (const auto count : by_place) EXPECT_NEAR(static_cast<double>(count), 1250, 5.5 * 35);
}

TEST(RandomKernel, NormalNumbersAreBoxAndMullersOfItsWords) {
    const cpu::RandomPlace place{5, 77, 2};
    constexpr std::int64_t count = 150;
    std::vector<float> values(2 * count);
    cpu::normal_numbers(place, 8, 2, count, values.data(), 1);
    for (std::int64_t s = 0; s < 2; ++s)
        for (std::int64_t i = 0; i < count; ++i) {
            const auto lane = static_cast<std::uint32_t>(i % 16),
                       half = static_cast<std::uint32_t>(i / 32 % 2);
            const auto words = cpu::random_words(place, static_cast<std::uint64_t>(8 + s),
                                                 static_cast<std::uint32_t>(i / 64 * 16) + lane);
            const auto portion = [&](std::size_t w) { return ((words[2 * half + w] >> 8) + 1) * 0x1p-24; };
            const double radius = std::sqrt(-2 * std::log(portion(0))), angle = 2 * M_PI * portion(1);
            const double expected = radius * (i % 32 < 16 ? std::cos(angle) : std::sin(angle));
            // float's 24 bits in a logarithm, a root and a sine; an angle near a whole turn has few of them
            EXPECT_NEAR(values[static_cast<std::size_t>(s * count + i)], expected, 2e-6 * (1 + radius)) << i;
        }
}

TEST(Prior, AShorterDrawIsTheBeginningOfALonger) {
    const Prior prior(settings(9), 3);
    const auto longer = prior.draw(1, 4, 40), shorter = prior.draw(1, 4, 25);
    EXPECT_LT((longer.slice(2, 0, 25) - shorter).abs().max().item<double>(), 1e-5);
}

TEST(Prior, DrawsHaveTheCovarianceOfTheirChannel) {
    const Prior prior(settings(12), 5);
    constexpr std::int64_t frames = 30, count = 4000;
    const auto z = prior.draw(0, count, frames).to(at::kDouble);
    ASSERT_EQ(z.sizes().vec(), (std::vector<std::int64_t>{count, 1, frames, 12}));
    for (std::int64_t c = 0; c < 12; ++c) {
        const auto channel = z.select(3, c).squeeze(1);
        const auto sample = channel.t().mm(channel) / count;
        // A product of two unit normals has a deviation of at most sqrt(2), its mean over 4000 of 0.0224: five of them.
        const auto off = (sample - Prior::covariance(prior.settings(), c, frames)).abs().max().item<double>();
        EXPECT_LT(off, 0.112) << c;
        EXPECT_LT(channel.mean(0).abs().max().item<double>(), 5 / std::sqrt(4000.0));
    }
    // Channels have nothing to do with each other.
    const auto flat = z.select(2, 7).squeeze(1);
    const auto across = flat.t().mm(flat) / count - at::eye(12, at::kDouble);
    EXPECT_LT(across.abs().max().item<double>(), 0.112);
}

TEST(Prior, TheSymmetricRootIsSymmetricAndGivesTheCovariance) {
    auto s = settings(6);
    s.length_scale = 5;
    s.root = PriorRoot::symmetric;
    const Prior prior(s, 2);
    constexpr std::int64_t frames = 7;
    // Unit vectors in, rows of the root out: (frame of the input, frame of the output, channel).
    const auto units =
        at::eye(frames).view({frames, 1, frames, 1}).expand({frames, 1, frames, 6}).contiguous();
    const auto root = prior.correlated(units).squeeze(1).to(at::kDouble);
    for (std::int64_t c = 0; c < 6; ++c) {
        const auto one = root.select(2, c);
        EXPECT_LT((one - one.t()).abs().max().item<double>(), 1e-6) << c;
        EXPECT_LT((one.mm(one) - Prior::covariance(s, c, frames)).abs().max().item<double>(), 2e-6) << c;
    }
}

TEST(Prior, CovarianceFallsWithTheChannelsLength) {
    const auto c = Prior::covariance(settings(120), 59, 8);  // a length of 50 frames
    EXPECT_DOUBLE_EQ(c[0][0].item<double>(), 1);
    EXPECT_DOUBLE_EQ(c[2][7].item<double>(), std::exp(-0.01));
}

TEST(Prior, TheGaussianOneRepeatsOverFrames) {
    auto s = settings(7, 2);
    s.kind = PriorKind::gaussian;
    const auto z = Prior(s, 1).draw(3, 2000, 5);
    EXPECT_TRUE(z.equal(z.slice(2, 0, 1).expand_as(z)));
    const auto first = z.select(2, 0).reshape({-1}).to(at::kDouble);  // 28,000 numbers
    EXPECT_NEAR(first.mean().item<double>(), 0, 5 / std::sqrt(28000.0));
    EXPECT_NEAR(first.var().item<double>(), 1, 5 * std::sqrt(2 / 28000.0));
    EXPECT_NEAR(first.pow(4).mean().item<double>(), 3, 5 * std::sqrt(96 / 28000.0));
    EXPECT_GT((z.select(1, 0) - z.select(1, 1)).abs().mean().item<double>(), 0.5);  // persons' own draws
}

TEST(Prior, ADrawIsDecidedBySeedIndexAndSampleAlone) {
    const Prior prior(settings(5, 2), 8);
    const auto z = prior.draw(4, 10, 12);
    EXPECT_TRUE(z.equal(prior.draw(4, 10, 12)));
    EXPECT_TRUE(z.equal(Prior(settings(5, 2), 8).draw(4, 10, 12)));
    EXPECT_TRUE(z.slice(0, 6).equal(prior.draw(4, 4, 12, 6)));  // another process's part of the batch
    const int before = at::get_num_threads();
    at::set_num_threads(before == 1 ? 2 : 1);
    EXPECT_TRUE(z.equal(prior.draw(4, 10, 12)));
    at::set_num_threads(before);
    for (const auto& other :
         {prior.draw(5, 10, 12), Prior(settings(5, 2), 9).draw(4, 10, 12), prior.draw(4, 10, 12, 1)})
        EXPECT_GT((z - other).abs().mean().item<double>(), 0.5);
}

TEST(Prior, TakesNoSamplesAndOneFrame) {
    EXPECT_EQ(Prior(settings(5), 8).draw(0, 0, 12).numel(), 0);
    EXPECT_EQ(Prior(settings(5), 8).draw(0, 3, 1).numel(), 15);
}
