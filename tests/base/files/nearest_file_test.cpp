#include "base/files/nearest_file.hpp"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.hpp"

using actformer::did_you_mean;
using actformer::test::TempDir;
using actformer::test::write_file;

TEST(NearestFile, IsCalledMostLikeWhatIsMissing) {
    const TempDir dir;
    for (const auto* name : {"ntu/ntu-1p/dataset.json", "ntu/ntu-2p/dataset.json", "generated.h5", "raw/x"})
        write_file(dir / name, "");
    const auto at = dir.path().string() + "/";
    EXPECT_EQ(did_you_mean(dir / "genrated.h5"), "; did you mean " + at + "generated.h5?");
    EXPECT_EQ(did_you_mean(dir / "ntu/ntu-p1/"), "; did you mean " + at + "ntu/ntu-1p?") << "letters swapped";
    EXPECT_EQ(did_you_mean(dir / "ntv/ntu-1p/dataset.json"),
              "; there is no " + at + "ntv, did you mean " + at + "ntu?");
    EXPECT_EQ(did_you_mean(dir / "egnerated.h5"), "; did you mean " + at + "generated.h5?") << "at the front";
    EXPECT_EQ(did_you_mean(dir / "recogniser"), "") << "nothing is called like it";
    EXPECT_EQ(did_you_mean(dir / "mad"), "") << "two of three letters are others";
    EXPECT_EQ(did_you_mean(""), "");
}
