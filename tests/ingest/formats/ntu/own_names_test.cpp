// .skeleton files with names other than NTU's: a pattern or a table of labels tells their clips, and one dataset comes of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "ingest/formats/ntu/ntu_command.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "tests/support/skeleton_text.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest {
namespace {

class OwnNamesIngest : public ::testing::Test {
  protected:
    IngestSummary ingest(const NtuCommand& command, const std::string& out = "falls") {
        const auto format = command.open(out);
        IngestRequest request;
        request.raw = {dir_ / "raw"};
        request.out = dir_ / out;
        request.one_dataset = command.one_dataset();
        request.threads = 2;
        kernels::Device device;
        return actformer::ingest::ingest(request, *format, device);
    }

    /// The message of the Error that `command` ends in.
    std::string refusal(const NtuCommand& command) {
        try {
            ingest(command);
        } catch (const Error& error) {
            return error.what();
        }
        return "none";
    }

    void write(const std::string& file, const std::string& text) {
        test::write_file(dir_ / "raw" / file, text);
    }

    test::TempDir dir_;
};

NtuCommand named(const std::string& pattern) {
    NtuCommand command;
    command.own.pattern = pattern;
    return command;
}

std::string two_bodies(int frames) {
    return test::skeleton_text(frames, {test::always_seen("7", test::random_motion(frames, 1)),
                                        test::always_seen("8", test::random_motion(frames, 2))});
}

TEST_F(OwnNamesIngest, FoldersTellActionsAndFieldsMakeSplits) {
    write("walk/ann_1.skeleton", test::plain_clip(20, 1));
    write("fall/ann_1.skeleton", test::plain_clip(21, 2));
    write("fall/bob_2.skeleton", test::plain_clip(22, 3));
    auto command = named("{action}/{performer}_{*}");
    command.splits = {"test=performer:bob"};
    ingest(command);
    const Dataset dataset(dir_ / "falls");
    EXPECT_EQ(dataset.header().name, "falls");
    EXPECT_EQ(dataset.header().persons, 1U);
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"fall", "walk"}));
    EXPECT_EQ(dataset.header().topology.parents, ntu25().parents);
    ASSERT_EQ(dataset.clips().size(), 3U);
    EXPECT_EQ(dataset.clips()[*dataset.find("fall_ann_1")].frames, 21U);
    EXPECT_EQ(dataset.clips()[*dataset.find("walk_ann_1")].label, 1U);
    EXPECT_EQ(dataset.split("test"), std::vector<std::size_t>{dataset.find("fall_bob_2").value()});
    EXPECT_TRUE(verify_dataset(dir_ / "falls").faults.empty());
}

TEST_F(OwnNamesIngest, AClipIsTheSameWhateverItsName) {
    write("S001C001P001R001A001.skeleton", test::plain_clip(30, 4));
    ingest(NtuCommand(), "ntu");
    ingest(named("{*}A{action}"), "own");
    const Dataset ntu(dir_ / "ntu/ntu-1p"), own(dir_ / "own");
    EXPECT_EQ(ntu.motion(0).values, own.motion(0).values);
    EXPECT_EQ(ntu.bone_length(0), own.bone_length(0));
    EXPECT_EQ(own.header().classes, std::vector<std::string>{"001"});
    EXPECT_EQ(ntu.header().classes.size(), 94U);
}

TEST_F(OwnNamesIngest, PersonsAreAsManyAsAskedFor) {
    write("hug_1.skeleton", two_bodies(20));
    write("hug_2.skeleton", test::plain_clip());
    auto command = named("{action}_{index}");
    command.own.persons = 2;
    const auto summary = ingest(command);
    EXPECT_EQ(Dataset(dir_ / "falls").header().persons, 2U);
    EXPECT_EQ(summary.left_out.at("dropped"), 1U);
    command.own.persons = 0;
    ingest(command, "one");
    EXPECT_EQ(Dataset(dir_ / "one").clips().size(), 2U);
}

