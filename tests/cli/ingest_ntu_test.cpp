// `actformer ingest ntu`, `inspect` and `export` as their users meet them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/mount.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/skeleton_text.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;
using actformer::ingest::Dataset;
using actformer::ingest::MotionsFile;
namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> tree(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[entry.path().lexically_relative(folder)] = read_file(entry.path());
    return files;
}

struct IngestNtu : testing::Test {
    void clip(const std::string& name, const std::string& text) {
        write_file(dir / ("raw/" + name + ".skeleton"), text);
    }

    CommandResult ingest(const std::string& more = "") {
        return run_actformer("ingest ntu " + raw() + " -o " + out() + " " + more);
    }
    std::string raw() const { return (dir / "raw").string(); }
    std::string out() const { return (dir / "out").string(); }

    /// exit 1 with one line that names every one of `words`, and nothing left behind.
    void expect_refused(const CommandResult& result, const std::vector<std::string>& words) {
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto& word : words)
            EXPECT_NE(result.output.find(word), std::string::npos) << word << ": " << result.output;
        EXPECT_FALSE(fs::exists(out()));
        EXPECT_FALSE(fs::exists(out() + ".partial"));
    }

    TempDir dir;
};

/// The motion as a body, unseen in the frames listed.
SeenBody with_gaps(const std::string& id, const std::vector<Pose>& motion, const std::vector<int>& unseen) {
    auto body = always_seen(id, motion);
    for (const int t : unseen) body.frames[t] = std::nullopt;
    return body;
}

}  // namespace

TEST_F(IngestNtu, AgreesWithTheReferenceOnHardClips) {
    if (!has_reference_python()) GTEST_SKIP() << "the reference programs or their Python modules are absent";
    const auto a = random_motion(40, 1), b = random_motion(40, 2), c = random_motion(40, 3);
    clip("S001C001P001R001A001",
         skeleton_text(40, {with_gaps("a", a, {0, 1, 2, 10, 17, 18, 19, 20, 38, 39})}));
    clip("S002C001P001R001A002",
         skeleton_text(40, {with_gaps("ghost", b, {0, 1, 2, 3, 4, 5}), always_seen("a", a)}));
    clip("S001C002P001R001A061", skeleton_text(40, {with_gaps("first", a, {3}), with_gaps("tied", b, {5})}));
    clip("S001C001P003R001A003", skeleton_text(1, {always_seen("short", random_motion(1, 4))}));
    clip("S001C001P003R001A004", skeleton_text(5, {always_seen("short", random_motion(5, 5))}));
    clip("S001C001P003R001A005", skeleton_text(3, {with_gaps("once", random_motion(3, 6), {0, 2})}));
    clip("S001C001P001R001A050", skeleton_text(40, {always_seen("a", a), with_gaps("b", b, {0, 7, 8, 39})}));
    clip("S001C001P001R002A060",
         skeleton_text(40, {with_gaps("c", c, {1, 2, 3, 4}), always_seen("a", a), with_gaps("b", b, {9})}));
    clip("S001C001P001R001A106",
         skeleton_text(40, {with_gaps("b", b, {20}), with_gaps("a", a, {21}), with_gaps("c", c, {22})}));
    clip("S001C001P001R001A120", skeleton_text(40, {always_seen("alone", a)}));  // too few persons
    std::string folders = raw();
    if (fs::exists(shared("data/ntu_sample")))
        fs::copy(shared("data/ntu_sample"), dir / "raw",
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);

    ASSERT_EQ(ingest().exit, 0);
    for (const int persons : {1, 2}) {
        const auto name = fmt::format("{}p", persons), ours = (dir / name).string() + ".h5";
        ASSERT_EQ(run_actformer("export " + out() + "/ntu-" + name + " -o " + ours).exit, 0);
        const auto oracle = (dir / name).string() + "-oracle.h5";
        ASSERT_EQ(run_command(fmt::format("/usr/bin/python3 {} {} {} --persons {}",
                                          shared("reference/preprocess.py"), folders, oracle, persons))
                      .exit,
                  0);
        const MotionsFile mine(ours), theirs(oracle);
        ASSERT_EQ(mine.names(), theirs.names());
        for (const auto& clip : mine.names()) {
            const auto x = mine.read(clip), y = theirs.read(clip);
            ASSERT_EQ(x.frames, y.frames);
            ASSERT_EQ(x.persons, static_cast<unsigned>(persons));
            for (std::size_t i = 0; i < x.values.size(); ++i)
                ASSERT_NEAR(x.values[i], y.values[i], 1e-5) << clip << " " << i;
        }
    }
}

