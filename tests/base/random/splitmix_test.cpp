#include "base/random/splitmix.hpp"

#include <gtest/gtest.h>

using namespace actformer;

TEST(SplitMix, GivesThePublishedNumbers) {
    // The reference implementation's first numbers (Vigna, splitmix64.c) of seed 1234567.
    SplitMix random(1234567);
    for (const std::uint64_t expected : {6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                         4593380528125082431U, 16408922859458223821U})
        EXPECT_EQ(random.next(), expected);
}

TEST(SplitMix, MixingOneBitChangesHalfTheBits) {
    int changed = 0;
    for (int bit = 0; bit < 64; ++bit)
        for (std::uint64_t x = 1; x <= 100; ++x)
            changed +=
                __builtin_popcountll(mixed(x * golden_step) ^ mixed((x * golden_step) ^ (1ULL << bit)));
    EXPECT_NEAR(changed / 6400.0, 32, 0.25) << "6,400 sums of 64 fair bits: their mean deviates by 0.05";
}