TEST_F(OwnNamesIngest, LabelsCutAFileAndTellFields) {
    write("take.skeleton", test::plain_clip(40, 5));
    test::write_file(dir_ / "labels.csv",
                     "file,action,side,start_frame,end_frame\ntake,sit,left,0,25\ntake,stand,right,25,\n"
                     "take,lost,left,50,60\ngone,sit,left,,\n");
    NtuCommand command;
    command.own.labels = (dir_ / "labels.csv").string();
    const auto summary = ingest(command);
    const Dataset dataset(dir_ / "falls");
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"sit", "stand"})) << "lost has no clip";
    ASSERT_EQ(dataset.clips().size(), 2U);
    EXPECT_EQ(dataset.clips()[*dataset.find("take_0-25")].frames, 25U);
    EXPECT_EQ(dataset.clips()[*dataset.find("take_25-end")].frames, 15U);
    EXPECT_EQ(summary.left_out.at("broken"), 1U);
    EXPECT_NE(summary.first_rejections[0].find("clip take_50-60: no frame is left of 40"), std::string::npos)
        << summary.first_rejections[0];
    EXPECT_NE(summary.remarks[0].find("1 of 4 rows are for files that are not there: gone"),
              std::string::npos)
        << summary.remarks[0];
}

TEST_F(OwnNamesIngest, ABodyLeftOutForAJointThatIsNeverSeenIsSaid) {
    auto headless = test::random_motion(20, 1);
    for (auto& pose : headless) pose[3] = {0, 0, 0};
    const auto body = test::always_seen("1", headless);
    write("walk_1.skeleton",
          test::skeleton_text(20, {body, test::always_seen("2", test::random_motion(20, 2))}));
    write("walk_2.skeleton", test::skeleton_text(20, {body}));
    NtuCommand command;
    command.own.pattern = "{action}_{index}";
    const auto summary = ingest(command);
    const std::string said = "a body whose 'head' is never seen is left out";
    ASSERT_EQ(Dataset(dir_ / "falls").clips().size(), 1U);
    const auto doubt = std::find_if(summary.doubts.begin(), summary.doubts.end(),
                                    [&](const auto& one) { return one.what == said; });
    ASSERT_NE(doubt, summary.doubts.end());
    EXPECT_EQ(doubt->first, std::vector<std::string>{"walk_1"});
    EXPECT_NE(summary.first_rejections.at(0).find("no body in any frame; " + said), std::string::npos)
        << summary.first_rejections[0];
}

TEST_F(OwnNamesIngest, PersonsWhoDoNotMoveOrAreHardlySeenAreSaid) {
    constexpr std::size_t frames = 20;
    const auto moving = test::always_seen("1", test::random_motion(frames, 1)),
               still =
                   test::always_seen("2", std::vector<test::Pose>(frames, test::random_motion(1, 2).front()));
    const auto seen_in = [&](std::size_t some) {
        auto body = test::always_seen("2", test::random_motion(frames, 3));
        for (auto t = some; t < frames; ++t) body.frames[t] = std::nullopt;
        return body;
    };
    write("hug_1.skeleton", test::skeleton_text(frames, {moving, still}));
    write("hug_2.skeleton", test::skeleton_text(frames, {moving, seen_in(9)}));
    write("hug_3.skeleton", test::skeleton_text(frames, {moving, seen_in(10)}));
    auto also_still = still;
    also_still.id = "3";
    write("hug_4.skeleton", test::skeleton_text(frames, {still, also_still}));
    auto command = named("{action}_{index}");
    command.own.persons = 2;
    std::map<std::string, std::vector<std::string>> said;
    for (const auto& doubt : ingest(command).doubts) said[doubt.what] = doubt.first;
    EXPECT_EQ(
        said,
        (std::map<std::string, std::vector<std::string>>{
            {"nothing moves", {"hug_4"}},
            {"person 2 does not move", {"hug_1"}},
            {"persons seen in less than half of the frames: filled from the frames around", {"hug_2"}}}));
}

