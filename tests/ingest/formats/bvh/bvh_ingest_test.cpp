// BVH files through the whole pipeline: which clips, classes and remarks come of doubtful ones, and how tall the dataset is.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "ingest/dataset/height.hpp"
#include "ingest/formats/bvh/bvh_format.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest {
namespace {

/// Someone 160 units tall who walks along x.
std::string person(const std::string& frames = "0 0 0 0\n1 0 0 0\n2 0 0 0\n") {
    return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 4 Xposition Yposition Zposition Yrotation\n"
           "JOINT Spine\n{\nOFFSET 0 50 0\nJOINT Head\n{\nOFFSET 0 30 0\n}\n}\n"
           "JOINT Leg\n{\nOFFSET 10 -40 0\nJOINT Foot\n{\nOFFSET 0 -40 0\n}\n}\n}\n"
           "MOTION\nFrames: 3\nFrame Time: 0.1\n" +
           frames;
}

class BvhIngest : public ::testing::Test {
  protected:
    IngestSummary ingest(BvhOptions options) {
        options.dataset = "out";
        BvhFormat format(std::move(options));
        IngestRequest request;
        request.raw = {dir_ / "raw"};
        request.out = dir_ / "out";
        request.one_dataset = true;
        request.threads = 1;
        kernels::Device device;
        return actformer::ingest::ingest(request, format, device);
    }

    void write(const std::string& file, const std::string& text) {
        test::write_file(dir_ / "raw" / file, text);
    }

    test::TempDir dir_;
};

TEST_F(BvhIngest, AClassWhoseFilesAreBrokenIsNone) {
    write("jump_1.bvh", person());
    write("run_1.bvh", person("0 0 0 0\n1 0 0\n2 0 0 0\n"));
    write("walk_1.bvh", person());
    BvhOptions options;
    options.pattern = "{action}_{index}";
    const auto summary = ingest(options);
    const Dataset dataset(dir_ / "out");
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"jump", "walk"}));
    EXPECT_EQ(dataset.clips()[1].label, 1U);
    EXPECT_EQ(summary.left_out.at("broken"), 1U);
    EXPECT_EQ(summary.remarks.back(), "no clip was left of run: it is not among the classes");
    EXPECT_EQ(summary.remarks.front(), "root 'Hips', 5 joints");
    EXPECT_EQ(verify_dataset(dir_ / "out").faults, std::vector<std::string>{});
}

TEST_F(BvhIngest, FilesOfOneNameInSeveralFoldersAreClips) {
    for (const char* file : {"run/001.bvh", "run/002.bvh", "walk/001.bvh", "walk/002.bvh"})
        write(file, person());
    BvhOptions options;
    options.pattern = "{action}/{index}";
    ingest(options);
    const Dataset dataset(dir_ / "out");
    ASSERT_EQ(dataset.clips().size(), 4U);
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"run", "walk"}));
    EXPECT_TRUE(dataset.find("walk_001").has_value());
}

TEST_F(BvhIngest, DoubtsAreCountedWithTheFirstFewClips) {
    for (int i = 1; i < 6; ++i)
        write(fmt::format("walk_{}.bvh", i), person("-900 0 0 0\n1 0 0 0\n2 0 0 0\n"));
    BvhOptions options;
    options.pattern = "{action}_{index}";
    const auto summary = ingest(options);
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_NE(summary.doubts[0].what.find("--skip-first 1"), std::string::npos);
    EXPECT_EQ(summary.doubts[0].clips, 5U);
    EXPECT_EQ(summary.doubts[0].first.front(), "walk_1");
}

TEST_F(BvhIngest, TheHeightOfADatasetIsSeenInIt) {
    write("walk_1.bvh", person());
    BvhOptions options;
    options.pattern = "{action}_{index}";
    ingest(options);
    const auto height = body_height(Dataset(dir_ / "out"));
    ASSERT_TRUE(height.has_value());
    EXPECT_NEAR(height->metres, 1.6, 1e-3);  // limbs are short by 1e-4 of their length
    EXPECT_EQ(height->axis, 'y');
    std::filesystem::remove_all(dir_ / "out");
    options.up = "z";  // which it is not
    ingest(options);
    EXPECT_EQ(body_height(Dataset(dir_ / "out"))->axis, 'z');
}

}  // namespace
}  // namespace actformer::ingest