TEST_F(IngestNtu, RenumbersAndLabelsBothFamilies) {
    const std::map<std::string, std::pair<std::string, std::string>> expected{
        {"A001", {"A001", "ntu-1p"}}, {"A049", {"A049", "ntu-1p"}}, {"A061", {"A050", "ntu-1p"}},
        {"A105", {"A094", "ntu-1p"}}, {"A050", {"A001", "ntu-2p"}}, {"A060", {"A011", "ntu-2p"}},
        {"A106", {"A012", "ntu-2p"}}, {"A120", {"A026", "ntu-2p"}}};
    const auto a = random_motion(3, 1), b = random_motion(3, 2);
    for (const auto& [action, unused] : expected)
        clip("S001C001P001R001" + action, skeleton_text(3, {always_seen("a", a), always_seen("b", b)}));
    ASSERT_EQ(ingest().exit, 0);
    for (const auto& [action, renumbered] : expected) {
        const Dataset dataset(fs::path(out()) / renumbered.second);
        const auto found = dataset.find("S001C001P001R001" + action);
        ASSERT_TRUE(found) << action;
        const auto& clip = dataset.clips()[*found];
        EXPECT_EQ(actformer::ingest::public_name(clip.name, clip.label), "S001C001P001R001" + renumbered.first);
        EXPECT_EQ(clip.label + 1, std::stoul(renumbered.first.substr(1)));
    }
    EXPECT_EQ(Dataset(fs::path(out()) / "ntu-1p").header().classes.size(), 94U);
    EXPECT_EQ(Dataset(fs::path(out()) / "ntu-2p").header().classes.size(), 26U);
}

TEST_F(IngestNtu, DrawsABodyBackFromLimbsAndBoneLengths) {
    auto motion = random_motion(30, 1);
    for (auto& pose : motion) pose = motion[0];  // a body that stands still keeps its bone lengths
    clip("S001C001P001R001A001", skeleton_text(30, {always_seen("a", motion)}));
    ASSERT_EQ(ingest().exit, 0);
    const Dataset dataset(fs::path(out()) / "ntu-1p");
    const auto joints = joint_positions(dataset.motion(0), dataset.body(0));
    for (std::size_t j = 0; j < 25; ++j)
        for (std::size_t d = 0; d < 3; ++d)  // unit limbs are short by 1e-4 m of their length
            EXPECT_NEAR(joints[j * 3 + d] - joints[d], motion[0][j][d] - motion[0][0][d], 1e-3);
}

