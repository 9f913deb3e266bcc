#include "eval/weights_writer.hpp"

#include <gtest/gtest.h>

#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;

namespace {

struct Written {
    test::TempDir folder;
    std::filesystem::path path = folder / "w.h5";

    Written(const std::string& kind, const eval::RecogniserAttributes& about,
            std::optional<std::uint32_t> center) {
        hdf5::Writer file(path);
        write_recogniser_attributes(file, kind, about, center);
        file.finish();
    }
};

const eval::RecogniserAttributes about{6, 2, {-1, 0, 1}, ingest::Representation::limb, {"walk", "jump"}};

}  // namespace

TEST(RecogniserAttributes, ComeBackAsTheyWereWritten) {
    const Written written("stgcn", about, 1);
    const hdf5::Reader file(written.path);
    const auto back = eval::read_attributes(file, "w.h5");
    EXPECT_EQ(back.channels, about.channels);
    EXPECT_EQ(back.classes, about.classes);
    EXPECT_EQ(back.parents, about.parents);
    EXPECT_EQ(back.representation, about.representation);
    EXPECT_EQ(back.class_names, about.class_names);
    EXPECT_EQ(file.attribute_texts("kind"), std::vector<std::string>{"stgcn"});
    EXPECT_EQ(eval::one_number(file, "w.h5", "center", 0, 2), 1U);
}

TEST(RecogniserAttributes, LeaveOutWhatIsNotKnown) {
    auto nameless = about;
    nameless.class_names.clear();
    const Written written("gru", nameless, {});
    const hdf5::Reader file(written.path);
    EXPECT_FALSE(file.has_attribute("class_names"));
    EXPECT_FALSE(file.has_attribute("center"));
}