TEST_F(OwnNamesIngest, ALabelThatEndsBehindTheFileIsCutOffThereAndSaysSo) {
    write("take.skeleton", test::plain_clip(40, 5));
    test::write_file(dir_ / "labels.csv",
                     "file,action,start_frame,end_frame\ntake,sit,0,40\ntake,rise,30,41\n");
    NtuCommand command;
    command.own.labels = (dir_ / "labels.csv").string();
    const auto summary = ingest(command);
    const Dataset dataset(dir_ / "falls");
    EXPECT_EQ(dataset.clips()[*dataset.find("take_30-41")].frames, 10U);
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_EQ(summary.doubts[0].what, "the label ends behind the motion: cut off there");
    EXPECT_EQ(summary.doubts[0].first, std::vector<std::string>{"take_30-41"});
}

TEST_F(OwnNamesIngest, ACutShowsWhatTheFramesShow) {
    // The first body is seen in frames 0-9 alone, the second from frame 10 on: each cut has one body, and its own frames.
    auto first = test::always_seen("7", test::random_motion(30, 6)),
         second = test::always_seen("8", test::random_motion(30, 7));
    for (int t = 0; t < 30; ++t) (t < 10 ? second : first).frames[t] = std::nullopt;
    write("take.skeleton", test::skeleton_text(30, {first, second}));
    auto late = second;
    late.frames.erase(late.frames.begin(), late.frames.begin() + 12);
    write("late.skeleton", test::skeleton_text(18, {late}));
    test::write_file(dir_ / "labels.csv",
                     "file,action,start_frame,end_frame\ntake,a,0,12\ntake,a,12,\nlate,a,,\n");
    NtuCommand command;
    command.own.labels = (dir_ / "labels.csv").string();
    ingest(command);
    const Dataset dataset(dir_ / "falls");
    const auto cut = dataset.motion(*dataset.find("take_12-end")),
               alone = dataset.motion(*dataset.find("late"));
    ASSERT_EQ(cut.values.size(), alone.values.size());
    for (std::size_t i = 0; i < cut.values.size(); ++i)
        ASSERT_NEAR(cut.values[i], alone.values[i], 1e-5)
            << i;  // their origins differ, so float32 rounds otherwise
}

TEST_F(OwnNamesIngest, RefusesWhatMakesNoSense) {
    write("walk_1.skeleton", test::plain_clip());
    NtuCommand plain;
    plain.own.persons = 2;
    EXPECT_NE(refusal(plain).find("--persons goes with --name or --labels"), std::string::npos);
    plain.own.persons = 0;
    plain.splits = {"a=action:walk"};
    EXPECT_NE(refusal(plain).find("--split goes with --name or --labels"), std::string::npos);
    EXPECT_NE(refusal(NtuCommand()).find("--name or --labels takes other names"), std::string::npos);
    EXPECT_NE(refusal(named("{index}")).find("it has no {action}"), std::string::npos);
    EXPECT_NE(refusal(named("{action}-{index}")).find("no file name fits the pattern"), std::string::npos);
    EXPECT_NE(refusal(named("{action}_{person}")).find("shows all its persons"), std::string::npos);
    auto command = named("{action}_{index}");
    command.splits = {"a=stile:x"};
    EXPECT_NE(refusal(command).find("split a: clips have no field 'stile'; they have action, index"),
              std::string::npos);
    command.splits.clear();
    command.own.persons = 101;
    EXPECT_NE(refusal(command).find("101 persons a clip are too many"), std::string::npos);
    command.own.persons = 3;
    EXPECT_NE(refusal(command).find("none of 1 file gave a clip"), std::string::npos) << refusal(command);
}

}  // namespace
}  // namespace actformer::ingest