TEST_F(IngestNtu, SkipsBadClipsAndNamesThem) {
    const auto good = plain_clip();
    clip("S001C001P001R001A001", good);
    clip("S001C001P001R001A002", good.substr(0, good.size() / 2));
    clip("S001C001P001R001A003", "-1\n");
    clip("S001C001P001R001A004", "1000000000000000\n1\n");
    clip("S001C001P001R001A005", "2\n0\n0\n");
    clip("S001C001P001R001A006", "");
    clip("S001C001P001R001A007", std::string(1000, '\0'));
    clip("S001C001P001R001A050", good);
    clip("S001C001P001R001A008", good);
    clip("walking", good);
    clip("again/S001C001P001R001A001", good);
    fs::create_symlink(dir / "gone", dir / "raw/S001C001P001R001A009.skeleton");
    write_file(dir / "missing.txt", "header\nS001C001P001R001A008\n");

    const auto result = ingest("--missing " + (dir / "missing.txt").string());
    ASSERT_EQ(result.exit, 0) << result.output;
    const Dataset dataset(fs::path(out()) / "ntu-1p");
    ASSERT_EQ(dataset.clips().size(), 1U);
    EXPECT_FALSE(fs::exists(out() + "/ntu-2p")) << "no empty dataset";
    const auto csv = read_file(fs::path(out()) / "rejected.csv");
    for (const std::string row :
         {"A002.skeleton,broken,\"line", "A003.skeleton,broken,line 1: '-1'",
          "A004.skeleton,broken,\"line 1: 1000000000000000", "A005.skeleton,broken,no body in any frame",
          "A006.skeleton,broken,an empty file", "A007.skeleton,broken,line 1: '",
          "A050.skeleton,dropped,1 of 2 persons seen", "A008.skeleton,missing,",
          "walking.skeleton,broken,the name is not SsssCcccPpppRrrrAaaa",
          "A001.skeleton,duplicate,a clip of this name came before",
          "A009.skeleton,broken,cannot be read: No such file"})
        EXPECT_NE(csv.find(row), std::string::npos) << row << " in\n" << csv;
    EXPECT_EQ(lines_in(csv), 12);
    EXPECT_NE(result.output.find("8 files broken"), std::string::npos) << result.output;
}

TEST_F(IngestNtu, StopsAtABadClipWhenStrict) {
    clip("S001C001P001R001A001", plain_clip());
    clip("S001C001P001R001A002", "nan\n");
    expect_refused(ingest("--strict"), {"S001C001P001R001A002.skeleton: line 1: 'nan'", "--strict"});
}

TEST_F(IngestNtu, RefusesWhatIsWiderThanAClip) {
    expect_refused(ingest(), {"raw: no such file or folder"});
    fs::create_directories(raw());
    expect_refused(ingest(), {"no .skeleton file there"});
    clip("S001C001P001R001A001", "nonsense");
    expect_refused(ingest(), {"none of 1 files gave a clip", "line 1: 'nonsense'"});
    clip("S001C001P001R001A001", plain_clip());
    expect_refused(ingest("--missing " + (dir / "none").string()), {"none: cannot be read"});
    expect_refused(ingest("--device no-such-thing"), {"--device no-such-thing: no such OpenCL device"});
    expect_refused(
        run_command("OCL_ICD_VENDORS=/nonexistent " + program() + " ingest ntu " + raw() + " -o " + out()),
        {"no OpenCL device", "pocl-opencl-icd"});
    write_file(dir / "broken.zip", "PK\x03\x04 and then nothing");
    expect_refused(run_actformer("ingest ntu " + (dir / "broken.zip").string() + " -o " + out()),
                   {"broken.zip"});
}

TEST_F(IngestNtu, LeavesAnythingElseThatIsThereAlone) {
    clip("S001C001P001R001A001", plain_clip());
    write_file(dir / "out/thesis.txt", "precious");
    const auto result = ingest();
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("already there"), std::string::npos) << result.output;
    EXPECT_EQ(read_file(dir / "out/thesis.txt"), "precious");
}

TEST_F(IngestNtu, FindsItsWorkDoneTheSecondTime) {
    clip("S001C001P001R001A001", plain_clip());
    ASSERT_EQ(ingest().exit, 0);
    const auto before = tree(out());
    const auto again = ingest();
    EXPECT_EQ(again.exit, 0);
    EXPECT_NE(again.output.find("complete already"), std::string::npos) << again.output;
    EXPECT_EQ(tree(out()), before);
    clip("S001C001P001R001A002", plain_clip());
    EXPECT_EQ(ingest().exit, 1) << "other raw data is another request";
}

