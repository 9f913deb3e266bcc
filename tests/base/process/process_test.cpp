// Other programs: what they say, and where it goes.
#include "base/process/process.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/error.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;

TEST(Process, LogsAreRegularFiles) {
    const test::TempDir dir;
    std::filesystem::create_symlink(dir / "elsewhere", dir / "link");
    ASSERT_EQ(::mkfifo((dir / "fifo").c_str(), 0600), 0);
    for (const auto* name : {"link", "fifo"}) EXPECT_THROW(run_process({"true"}, dir / name), Error) << name;
    EXPECT_FALSE(std::filesystem::exists(dir / "elsewhere"));
}

TEST(Process, OneThatIsNotThereIsNamedAsATerminalMayShowIt) {
    const test::TempDir dir;
    const auto said = run_process({"/none\033]0;title\a\nactformer: done"}, dir / "log");
    EXPECT_EQ(said.exit, 127);
    EXPECT_TRUE(said.last_line.starts_with("/none")) << said.last_line;
    EXPECT_EQ(said.last_line.find_first_of("\033\a"), std::string::npos);
}

TEST(Process, AnAnswerIsApartFromErrors) {
    const test::TempDir dir;
    const auto answer =
        answer_of({"sh", "-c", "echo 7; echo loading >&2; echo why >&2; echo 8; exit 3"}, dir / "log");
    EXPECT_EQ(answer.exit, 3);
    EXPECT_EQ(answer.output, "7\n8\n");
    EXPECT_EQ(answer.why, "why");
    EXPECT_EQ(test::read_file(dir / "log"), "loading\nwhy\n");
}
