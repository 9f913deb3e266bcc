// What a stopped ingest has noted down comes back as it was.
#include "ingest/pipeline/journal.hpp"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;

TEST(Journal, ComesBackWithEveryKindOfRejection) {
    const test::TempDir dir;
    Tranche noted;
    noted.files = 4;
    noted.names = {"kept"};
    noted.labels = {{0, 2}};
    noted.splits[{0, "xsub/train"}] = 1;
    for (const auto kind : {Rejection::Kind::broken, Rejection::Kind::dropped, Rejection::Kind::missing,
                            Rejection::Kind::duplicate})
        noted.left_out.push_back({"file", {kind, "why"}});
    noted.doubts.push_back({0, "too fast", "kept"});
    {
        Workplace stopped(dir / "out.partial", "request", 1);
        stopped.finish(noted);
    }
    const Workplace again(dir / "out.partial", "request", 1);
    EXPECT_TRUE(again.notes().empty()) << again.notes().front();
    ASSERT_EQ(again.finished().size(), 1U);
    const auto& back = again.finished().front();
    ASSERT_EQ(back.left_out.size(), noted.left_out.size());
    for (std::size_t i = 0; i < back.left_out.size(); ++i)
        EXPECT_EQ(back.left_out[i].rejection.kind, noted.left_out[i].rejection.kind) << i;
    EXPECT_EQ(back.names, noted.names);
    EXPECT_EQ(back.labels, noted.labels);
    EXPECT_EQ(back.splits, noted.splits);
    EXPECT_EQ(back.doubts.front().clip, "kept");
}

TEST(Journal, OfDatasetsThatThereAreNotIsDamaged) {
    const test::TempDir dir;
    Tranche noted;
    noted.labels = {{1, 2}};
    {
        Workplace stopped(dir / "out.partial", "request", 2);
        stopped.finish(noted);
    }
    const Workplace again(dir / "out.partial", "request", 1);
    EXPECT_TRUE(again.finished().empty());
    ASSERT_EQ(again.notes().size(), 1U);
    EXPECT_NE(again.notes()[0].find("journal:2: damaged"), std::string::npos) << again.notes()[0];
}