TEST_F(IngestNtu, GivesTheSameFromAFolderAndFromAnArchive) {
    for (int a = 1; a <= 9; ++a) clip(fmt::format("S001C001P001R001A{:03}", a), plain_clip(20 + a, a));
    const auto tar = run_command("cd " + dir.path().string() + " && tar cJf raw.tar.xz --sort=name raw");
    ASSERT_EQ(tar.exit, 0) << tar.output;
    ASSERT_EQ(ingest().exit, 0);
    ASSERT_EQ(
        run_actformer("ingest ntu " + (dir / "raw.tar.xz").string() + " -o " + (dir / "tar").string()).exit,
        0);
    EXPECT_EQ(read_file(dir / "tar/ntu-1p/dataset.json"), read_file(dir / "out/ntu-1p/dataset.json"));
}

TEST_F(IngestNtu, EndsInTheSameBytesHoweverOftenItIsKilled) {
    // Enough text for three tranches, so that there is something to go on from.
    const auto text = plain_clip(200, 1);
    const auto two = skeleton_text(
        120, {always_seen("a", random_motion(120, 1)), always_seen("b", random_motion(120, 2))});
    write_file(dir / "one", text);
    write_file(dir / "two", two);
    fs::create_directories(raw());
    for (int i = 0; i < 9000; ++i)
        fs::create_hard_link(dir / (i % 5 == 0 ? "two" : "one"),
                             fmt::format("{}/S{:03}C001P{:03}R001A{:03}.skeleton", raw(), i / 1000 + 1,
                                         i / 10 % 100 + 1, 46 + i % 10));
    ASSERT_EQ(run_actformer("ingest ntu " + raw() + " -o " + (dir / "calm").string()).exit, 0);

    std::mt19937 random(20261122);
    int kills = 0;
    for (;;) {
        const auto seconds = 0.15 + 0.002 * static_cast<double>(random() % 300) + 0.05 * kills;
        const auto result = run_command(
            fmt::format("timeout -s KILL {} {} ingest ntu {} -o {}", seconds, program(), raw(), out()));
        if (result.exit == 0) break;
        ASSERT_EQ(result.exit, 137) << result.output;
        EXPECT_FALSE(fs::exists(out()) && !fs::exists(out() + "/ingest.json")) << "half an output";
        ASSERT_LT(++kills, 100);
    }
    EXPECT_GT(kills, 0);
    EXPECT_EQ(tree(out()), tree(dir / "calm"));
    EXPECT_FALSE(fs::exists(out() + ".partial"));
}

TEST_F(IngestNtu, StartsAfreshWhenTheRawDataChangedInBetween) {
    clip("S001C001P001R001A001", plain_clip());
    write_file(dir / "out.partial/journal", "a journal of something else\n{\"files\": 7}\n");
    write_file(dir / "out.partial/data/ntu-1p/shard-00000.h5", "left over");
    ASSERT_EQ(ingest().exit, 0);
    EXPECT_EQ(Dataset(fs::path(out()) / "ntu-1p").clips().size(), 1U);
}

TEST_F(IngestNtu, RefusesToShareItsOutputWithAnotherRun) {
    clip("S001C001P001R001A001", plain_clip());
    fs::create_directories(out() + ".partial");
    const int lock = open((out() + ".partial/lock").c_str(), O_CREAT | O_RDWR, 0666);
    ASSERT_EQ(flock(lock, LOCK_EX), 0);
    const auto result = ingest();
    close(lock);
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("another ingest is writing there"), std::string::npos) << result.output;
}

TEST_F(IngestNtu, SaysThatTheDiskIsFullAndLeavesNothing) {
    const auto text = plain_clip(100, 1);
    for (int i = 0; i < 200; ++i) clip(fmt::format("S001C001P{:03}R001A001", i), text);
    fs::create_directories(dir / "small");
    if (mount("none", (dir / "small").c_str(), "tmpfs", 0, "size=1m") != 0)
        GTEST_SKIP() << "no right to mount a small disk";
    const auto result = run_actformer("ingest ntu " + raw() + " -o " + (dir / "small/out").string());
    EXPECT_EQ(result.exit, 1);
    EXPECT_EQ(lines_in(result.output), 1) << result.output;
    EXPECT_NE(result.output.find("No space left on device"), std::string::npos) << result.output;
    EXPECT_TRUE(fs::is_empty(dir / "small"));

    ASSERT_EQ(ingest().exit, 0);
    const auto exported = run_actformer("export " + out() + "/ntu-1p -o " + (dir / "small/x.h5").string());
    EXPECT_EQ(exported.exit, 1);
    EXPECT_EQ(lines_in(exported.output), 1) << exported.output;
    EXPECT_TRUE(fs::is_empty(dir / "small"));
    umount((dir / "small").c_str());
}

