// What `actformer ingest bvh` says of names, classes and splits.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ingest/dataset/dataset.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer::test;

namespace {

/// Four clips in one folder: walk_01_1, walk_02_2, sit_01_3, sit_02_4.
struct IngestBvh : testing::Test {
    void SetUp() override {
        int i = 0;
        for (const auto* name : {"walk_01_1", "walk_02_2", "sit_01_3", "sit_02_4"})
            write_file(dir / "caps" / (std::string(name) + ".bvh"), toy_clip(i % 3, i)), ++i;
    }
    CommandResult ingest(const std::string& options) const {
        return run_actformer("ingest bvh " + at("caps") + " -o " + at("out") + " " + options);
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }
    TempDir dir;
};

void says(const CommandResult& result, const std::string& words) {
    EXPECT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find(words), std::string::npos) << result.output;
}

}  // namespace

TEST_F(IngestBvh, DoubtsOneClassAlone) {
    says(ingest("--name '{action}/{index}'"),
         "all clips are of one class, 'caps', a folder's name by the {action} of --name '{action}/{index}'; "
         "where the files' own names tell the action, give --name '{action}_{index}'");
    std::filesystem::remove_all(dir / "out");
    const auto asked = ingest("--name '{*}_{action}_{index}' --classes 01");
    says(asked, "of 1 class ");
    EXPECT_EQ(asked.output.find("one class"), std::string::npos) << asked.output;
    std::filesystem::remove_all(dir / "out");
    const auto two = ingest("--name '{action}_{index}'");
    says(two, "of 2 classes");
    EXPECT_EQ(two.output.find("one class"), std::string::npos) << two.output;
}

TEST_F(IngestBvh, ADatasetInTheFolderOneIsInHasItsName) {
    std::filesystem::create_directories(dir / "here");
    const auto made = run_command("cd " + at("here") + " && " + program() +
                                  " ingest bvh ../caps/ --name '{action}_{index}' -o .");
    EXPECT_EQ(made.exit, 0) << made.output;
    EXPECT_EQ(actformer::ingest::Dataset(dir / "here").header().name, "here");
}

TEST_F(IngestBvh, NamesThatAreNoUtf8AreShownByTheirBytes) {
    write_file(dir / "caps/r\xFFn_01_5.bvh", toy_clip(1, 5));
    const auto made = run_actformer("ingest bvh " + at("caps") + " -o " + at("o\xFFt") +
                                    " --name '{action}_{subject}_{index}' --split 'tr\xFF=action:r\xFFn' "
                                    "--classes 'r\xFFn,walk,s\xFF' --json 2>/dev/null");
    ASSERT_EQ(made.exit, 0) << made.output;
    EXPECT_EQ(nlohmann::json::parse(made.output)["out"], at("o\\xFFt"));
    const actformer::ingest::Dataset dataset(dir / "o\xFFt");
    EXPECT_EQ(dataset.header().name, "o\\xFFt");
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"r\\xFFn", "walk", "s\\xFF"}));
    EXPECT_EQ(dataset.split("tr\\xFF").size(), 1U);
}

TEST_F(IngestBvh, DoubtsASplitWithoutAClip) {
    const auto result = ingest(
        "--name '{action}_{subject}_{index}' --split train=subject:01 --split 'test=subject:99' "
        "--split 'rest=subject!:01,02' --split 'both=subject:01;index:2'");
    says(result, "clips of splits: train 2, test 0, rest 0, both 0\n");
    says(result, "split test has no clip: none has subject 99; there are 01, 02\n");
    says(result, "split rest has no clip: all have subject 01, 02\n");
    says(result, "split both has no clip: none meets all its conditions\n");
    EXPECT_EQ(result.output.find("split train has"), std::string::npos) << result.output;
}

TEST_F(IngestBvh, ASplitThatIsNotThereComesWithTheRemedy) {
    says(ingest("--name '{action}_{subject}_{index}' --split train=subject:01"), "train 2");
    expect_refused(run_actformer("export " + at("out") + " -o " + at("x.h5") + " --split nowhere"),
                   {"no split 'nowhere'; there is all, train", "--split NAME=FIELD:VALUE"});
    if (!std::filesystem::exists(program() + "-train")) GTEST_SKIP() << "built without libtorch";
    for (const auto* network : {"generator -c actformer-small", "recogniser -c recogniser-small"}) {
        const auto refused = run_actformer("train " + std::string(network) + " --data " + at("out") + " -o " +
                                           at("run") + " train_split=nowhere");
        EXPECT_EQ(refused.exit, 1);
        EXPECT_NE(
            refused.output.find("no split 'nowhere'; there is all, train; give train_split=all, or ingest"),
            std::string::npos)
            << refused.output;
    }
}
