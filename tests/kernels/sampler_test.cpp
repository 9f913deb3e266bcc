// The sampler: the generator's published vectors; windows, classes and persons of its batches.
#include "kernels/sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "kernels/sources.hpp"

using namespace actformer;
using namespace actformer::kernels;

namespace {

/// The value of joint k, coordinate d of person p in frame t of clip c says all of that.
float mark(std::size_t c, std::size_t t, std::size_t p, std::size_t k, std::size_t d) {
    return static_cast<float>((((c * 200 + t) * 5 + p) * 4 + k) * 3 + d);  // below 2^24 for up to 1300 clips
}

struct Marked {
    Device device;
    ClipStore store;

    Marked(std::uint32_t persons, std::vector<std::uint32_t> frames, std::vector<std::uint32_t> labels)
        : store(device, ClipTable{persons, 4, 3, std::move(frames), std::move(labels)}) {
        for (std::size_t c = 0; c < store.table().clips(); ++c) {
            std::vector<float> values;
            for (std::size_t t = 0; t < store.table().frames[c]; ++t)
                for (std::size_t p = 0; p < persons; ++p)
                    for (std::size_t k = 0; k < 4; ++k)
                        for (std::size_t d = 0; d < 3; ++d) values.push_back(mark(c, t, p, k, d));
            store.load(c, values);
        }
    }
};

/// Upper bound of chi-square with `freedom` degrees that a true sampler passes but once in three million (five standard
/// deviations by the approximation of Wilson and Hilferty). The seeds are fixed: a test passes always or never.
double chi_square_bound(double freedom) {
    const double v = 2 / (9 * freedom);
    return freedom * std::pow(1 - v + 5 * std::sqrt(v), 3);
}

double chi_square(const std::vector<double>& seen, const std::vector<double>& weights) {
    const double draws = std::accumulate(seen.begin(), seen.end(), 0.0);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    double sum = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const double expected = draws * weights[i] / total;
        sum += (seen[i] - expected) * (seen[i] - expected) / expected;
    }
    return sum;
}

std::vector<float> copy(std::span<const float> values) {
    return {values.begin(), values.end()};
}

std::uint32_t back_and_forth(std::uint32_t t, std::uint32_t n) {
    std::uint32_t at = 0;
    int step = 1;
    for (std::uint32_t i = 0; i < t && n > 1; ++i) {
        if (at + step == n || (at == 0 && step < 0)) step = -step;
        at += step;
    }
    return at;
}

}  // namespace