TEST_F(IngestNtu, FindsFlippedBytes) {
    for (int a = 1; a <= 5; ++a) clip(fmt::format("S001C001P001R001A{:03}", a), plain_clip(60, a));
    ASSERT_EQ(ingest().exit, 0);
    ASSERT_EQ(run_actformer("inspect --verify " + out()).exit, 0);
    const auto shard = dir / "out/ntu-1p/shard-00000.h5";
    const auto whole = read_file(shard);
    std::mt19937 random(5);
    for (int round = 0; round < 40; ++round) {
        auto bytes = whole;
        bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
        write_file(shard, bytes);
        const auto result = run_actformer("inspect --verify " + out());
        EXPECT_EQ(result.exit, 1);
        EXPECT_NE(result.output.find("shard-00000.h5"), std::string::npos) << result.output;
        EXPECT_LT(run_actformer("export " + out() + "/ntu-1p -o " + (dir / "x.h5").string()).exit, 2)
            << "no crash";
    }
    write_file(shard, whole.substr(0, whole.size() - 1));
    EXPECT_NE(run_actformer("inspect --verify " + out()).output.find("cut short"), std::string::npos);
    fs::remove(shard);
    EXPECT_NE(run_actformer("inspect --verify " + out()).output.find("missing"), std::string::npos);
}

TEST_F(IngestNtu, RefusesADamagedDatasetFile) {
    clip("S001C001P001R001A001", plain_clip());
    ASSERT_EQ(ingest().exit, 0);
    const auto path = dir / "out/ntu-1p/dataset.json";
    const auto text = read_file(path);
    for (const std::string& bad :
         {text.substr(0, text.size() / 2), std::string("[]"), std::string("{}"), std::string()}) {
        write_file(path, bad);
        const auto result = run_actformer("inspect " + out());
        EXPECT_EQ(result.exit, 1);
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        EXPECT_NE(result.output.find("dataset.json"), std::string::npos) << result.output;
    }
}

TEST_F(IngestNtu, PrintsJson) {
    clip("S001C001P001R001A001", plain_clip());
    const auto result =
        run_command(program() + " ingest ntu " + raw() + " -o " + out() + " --json 2>/dev/null");
    const auto json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["files"], 1);
    EXPECT_EQ(json["datasets"][0]["clips"], 1);
    const auto inspected = nlohmann::json::parse(run_actformer("inspect --json " + out()).output);
    EXPECT_EQ(inspected["frames"]["total"], 20);
}

TEST_F(IngestNtu, ExportsOneSplitAndNamesTheSplitsThereAre) {
    clip("S001C001P001R001A001", plain_clip());  // performer 1 trains
    clip("S001C001P003R001A001", plain_clip());  // performer 3 tests
    ASSERT_EQ(ingest().exit, 0);
    const auto to = (dir / "x.h5").string(), other = (dir / "y.h5").string();
    ASSERT_EQ(run_actformer("export " + out() + "/ntu-1p --split xsub/test -o " + to).exit, 0);
    EXPECT_EQ(MotionsFile(to).names(), std::vector<std::string>{"S001C001P003R001A001"});
    const auto result = run_actformer("export " + out() + "/ntu-1p --split xsub/tset -o " + other);
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("no split 'xsub/tset'; there is all, xsub/train"), std::string::npos)
        << result.output;
    EXPECT_FALSE(fs::exists(other));
}
