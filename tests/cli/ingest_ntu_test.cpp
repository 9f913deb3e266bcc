// `actformer ingest ntu`, `inspect` and `export` as their users meet them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/mount.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "base/checksum/checksum.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/killed.hpp"
#include "tests/support/skeleton_text.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/tree.hpp"

using namespace actformer::test;
using actformer::ingest::Dataset;
using actformer::ingest::MotionsFile;
namespace fs = std::filesystem;

namespace {

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
        EXPECT_EQ(actformer::ingest::public_name(clip.name, clip.label),
                  "S001C001P001R001" + renumbered.first);
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
    EXPECT_NE(result.output.find("8 clips broken"), std::string::npos) << result.output;
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
    expect_refused(ingest(), {"none of 1 file gave a clip", "line 1: 'nonsense'"});
    clip("S001C001P001R001A001", plain_clip());
    expect_refused(ingest("--missing " + (dir / "none").string()), {"none: cannot be read"});
    expect_refused(ingest("--device no-such-thing"), {"there is no OpenCL device 'no-such-thing'"});
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
    const auto splits = [](const CommandResult& said) {
        return nlohmann::json::parse(said.output).at("datasets").at(0).at("splits");
    };
    const auto json = [this](const std::string& out) {
        return run_actformer("ingest ntu " + raw() + " -o " + out + " --json");
    };
    EXPECT_EQ(splits(json(out())), splits(json((dir / "first").string())));
    EXPECT_EQ(splits(json(out())).at("xsub/train"), 1);
    clip("S001C001P001R001A002", plain_clip());
    EXPECT_EQ(ingest().exit, 1) << "other raw data is another request";
}