TEST(Philox, GivesThePublishedVectors) {
    Device device;
    const auto text = std::string(source("philox")) +
                      "kernel void fill(global const uint* c, global const uint* k, global uint* out) {"
                      "    const uint i = get_global_id(0);"
                      "    if (i < 3) vstore4(philox(vload4(i, c), vload2(i, k)), i, out);"
                      "}";
    const Buffer<std::uint32_t> counters(
        device, std::vector<std::uint32_t>{0, 0, 0, 0, ~0U, ~0U, ~0U, ~0U, 0x243f6a88, 0x85a308d3, 0x13198a2e,
                                           0x03707344});
    const Buffer<std::uint32_t> keys(device,
                                     std::vector<std::uint32_t>{0, 0, ~0U, ~0U, 0xa4093822, 0x299f31d0});
    const Buffer<std::uint32_t> out(device, 12);
    launch(device, device.kernel_from(text, "test", "fill"), {3, 1}, counters, keys, out);
    EXPECT_EQ(out.download(), (std::vector<std::uint32_t>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8,
                                                          0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd,
                                                          0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

namespace {

/// Every window of a batch, beside its clip; shorter clips show frame padded(t, frames) at t.
void expect_windows_of_clips(Padding padding, std::uint32_t (*padded)(std::uint32_t, std::uint32_t)) {
    Marked m(2, {1, 2, 7, 59, 60, 61, 150}, {0, 1, 2, 3, 4, 5, 6});
    const Sampler sampler(m.store, {.seed = 3, .padding = padding});
    Batch batch(m.store, 200, 60);
    sampler.draw(0, batch);
    const auto view = batch.map();
    std::set<std::uint32_t> clips, starts_of_longest;
    for (std::size_t s = 0; s < 200; ++s) {
        const auto clip = view.picks[2 * s], start = view.picks[2 * s + 1],
                   frames = m.store.table().frames[clip];
        clips.insert(clip);
        if (clip == 6) starts_of_longest.insert(start);
        ASSERT_EQ(view.labels[s], clip);
        ASSERT_LE(start, frames > 60 ? frames - 60 : 0);
        const float* sample = &view.values[s * 2 * 3 * 60 * 4];
        const bool swapped = sample[0] != mark(clip, start, 0, 0, 0);
        for (std::size_t p = 0; p < 2; ++p)
            for (std::size_t d = 0; d < 3; ++d)
                for (std::uint32_t t = 0; t < 60; ++t)
                    for (std::size_t k = 0; k < 4; ++k) {
                        const auto at = frames > 60 ? start + t : padded(t, frames);
                        ASSERT_EQ(sample[((p * 3 + d) * 60 + t) * 4 + k],
                                  mark(clip, at, swapped ? 1 - p : p, k, d))
                            << "clip " << clip << " frame " << t;
                    }
    }
    EXPECT_EQ(clips.size(), 7U);
    EXPECT_GT(starts_of_longest.size(), 10U);
}

}  // namespace

TEST(Sampler, ShowsWholeWindowsOfTheClipItNames) {
    expect_windows_of_clips(Padding::back_and_forth, back_and_forth);
}

TEST(Sampler, HoldsTheLastFrameOfShorterClipsWhereAsked) {
    expect_windows_of_clips(Padding::hold,
                            [](std::uint32_t t, std::uint32_t n) { return std::min(t, n - 1); });
}

TEST(Sampler, DrawsClassesByTheSquareRootOfTheirClips) {
    const std::vector<std::uint32_t> sizes{1, 4, 9, 100, 0, 25};  // class 4 has no clip
    std::vector<std::uint32_t> labels;
    for (std::uint32_t c = 0; c < sizes.size(); ++c) labels.insert(labels.end(), sizes[c], c);
    Marked m(1, std::vector<std::uint32_t>(labels.size(), 1), labels);
    const std::vector<double> by_root{1, 2, 3, 10, 5}, by_count{1, 4, 9, 100, 25};
    for (const auto how : {ClassSampling::square_root, ClassSampling::plain}) {
        const Sampler sampler(m.store, {.seed = 11, .classes = how});
        Batch batch(m.store, 50000, 1);
        sampler.draw(0, batch);
        std::vector<double> of_class(6), of_clip(labels.size());
        const auto view = batch.map();
        for (std::size_t s = 0; s < 50000; ++s) {
            ++of_class[view.labels[s]];
            ++of_clip[view.picks[2 * s]];
        }
        EXPECT_EQ(of_class[4], 0) << "a class without clips is never drawn";
        of_class.erase(of_class.begin() + 4);
        EXPECT_LT(chi_square(of_class, how == ClassSampling::plain ? by_count : by_root),
                  chi_square_bound(4));
        const std::vector<double> of_large(of_clip.begin() + 14, of_clip.begin() + 114);
        EXPECT_LT(chi_square(of_large, std::vector<double>(100, 1)), chi_square_bound(99))
            << "clips are drawn alike";
    }
}

TEST(Sampler, DrawsEveryStartAlike) {
    Marked m(1, {100}, {0});
    const Sampler sampler(m.store, {.seed = 5});
    Batch batch(m.store, 41000, 60);
    std::vector<double> starts(41);
    sampler.draw(0, batch);
    for (std::size_t s = 0; s < 41000; ++s) ++starts.at(batch.map().picks[2 * s + 1]);
    EXPECT_LT(chi_square(starts, std::vector<double>(41, 1)), chi_square_bound(40));
}

TEST(Sampler, DrawsEveryOrderOfPersonsAlike) {
    for (const std::uint32_t persons : {2U, 3U, 5U}) {
        Marked m(persons, {1}, {0});
        std::map<std::vector<float>, double> orders;
        Batch batch(m.store, 24000, 1);
        Sampler(m.store, {.seed = 7}).draw(1, batch);
        for (std::size_t s = 0; s < 24000; ++s) {
            std::vector<float> order;
            for (std::size_t p = 0; p < persons; ++p)
                order.push_back(batch.map().values[(s * persons + p) * 3 * 4]);
            ++orders[order];
        }
        std::vector<double> seen;
        for (const auto& [order, count] : orders) {
            EXPECT_EQ(std::set<float>(order.begin(), order.end()).size(), persons) << "nobody twice";
            seen.push_back(count);
        }
        const double factorial = std::tgamma(persons + 1.0);
        ASSERT_EQ(static_cast<double>(seen.size()), factorial);
        EXPECT_LT(chi_square(seen, std::vector<double>(seen.size(), 1)), chi_square_bound(factorial - 1));
    }
}

TEST(Sampler, KeepsTheOrderOfPersonsWhereAsked) {
    Marked m(3, {90, 20}, {0, 1});
    Batch batch(m.store, 50, 10);
    Sampler(m.store, {.seed = 1, .permute_persons = false}).draw(4, batch);
    const auto view = batch.map();
    for (std::size_t s = 0; s < 50; ++s)
        for (std::size_t p = 0; p < 3; ++p)
            EXPECT_EQ(view.values[(s * 3 + p) * 3 * 10 * 4],
                      mark(view.picks[2 * s], view.picks[2 * s + 1], p, 0, 0));
}

TEST(Sampler, IsAFunctionOfSeedAndIndexAlone) {
    Marked m(2, {100, 20, 61, 300}, {0, 0, 1, 2});
    const auto draw = [&](std::uint64_t seed, std::uint64_t index, std::uint32_t samples) {
        Batch batch(m.store, samples, 60);
        const Sampler sampler(m.store, {.seed = seed});
        sampler.draw(index + 1, batch);  // what was drawn before leaves no trace
        sampler.draw(index, batch);
        return copy(batch.map().values);
    };
    const auto first = draw(1, 5, 8);
    EXPECT_EQ(draw(1, 5, 8), first);
    EXPECT_NE(draw(1, 6, 8), first);
    EXPECT_NE(draw(2, 5, 8), first);
    EXPECT_NE(draw(1, 5 + (1ULL << 32), 8), first) << "all 64 bits count";
    EXPECT_NE(draw(1 + (1ULL << 32), 5, 8), first);
    auto longer = draw(1, 5, 64);
    longer.resize(first.size());
    EXPECT_EQ(longer, first) << "a sample does not depend on the batch's size";
}

TEST(Sampler, DrawsWhatItDrewOnEveryOtherDevice) {
    Marked m(3, {100, 20, 61, 150}, {0, 0, 1, 2});
    Batch batch(m.store, 6, 60);
    Sampler(m.store, {.seed = 20230923}).draw(17, batch);
    const auto picks = batch.map().picks;
    // Worked out from the generator's definition by a separate program.
    EXPECT_EQ(std::vector<std::uint32_t>(picks.begin(), picks.end()),
              (std::vector<std::uint32_t>{0, 27, 2, 0, 0, 14, 2, 1, 2, 1, 2, 1}));
}

TEST(Sampler, FillsOneBatchWhileAnotherIsRead) {
    Marked m(1, {100, 200}, {0, 1});
    const Sampler sampler(m.store, {.seed = 9});
    std::array<Batch, 2> turns{Batch(m.store, 16, 60), Batch(m.store, 16, 60)};
    Batch alone(m.store, 16, 60);
    sampler.draw(0, turns[0]);
    for (std::uint64_t i = 0; i < 6; ++i) {
        auto& now = turns[i % 2];
        sampler.draw(i + 1, turns[(i + 1) % 2]);
        sampler.draw(i, alone);
        EXPECT_EQ(copy(now.map().values), copy(alone.map().values));
    }
}

TEST(Windows, CutClipsOneAfterTheOther) {
    const std::vector<std::uint32_t> frames{60, 59, 119, 120, 1, 185};
    const std::vector<Window> expected{{0, 0}, {1, 0}, {2, 0},  {3, 0},  {3, 60},
                                       {4, 0}, {5, 0}, {5, 60}, {5, 120}};
    const auto windows = consecutive_windows(frames, 60);
    EXPECT_EQ(windows, expected);
    EXPECT_THROW(consecutive_windows(frames, 0), Error);

    Marked m(2, frames, {5, 4, 3, 2, 1, 0});
    const WindowCutter cutter(m.store, windows);
    Batch batch(m.store, 4, 60);
    std::size_t seen = 0;
    for (std::size_t first = 0; first < cutter.windows(); first += 4) {
        cutter.cut(first, batch);
        const auto view = batch.map();
        for (std::size_t s = 0; s < batch.filled(); ++s, ++seen) {
            const auto [clip, start] = windows[seen];
            EXPECT_EQ(view.labels[s], 5 - clip);
            for (std::size_t p = 0; p < 2; ++p)
                for (std::uint32_t t = 0; t < 60; ++t) {
                    const auto at = frames[clip] < 60 ? back_and_forth(t, frames[clip]) : start + t;
                    ASSERT_EQ(view.values[((s * 2 + p) * 3 * 60 + t) * 4], mark(clip, at, p, 0, 0));
                }
        }
    }
    EXPECT_EQ(seen, windows.size());
}

namespace {

constexpr std::uint32_t persons = 2, window = 8, samples = 32;

/// A store of clips of 2 persons of 4 nodes, their values far from centred.
ClipStore uncentred(Device& device, std::uint32_t numbers, const std::optional<Centring>& centring) {
    ClipStore store(device, {persons, 4, numbers, {20, 5, 8}, {0, 1, 1}, centring});
    const std::size_t row = std::size_t{persons} * 4 * numbers;
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (std::size_t i = 0; i < store.table().frames[c] * row; ++i)
            values.push_back(std::sin(0.37F * static_cast<float>(i + 50 * c)) + static_cast<float>(i % 12));
        store.load(c, values);
    }
    return store;
}

/// What a batch holds of node `k`, number `d`, of the p-th person shown, in frame t of sample i.
struct Shown {
    Batch::View view;
    std::uint32_t numbers;

    float operator()(std::size_t i, std::size_t t, std::size_t p, std::size_t k, std::size_t d) const {
        return view.values[(((i * persons + p) * numbers + d) * window + t) * 4 + k];
    }
    double mean(std::size_t i, std::size_t k, std::size_t d) const {
        double sum = 0;
        for (std::size_t t = 0; t < window; ++t)
            for (std::size_t p = 0; p < persons; ++p) sum += (*this)(i, t, p, k, d);
        return sum / (window * persons);
    }
};

void expect_centred(std::uint32_t numbers, const Centring& centring) {
    Device device;
    const auto plain = uncentred(device, numbers, {}), centred = uncentred(device, numbers, centring);
    Batch all(plain, samples, window), moved(centred, samples, window);
    Sampler(plain, {.seed = 3}).draw(0, all);
    Sampler(centred, {.seed = 3}).draw(0, moved);
    const Shown before{all.map(), numbers}, after{moved.map(), numbers};
    for (std::size_t i = 0; i < samples; ++i)
        for (std::size_t d = 0; d < numbers; ++d) {
            const double mean = before.mean(i, centring.root, d);
            for (std::size_t t = 0; t < window; ++t)
                for (std::size_t p = 0; p < persons; ++p)
                    for (std::size_t k = 0; k < 4; ++k) {
                        const bool moves =
                            d < 3 && k >= centring.first && k < centring.first + centring.count;
                        // 16 float32 additions of numbers up to 13; what does not move stays to the bit
                        ASSERT_NEAR(after(i, t, p, k, d), before(i, t, p, k, d) - (moves ? mean : 0),
                                    moves ? 2e-5 : 0)
                            << "node " << k << ", number " << d;
                    }
        }

    const auto windows = consecutive_windows(centred.table().frames, window);
    Batch cut(centred, 4, window);
    WindowCutter(centred, windows).cut(0, cut);
    const Shown view{cut.map(), numbers};
    for (std::size_t i = 0; i < view.view.labels.size(); ++i)
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(view.mean(i, centring.root, d), 0, 2e-6);
}

}  // namespace

TEST(Sampler, CentresTheRootOverAWindowWhereAsked) {
    expect_centred(3, {0, 0, 1});  // limb vectors: the root alone
}

TEST(Sampler, CentresTheTranslationBehindRotations) {
    expect_centred(6, {3, 3, 1});
}

TEST(Sampler, CentresAllJointsByTheirRoot) {
    expect_centred(3, {0, 0, 4});
}

namespace {

/// Batches of random windows and all consecutive ones, drawn from the device and by the processor.
void expect_the_same_in_memory(ClipTable table, Padding padding) {
    Device device;
    ClipStore there(device, table), here(table);
    for (std::size_t c = 0; c < table.clips(); ++c) {
        std::vector<float> values;
        for (std::size_t i = 0; i < table.frames[c] * table.frame_values(); ++i)
            values.push_back(std::sin(0.37F * static_cast<float>(i + 50 * c)) + static_cast<float>(i % 12));
        there.load(c, values);
        here.load(c, values);
    }
    Batch a(there, 64, 20), b(here, 64, 20);
    const auto expect_same = [&] {
        const auto x = a.map(), y = b.map();
        EXPECT_TRUE(std::ranges::equal(x.picks, y.picks) && std::ranges::equal(x.labels, y.labels));
        EXPECT_TRUE(std::ranges::equal(x.values, y.values));
    };
    const SamplerOptions options{.seed = 0x123456789ABCDEF, .first_sample = 3, .padding = padding};
    for (const std::uint64_t batch : {std::uint64_t{0}, std::uint64_t{7}, std::uint64_t{1} << 40}) {
        Sampler(there, options).draw(batch, a);
        Sampler(here, options).draw(batch, b);
        expect_same();
    }
    const auto windows = consecutive_windows(table.frames, 20);
    for (std::size_t first = 0; first < windows.size(); first += 64) {
        WindowCutter(there, windows).cut(first, a);
        WindowCutter(here, windows).cut(first, b);
        ASSERT_EQ(a.filled(), b.filled());
        expect_same();
    }
}

}  // namespace

TEST(Sampler, DrawsTheSameWithoutADevice) {
    std::vector<std::uint32_t> frames, labels;
    for (std::uint32_t c = 0; c < 90; ++c) {
        frames.push_back(1 + c * c % 67);
        labels.push_back(c % 7 * (c % 3));
    }
    expect_the_same_in_memory({1, 5, 3, frames, labels, Centring{0, 0, 1}}, Padding::back_and_forth);
    expect_the_same_in_memory({5, 4, 6, frames, labels, Centring{3, 3, 1}}, Padding::hold);
    expect_the_same_in_memory({16, 3, 3, frames, labels, {}}, Padding::back_and_forth);
}

TEST(ClipStore, RefusesWhatCannotBeDrawn) {
    Device device;
    EXPECT_THROW(ClipStore(device, ClipTable{1, 4, 3, {}, {}}), Error);
    EXPECT_THROW(ClipStore(device, ClipTable{1, 4, 3, {5, 0}, {0, 0}}), Error);
    EXPECT_THROW(ClipStore(device, ClipTable{17, 4, 3, {5}, {0}}), Error);
    EXPECT_THROW(ClipStore(device, ClipTable{1, 4, 3, {5, 6}, {0}}), Error);
    EXPECT_THROW(ClipStore(device, ClipTable{16, 25, 3, std::vector<std::uint32_t>(1000, 4000000),
                                             std::vector<std::uint32_t>(1000)}),
                 Error)
        << "more frames than a device holds";
    for (const auto& none : {Centring{4, 0, 1}, Centring{0, 3, 2}, Centring{0, 5, 1}})
        EXPECT_THROW(ClipStore(device, ClipTable{1, 4, 3, {5}, {0}, none}), Error) << "no such node";
    EXPECT_THROW(ClipStore(device, ClipTable{1, 4, 2, {5}, {0}, Centring{}}), Error)
        << "no position in two numbers";
}
