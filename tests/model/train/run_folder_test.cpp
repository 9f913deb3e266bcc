// A training's log: nothing that was told of an epoch is lost, and only a file of the training's own is opened for it.
#include "model/train/run_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/checksum/checked_lines.hpp"
#include "base/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::model;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

/// The line `number` of a log, by its epoch where there is nothing else in it.
std::string line_of(int epoch, int number = 0) {
    return actformer::checked_line({{"epoch", epoch}, {"step", 10 * epoch}, {"loss", 0.5 * epoch}},
                                   static_cast<std::size_t>(number ? number : epoch));
}

struct RunLog : testing::Test {
    TempDir dir;
    RunFolder run{dir / "run"};
    fs::path log = dir / "run/log.jsonl";

    void add(int epoch) { run.log({{"epoch", epoch}, {"step", 10 * epoch}, {"loss", 0.5 * epoch}}); }
};

}  // namespace

TEST_F(RunLog, KeepsLinesThatCannotBeWrittenAndWritesThemBeforeTheNext) {
    add(1);
    fs::rename(log, dir / "aside");
    fs::create_directory(log);
    for (const int epoch : {2, 3})
        EXPECT_NE(error_of([&] { add(epoch); }).find("run/log.jsonl: a folder, where"), std::string::npos);
    EXPECT_NE(error_of([&] { run.sync_log(); }).find("run/log.jsonl: a folder, where"), std::string::npos);
    fs::remove(log);
    fs::rename(dir / "aside", log);
    run.sync_log();
    EXPECT_EQ(read_file(log), line_of(1) + line_of(2) + line_of(3));
    add(4);
    run.sync_log();
    EXPECT_EQ(read_file(log), line_of(1) + line_of(2) + line_of(3) + line_of(4));
}

TEST_F(RunLog, GoesBackToTheCheckpointAndTellsOfWhatIsNoWholeLine) {
    run.sync_log();  // there is none yet
    EXPECT_EQ(run.rewind_log(0), "");
    EXPECT_FALSE(fs::exists(log));

    const auto whole = line_of(1) + line_of(2) + line_of(3);
    write_file(log, whole);
    EXPECT_EQ(run.rewind_log(2), "");
    EXPECT_EQ(read_file(log), line_of(1) + line_of(2));

    write_file(log, line_of(1) + line_of(2).substr(0, 30));
    EXPECT_EQ(run.rewind_log(2), log.string() + ": its last line is cut short, and left out");
    EXPECT_EQ(read_file(log), line_of(1));
    EXPECT_FALSE(fs::exists(log.string() + ".damaged"));

    write_file(log, line_of(1) + line_of(3));
    EXPECT_EQ(run.rewind_log(3), log.string() + ": lines are missing before line 2");
    EXPECT_EQ(read_file(log), line_of(1) + line_of(3, 2)) << "numbered anew: said once";
    EXPECT_EQ(run.rewind_log(3), "");
    add(4);
    EXPECT_EQ(read_file(log), line_of(1) + line_of(3, 2) + line_of(4, 3));
    write_file(log, line_of(1));
    EXPECT_EQ(run.rewind_log(3), log.string() + ": its last lines are missing: it ends at epoch 1 of 3");

    const auto later = line_of(1) + line_of(2) + line_of(3) + line_of(2, 4);  // scores of epoch 2, done then
    write_file(log, later);
    EXPECT_EQ(run.rewind_log(3), "");
    EXPECT_EQ(read_file(log), later);
    write_file(log, line_of(2) + line_of(3).substr(0, 30));
    EXPECT_EQ(run.rewind_log(3),
              log.string() + ": lines are missing before line 1; its last line is cut short, and left out");
    fs::remove(log);
    EXPECT_EQ(run.rewind_log(3), log.string() + ": not there; curves begin at epoch 4");
    EXPECT_FALSE(fs::exists(log));

    const std::string earlier = "{\"epoch\":1,\"loss\":0.5}\n";
    auto damaged = earlier + line_of(1, 2) + line_of(2, 3) + line_of(3, 4);
    damaged[damaged.find("\"step\":20") + 7] = '3';
    write_file(log, damaged);
    EXPECT_EQ(run.rewind_log(3), log.string() + ": line 3: damaged, and left out; the log as it was is " +
                                     log.string() + ".damaged");
    EXPECT_EQ(read_file(log),
              actformer::checked_line({{"epoch", 1}, {"loss", 0.5}}, 1) + line_of(1, 2) + line_of(3, 3));
    EXPECT_EQ(read_file(log.string() + ".damaged"), damaged);
}

TEST_F(RunLog, OpensNeitherLinksNorWhatIsNoRegularFile) {
    for (const auto* target : {"/dev/full", "/dev/zero", "elsewhere"}) {
        fs::create_symlink(target, log);
        EXPECT_NE(error_of([&] { run.rewind_log(0); }).find("run/log.jsonl: a symbolic link, where"),
                  std::string::npos);
        EXPECT_NE(error_of([&] { add(1); }).find("run/log.jsonl: a symbolic link, where"), std::string::npos);
        EXPECT_TRUE(fs::is_symlink(log));
        fs::remove(log);
    }
    ASSERT_EQ(::mkfifo(log.c_str(), 0600), 0);
    EXPECT_NE(error_of([&] { run.rewind_log(0); }).find("run/log.jsonl: a FIFO, where"), std::string::npos);

    RunFolder with_curves(dir / "curves", true);
    fs::create_symlink("/dev/full", dir / "curves/events.out.tfevents.actformer");
    EXPECT_NE(error_of([&] { with_curves.rewind_log(0); }).find("actformer: a symbolic link, where"),
              std::string::npos);
}
