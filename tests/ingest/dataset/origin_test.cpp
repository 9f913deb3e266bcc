#include "ingest/dataset/origin.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;

namespace {

DatasetFile file_of(const DataOrigin& origin) {
    DatasetFile file;
    file.header.name = "x";
    file.header.topology = ntu25();
    file.header.origin = origin;
    return file;
}

}  // namespace

TEST(DataOrigin, IsSaidInCaptions) {
    using enum DataOrigin::Kind;
    EXPECT_EQ((DataOrigin{}.text()), "");
    EXPECT_EQ((DataOrigin{recorded, ""}.text()), "recorded");
    EXPECT_EQ((DataOrigin{stand_in, "generic"}.text()), "stand-in, generic skeleton");
    EXPECT_EQ((DataOrigin{synthetic, "SMPL_NEUTRAL.pkl"}.text()), "synthetic, skeleton of SMPL_NEUTRAL.pkl");
    EXPECT_EQ((DataOrigin{{}, "generic"}.text()), "generic skeleton");
    EXPECT_EQ((DataOrigin{stand_in, "generic", "20 categories"}.text()),
              "stand-in, generic skeleton, 20 categories");
}

TEST(DataOrigin, StandsInDatasetJsonWhereItIsTold) {
    const TempDir dir;
    using enum DataOrigin::Kind;
    for (const auto& origin :
         {DataOrigin{}, DataOrigin{recorded, ""}, DataOrigin{stand_in, "generic"},
          DataOrigin{synthetic, "a.pkl"}, DataOrigin{{}, "generic"}, DataOrigin{{}, "", "20 categories"}}) {
        const auto text = to_text(file_of(origin));
        EXPECT_EQ(text.find("\"origin\"") == std::string::npos, origin == DataOrigin{});
        write_file(dir / "dataset.json", text);
        EXPECT_EQ(read_dataset_json(dir / "dataset.json").header.origin, origin);
    }
    auto text = to_text(file_of({recorded, ""}));
    text.replace(text.find("recorded"), 8, "invented");
    text.replace(text.find("\"checksum\""), 10, "\"none\"");
    text.replace(text.find("\"program\""), 9, "\"nobody\"");
    write_file(dir / "dataset.json", text);
    try {
        read_dataset_json(dir / "dataset.json");
        FAIL() << "taken";
    } catch (const Error& e) {
        EXPECT_EQ(std::string(e.what()), (dir / "dataset.json").string() +
                                             ": origin 'invented' is none of recorded, synthetic, stand-in");
    }
}

TEST(DataOrigin, StandsBesideRawData) {
    const TempDir dir;
    EXPECT_EQ(read_origin(dir.path()), std::nullopt);
    EXPECT_EQ(read_origin(dir / "raw.zip"), std::nullopt);
    write_origin(dir.path(), DataOrigin::Kind::stand_in);
    EXPECT_EQ(read_origin(dir.path()), DataOrigin::Kind::stand_in);
    write_file(dir / "ORIGIN", "synthetic\r\nas the game makes it");
    EXPECT_EQ(read_origin(dir.path()), DataOrigin::Kind::synthetic);
    write_file(dir / "ORIGIN", "a game");
    EXPECT_THROW(read_origin(dir.path()), Error);
}