TEST_F(IngestNtu, WorksInAFolderThatIsThere) {
    clip("S001C001P001R001A001", plain_clip());
    ASSERT_EQ(ingest().exit, 0);
    const auto right = tree(out() + "/ntu-1p");
    const auto expect_made_in = [&](const std::string& name) {
        const auto result = run_actformer("ingest ntu " + raw() + " -o " + (dir / name).string());
        EXPECT_EQ(result.exit, 0) << name << ": " << result.output;
        EXPECT_EQ(tree(dir / (name + "/ntu-1p")), right) << name;
        EXPECT_TRUE(fs::exists(dir / (name + "/ingest.json"))) << name;
        EXPECT_FALSE(fs::exists(dir / (name + "/.partial"))) << name;
        const auto again = run_actformer("ingest ntu " + raw() + " -o " + (dir / name).string());
        EXPECT_NE(again.output.find("complete already"), std::string::npos) << name << ": " << again.output;
    };
    fs::create_directories(dir / "empty");
    expect_made_in("empty");
    fs::create_directories(dir / "far");
    fs::create_directory_symlink(dir / "far", dir / "link");
    expect_made_in("link");
    EXPECT_TRUE(fs::is_symlink(dir / "link"));
    fs::create_directory_symlink("nowhere", dir / "dangling");
    expect_made_in("dangling");
    EXPECT_TRUE(fs::is_symlink(dir / "dangling") && fs::is_directory(dir / "nowhere"));
    fs::create_directories(dir / "disk");
    if (mount("none", (dir / "disk").c_str(), "tmpfs", 0, "size=8m") != 0)
        GTEST_SKIP() << "no right to mount a small disk";
    fs::create_directories(dir / "disk/lost+found");
    expect_made_in("disk");
    umount((dir / "disk").c_str());
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
    const auto ingest_into = [&](const std::string& folder) {
        return "ingest ntu " + raw() + " -o " + folder;
    };
    const auto calm = watched_run(ingest_into((dir / "calm").string()), dir / "calm");
    ASSERT_EQ(calm.result.exit, 0) << calm.result.output;
    // The first kill comes when the second tranche is about to be noted in the journal, behind the request and the first.
    kill_before(calm.call("write " + (dir / "calm.partial/journal").string(), 3), ingest_into(out()), out());

    std::mt19937 random(20261122);
    int kills = 0;
    for (;;) {
        const auto seconds = 0.15 + 0.002 * static_cast<double>(random() % 300) + 0.05 * kills;
        const bool was_done = fs::exists(out() + "/ingest.json");
        const auto result =
            run_command(fmt::format("timeout -s KILL {} {} {}", seconds, program(), ingest_into(out())));
        if (result.exit == 0) {
            EXPECT_NE(result.output.find(was_done ? "is complete already" : "went on behind "),
                      std::string::npos)
                << result.output;
            break;
        }
        ASSERT_EQ(result.exit, 137) << result.output;
        EXPECT_FALSE(fs::exists(out()) && !fs::exists(out() + "/ingest.json")) << "half an output";
        ASSERT_LT(++kills, 100);
    }
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

TEST_F(IngestNtu, LeavesWhatOthersPutAtItsWorkingFolder) {
    clip("S001C001P001R001A001", plain_clip());
    const auto command = "ingest ntu " + raw() + " -o " + out();
    write_file(dir / "thesis/data/chapter", "precious");
    fs::create_directory_symlink("thesis", dir / "out.partial");
    actformer::test::expect_refused(run_actformer(command),
                                    {"out.partial: a symbolic link", "remove it, or choose another -o"});
    fs::remove(dir / "out.partial");
    fs::rename(dir / "thesis", dir / "out.partial");
    actformer::test::expect_refused(run_actformer(command),
                                    {"out.partial/data/chapter: ", "move it, or choose another -o"});
    EXPECT_EQ(read_file(dir / "out.partial/data/chapter"), "precious");
}

TEST_F(IngestNtu, MovesNothingByAListOfOthers) {
    using namespace std::string_literals;
    clip("S001C001P001R001A001", plain_clip());
    write_file(dir / "home/docs/thesis.txt", "precious");
    fs::create_directories(dir / "out/.partial/data/a");
    fs::create_directory_symlink("../home/docs", dir / "out/a");
    write_file(dir / "out/.partial/delivering", "\0a/thesis.txt"s);
    actformer::test::expect_refused(ingest(), {"out/.partial/delivering: damaged", "or choose another -o"});
    EXPECT_EQ(read_file(dir / "home/docs/thesis.txt"), "precious");
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
    const auto whole = read_file(shard), exported = (dir / "x.h5").string(),
               sound = (dir / "sound.h5").string();
    const auto exports = [&](const std::string& to) {
        return run_actformer("export " + out() + "/ntu-1p -o " + to).exit;
    };
    ASSERT_EQ(exports(sound), 0);
    std::mt19937 random(5);
    int found = 0;
    for (int round = 0; round < 40; ++round) {
        auto bytes = whole;
        bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
        write_file(shard, bytes);
        const auto result = run_actformer("inspect --verify " + out());
        if (result.exit == 0) {  // a byte that says nothing: the library's own spare room
            ASSERT_EQ(exports(exported), 0);
            EXPECT_EQ(read_file(exported), read_file(sound));
            continue;
        }
        ++found;
        EXPECT_EQ(result.exit, 1);
        EXPECT_NE(result.output.find("shard-00000.h5"), std::string::npos) << result.output;
        EXPECT_LT(exports(exported), 2) << "no crash";
    }
    EXPECT_GE(found, 30) << "nine bytes in ten are motion";
    write_file(shard, whole.substr(0, whole.size() / 2));
    EXPECT_NE(run_actformer("inspect --verify " + out()).output.find("damaged"), std::string::npos);
    fs::remove(shard);
    EXPECT_NE(run_actformer("inspect --verify " + out()).output.find("missing"), std::string::npos);
}

TEST_F(IngestNtu, StaysVerifiedWhenAnotherProgramOpensAShard) {
    if (!python_has("h5py")) GTEST_SKIP() << "no h5py in /usr/bin/python3";
    clip("S001C001P001R001A001", plain_clip());
    ASSERT_EQ(ingest().exit, 0);
    const auto shard = dir / "out/ntu-1p/shard-00000.h5";
    const auto python = [&](const std::string& act) {
        return run_command("/usr/bin/python3 -c \"import h5py; f = h5py.File('" + shard.string() +
                           "', 'r+'); " + act + "; f.close()\"")
            .exit;
    };
    const auto before = read_file(shard);
    ASSERT_EQ(python("pass"), 0);
    EXPECT_NE(read_file(shard), before) << "h5py drops the padding: else this shows nothing";
    const auto verified = run_actformer("inspect --verify " + out());
    EXPECT_EQ(verified.exit, 0) << verified.output;
    EXPECT_NE(verified.output.find("checksums are of contents"), std::string::npos) << verified.output;
    ASSERT_EQ(python("f['clip/label'][0] = 3"), 0);
    const auto changed = run_actformer("inspect --verify " + out());
    EXPECT_EQ(changed.exit, 1);
    EXPECT_NE(changed.output.find("shard-00000.h5: the checksum of its contents differs"), std::string::npos)
        << changed.output;
}

TEST_F(IngestNtu, SaysThatAShardIsOpenForWritingElsewhere) {
    clip("S001C001P001R001A001", plain_clip());
    ASSERT_EQ(ingest().exit, 0);
    const int elsewhere = ::open((dir / "out/ntu-1p/shard-00000.h5").c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(::flock(elsewhere, LOCK_EX), 0);  // as HDF5 does while it writes
    const auto locked = run_actformer("inspect " + out());
    EXPECT_EQ(run_command("HDF5_USE_FILE_LOCKING=FALSE " + program() + " inspect " + out()).exit, 0);
    ::close(elsewhere);
    EXPECT_EQ(locked.exit, 1);
    EXPECT_EQ(lines_in(locked.output), 1) << locked.output;
    for (const auto* words : {"shard-00000.h5", "open for writing elsewhere", "HDF5_USE_FILE_LOCKING=FALSE"})
        EXPECT_NE(locked.output.find(words), std::string::npos) << locked.output;
}

TEST_F(IngestNtu, ReadsAndVerifiesDatasetsOfFormat1) {
    clip("S001C001P001R001A001", plain_clip());
    ASSERT_EQ(ingest().exit, 0);
    const auto path = dir / "out/ntu-1p/dataset.json", shard = dir / "out/ntu-1p/shard-00000.h5";
    auto json = nlohmann::json::parse(read_file(path));
    EXPECT_EQ(json["format"], 3);
    json["format"] = 1;  // as it was: the checksum of the file's bytes
    json.erase("checksum");
    json["shards"][0].erase("metadata");
    json["shards"][0].erase("contents");
    json["shards"][0]["checksum"] = actformer::checksum_file(shard);
    write_file(path, json.dump());
    const auto verified = run_actformer("inspect --verify " + out());
    EXPECT_EQ(verified.exit, 0) << verified.output;
    EXPECT_NE(verified.output.find("format 1"), std::string::npos) << verified.output;
    auto bytes = read_file(shard);
    bytes[bytes.size() / 2] ^= 1;
    write_file(shard, bytes);
    EXPECT_EQ(run_actformer("inspect --verify " + out()).exit, 1);
    json["format"] = 4;
    write_file(path, json.dump());
    EXPECT_NE(run_actformer("inspect " + out()).output.find("formats 1 to 3"), std::string::npos);
}

namespace {

/// A still figure whose every joint moves along x by `x` of the frame.
std::vector<Pose> moved(int frames, const std::function<double(int)>& x) {
    auto motion = std::vector<Pose>(static_cast<std::size_t>(frames), random_motion(1, 1)[0]);
    for (int t = 0; t < frames; ++t)
        for (auto& joint : motion[static_cast<std::size_t>(t)]) joint[0] += x(t);
    return motion;
}

double swing(int t) {
    return 0.2 * std::sin(0.2 * t);
}

/// How far the root of the only clip goes along x.
double range_of_root(const fs::path& dataset) {
    const auto motion = Dataset(dataset).motion(0);
    float least = 1e9F, most = -1e9F;
    for (std::size_t t = 0; t < motion.frames; ++t) {
        least = std::min(least, motion.values[t * motion.persons * 75]);
        most = std::max(most, motion.values[t * motion.persons * 75]);
    }
    return most - least;
}

}  // namespace

TEST_F(IngestNtu, ABodyAt000WasNotSeen) {
    auto body = always_seen("1", moved(50, swing));
    for (int t = 20; t < 24; ++t) body.frames[static_cast<std::size_t>(t)] = Pose{};
    clip("S001C001P001R001A023", skeleton_text(50, {body}));
    const auto result = ingest();
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("1 clip: bodies or joints at 0 0 0"), std::string::npos) << result.output;
    EXPECT_LT(range_of_root(dir / "out/ntu-1p"), 0.41) << "it swings by 0.2 m and never jumps";
    const auto filled = Dataset(dir / "out/ntu-1p").motion(0).values;
    fs::remove_all(dir / "out");
    for (int t = 20; t < 24; ++t) body.frames[static_cast<std::size_t>(t)] = std::nullopt;
    clip("S001C001P001R001A023", skeleton_text(50, {body}));
    ASSERT_EQ(ingest().exit, 0);
    EXPECT_EQ(filled, Dataset(dir / "out/ntu-1p").motion(0).values) << "as where it is not listed";
}

TEST_F(IngestNtu, JoinsTracksWhenAskedAndNamesTheClipsItWouldMend) {
    auto before = always_seen("1", moved(70, swing)), after = always_seen("2", moved(70, swing));
    for (std::size_t t = 0; t < 70; ++t) (t < 30 ? after : before).frames[t] = std::nullopt;
    clip("S001C001P001R001A023", skeleton_text(70, {before, after}));
    clip("S001C001P001R001A024", plain_clip(70));
    const auto plain = ingest();
    ASSERT_EQ(plain.exit, 0) << plain.output;
    EXPECT_NE(
        plain.output.find("1 clip: a body's tracking number changes: --join-tracks makes one body of such "
                          "tracks (S001C001P001R001A023)"),
        std::string::npos)
        << plain.output;
    const auto still = Dataset(dir / "out/ntu-1p").motion(0);
    EXPECT_NEAR(still.values[0], still.values[10 * 75], 1e-6) << "as published, the first frames stand still";
    fs::remove_all(dir / "out");
    const auto joined = ingest("--join-tracks");
    EXPECT_EQ(joined.output.find("tracking number"), std::string::npos) << joined.output;
    const auto motion = Dataset(dir / "out/ntu-1p").motion(0).values;
    fs::remove_all(dir / "out");
    clip("S001C001P001R001A023", skeleton_text(70, {always_seen("1", moved(70, swing))}));
    ASSERT_EQ(ingest().exit, 0);
    const auto whole = Dataset(dir / "out/ntu-1p").motion(0).values;
    ASSERT_EQ(motion.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_NEAR(motion[i], whole[i], 1e-6) << i;
}

TEST_F(IngestNtu, AGhostLosesByMotionAndIsNamedByFrames) {
    const auto ghost = always_seen("3", moved(60, [](int) { return 1.2; }));
    auto actor = always_seen("1", moved(60, swing));
    for (std::size_t t = 0; t < 5; ++t) actor.frames[t] = std::nullopt;
    clip("S001C001P001R001A023", skeleton_text(60, {ghost, actor}));
    const auto plain = ingest();
    ASSERT_EQ(plain.exit, 0) << plain.output;
    EXPECT_NE(plain.output.find("--bodies motion takes those that move most (S001C001P001R001A023)"),
              std::string::npos)
        << plain.output;
    EXPECT_NEAR(range_of_root(dir / "out/ntu-1p"), 0, 1e-6) << "as published, the ghost is longer there";
    fs::remove_all(dir / "out");
    const auto mended = ingest("--bodies motion");
    ASSERT_EQ(mended.exit, 0) << mended.output;
    EXPECT_EQ(mended.output.find("ghost"), std::string::npos) << mended.output;
    EXPECT_GT(range_of_root(dir / "out/ntu-1p"), 0.3);
    EXPECT_EQ(run_actformer("ingest ntu " + raw() + " -o " + out() + "2 --bodies longest").exit, 1);
}

TEST_F(IngestNtu, AGhostLosesToTwoPersonsToo) {
    const auto ghost = always_seen("3", moved(60, [](int) { return 1.2; }));
    auto one = always_seen("1", moved(60, swing)),
         two = always_seen("2", moved(60, [](int t) { return 2 * swing(t); }));
    one.frames[0] = two.frames[0] = std::nullopt;
    clip("S001C001P001R001A050", skeleton_text(60, {ghost, one, two}));
    ASSERT_NE(ingest().output.find("--bodies motion"), std::string::npos);
    fs::remove_all(dir / "out");
    ASSERT_EQ(ingest("--bodies motion").exit, 0);
    const auto motion = Dataset(dir / "out/ntu-2p").motion(0);
    float moving[2] = {};
    for (std::size_t t = 1; t < 60; ++t)
        for (std::size_t p = 0; p < 2; ++p)
            moving[p] += std::abs(motion.at(t, p, 0)[0] - motion.at(t - 1, p, 0)[0]);
    EXPECT_GT(moving[0], 0.5F);
    EXPECT_GT(moving[1], 0.5F);
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
    EXPECT_EQ(inspected["representation"], "limb");
    EXPECT_TRUE(inspected["remarks"].empty());
}

TEST_F(IngestNtu, WhatWasDoubtfulStaysWithTheDatasetItIsOf) {
    auto body = always_seen("1", moved(50, swing));
    body.frames[20] = Pose{};
    clip("S001C001P001R001A023", skeleton_text(50, {body}));
    clip("S001C001P001R001A055",
         skeleton_text(50, {always_seen("1", moved(50, swing)), always_seen("2", random_motion(50, 3))}));
    ASSERT_EQ(ingest().exit, 0);
    const auto remark =
        "1 clip: bodies or joints at 0 0 0 or NaN were not seen: filled from the frames around "
        "(S001C001P001R001A023)";
    EXPECT_EQ(Dataset(dir / "out/ntu-1p").remarks(), std::vector<std::string>{remark});
    EXPECT_TRUE(Dataset(dir / "out/ntu-2p").remarks().empty());
    const auto inspected = run_actformer("inspect " + out() + "/ntu-1p").output;
    EXPECT_NE(inspected.find(remark), std::string::npos) << inspected;
    EXPECT_NE(inspected.find("25 joints in limb"), std::string::npos) << inspected;
    const auto path = dir / "out/ntu-1p/dataset.json";
    auto json = nlohmann::json::parse(read_file(path));
    json.erase("remarks");
    write_file(path, json.dump());
    EXPECT_NE(run_actformer("inspect " + out()).output.find("take out its members \"checksum\""),
              std::string::npos);
    json.erase("checksum");
    write_file(path, json.dump());
    actformer::test::expect_refused(
        run_actformer("inspect " + out()),
        {"dataset.json: damaged: its checksum is missing", "\"checksum\" and \"program\""});
    json.erase("program");
    write_file(path, json.dump());
    EXPECT_TRUE(Dataset(dir / "out/ntu-1p").remarks().empty()) << "as datasets of old have none";
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
