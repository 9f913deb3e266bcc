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
std::string one_person(const std::string& frames = "0 0 0 0\n1 0 0 0\n2 0 0 0\n") {
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
    write("jump_1.bvh", one_person());
    write("run_1.bvh", one_person("0 0 0 0\n1 0 0\n2 0 0 0\n"));
    write("walk_1.bvh", one_person());
    BvhOptions options;
    options.pattern = "{action}_{index}";
    const auto summary = ingest(options);
    const Dataset dataset(dir_ / "out");
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"jump", "walk"}));
    EXPECT_EQ(dataset.clips()[1].label, 1U);
    EXPECT_EQ(summary.left_out.at("broken"), 1U);
    EXPECT_EQ(summary.remarks.back(), "no clip was left of run: it is not among the classes");
    EXPECT_EQ(summary.remarks.front(), "root 'Hips', 5 joints");
    EXPECT_EQ(dataset.remarks(), summary.remarks);
    EXPECT_EQ(verify_dataset(dir_ / "out").faults, std::vector<std::string>{});
}

TEST_F(BvhIngest, FilesOfOneNameInSeveralFoldersAreClips) {
    for (const char* file : {"run/001.bvh", "run/002.bvh", "walk/001.bvh", "walk/002.bvh"})
        write(file, one_person());
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
        write(fmt::format("{}_{}.bvh", i < 5 ? "walk" : "weep", i),
              one_person("-900 0 0 0\n1 0 0 0\n2 0 0 0\n"));
    BvhOptions options;
    options.pattern = "{action}_{index}";
    const auto summary = ingest(options);
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_NE(summary.doubts[0].what.find("--skip-first 1"), std::string::npos);
    EXPECT_EQ(summary.doubts[0].clips, 5U);
    EXPECT_EQ(summary.doubts[0].first.front(), "walk_1");
    EXPECT_EQ(
        Dataset(dir_ / "out").remarks(),
        (std::vector<std::string>{
            "root 'Hips', 5 joints",
            "5 clips: the first frame is a jump, as from a reference pose; --skip-first 1 leaves it out "
            "(walk_1, walk_2, walk_3, ...)"}))
        << "the dataset keeps them";
}

TEST_F(BvhIngest, TheHeightOfADatasetIsSeenInIt) {
    write("walk_1.bvh", one_person());
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

/// Someone whose only leg is ten metres to the side: given in centimetres among metres.
std::string lopsided() {
    return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0.9 0\nCHANNELS 4 Xposition Yposition Zposition Zrotation\n"
           "JOINT Spine\n{\nOFFSET 0 0.4 0\nJOINT LeftArm\n{\nOFFSET 0.2 0.1 0\n}\n}\n"
           "JOINT LeftLeg\n{\nOFFSET 10 -0.4 0\nEnd Site\n{\nOFFSET 0 -0.45 0\n}\n}\n}\n"
           "MOTION\nFrames: 3\nFrame Time: 0.1\n0 0.9 0 1\n0.1 0.9 0 1\n0.2 0.9 0 1\n";
}

TEST_F(BvhIngest, ABoneToTheSideLaysNobodyDown) {
    write("walk_1.bvh", lopsided());
    write("wave_1.bvh", lopsided());
    BvhOptions options;
    options.pattern = "{action}_{index}";
    const auto small = ingest(options);
    ASSERT_EQ(small.remarks.size(), 2U) << fmt::format("{}", fmt::join(small.remarks, "; "));
    EXPECT_NE(small.remarks[1].find("1.2 cm tall at 0.01 metres a unit; --scale 1 would make it 1.18 m"),
              std::string::npos)
        << small.remarks[1];  // 0.5 + 0.85, less 10 sin 1 deg by which the leg is raised
    std::filesystem::remove_all(dir_ / "out");
    options.scale = "auto";
    const auto found = ingest(options);
    EXPECT_NE(found.remarks[1].find("scale 1: a body is about 1.18 m"), std::string::npos)
        << found.remarks[1];
    const auto height = body_height(Dataset(dir_ / "out"));
    EXPECT_EQ(height->axis, 'y') << "though it is 10 m wide";
    EXPECT_NEAR(height->metres, 0.73, 0.01);  // from the arm to the leg's top: end sites are none
}

}  // namespace
}  // namespace actformer::ingest
