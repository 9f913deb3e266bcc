#include "ingest/formats/ntu/tracks.hpp"

#include <gtest/gtest.h>

using namespace actformer::ingest;
using Persons = std::vector<std::vector<std::size_t>>;

namespace {

/// A body whose root goes from (x, 0, 0) by `speed` metres a frame, seen in frames first .. last.
Body track(std::uint32_t first, std::uint32_t last, float x, float speed = 0) {
    Body body;
    for (auto t = first; t <= last; ++t) {
        body.times.push_back(t);
        body.limbs.resize(body.limbs.size() + ntu_joints * 3, 0.1F);
        body.limbs[body.limbs.size() - ntu_joints * 3] = x + speed * static_cast<float>(t - first);
    }
    return body;
}

}  // namespace

TEST(Tracks, ThreeInSequenceAreOnePerson) {
    const std::vector<Body> tracks{track(0, 29, 0, 0.01F), track(30, 44, 0.3F), track(50, 69, 0.4F)};
    const auto persons = persons_of(tracks);
    EXPECT_EQ(persons, (Persons{{0, 1, 2}}));
    const auto bodies = joined(tracks, persons);
    ASSERT_EQ(bodies.size(), 1U);
    EXPECT_EQ(bodies[0].times.size(), 30U + 15 + 20);
    EXPECT_TRUE(std::is_sorted(bodies[0].times.begin(), bodies[0].times.end()));
    EXPECT_EQ(bodies[0].limbs.size(), bodies[0].times.size() * ntu_joints * 3);
    EXPECT_FLOAT_EQ(bodies[0].limbs[30 * ntu_joints * 3], 0.3F) << "the second track's first root";
}

TEST(Tracks, OnesSeenTogetherAreDifferentPersons) {
    EXPECT_EQ(persons_of({track(0, 30, 0), track(30, 60, 0)}), (Persons{{0}, {1}}));
    EXPECT_EQ(persons_of({track(0, 60, 0), track(10, 20, 0)}), (Persons{{0}, {1}}));
}

TEST(Tracks, FarInTimeOrPlaceDoNotFollow) {
    EXPECT_EQ(persons_of({track(0, 29, 0), track(30, 60, 0.34F)}), (Persons{{0, 1}}));
    EXPECT_EQ(persons_of({track(0, 29, 0), track(30, 60, 0.36F)}), (Persons{{0}, {1}}));
    EXPECT_EQ(persons_of({track(0, 29, 0), track(59, 80, 1.7F)}), (Persons{{0, 1}})) << "30 frames to walk";
    EXPECT_EQ(persons_of({track(0, 29, 0), track(60, 80, 0)}), (Persons{{0}, {1}}));
}

TEST(Tracks, TwoPersonsEachKeepTheirOwn) {
    // Both change number at frame 30; the new numbers come in the other order.
    const std::vector<Body> tracks{track(0, 29, 0), track(0, 29, 0.2F), track(30, 59, 0.19F),
                                   track(30, 59, 0.01F)};
    EXPECT_EQ(persons_of(tracks), (Persons{{0, 3}, {1, 2}}));
}

TEST(Tracks, OrderInTheFileDoesNotMatter) {
    // A body that appears first may be listed behind one that was seen before it and lost.
    const std::vector<Body> tracks{track(31, 50, 0), track(0, 30, 0)};
    EXPECT_EQ(persons_of(tracks), (Persons{{1, 0}}));
}
