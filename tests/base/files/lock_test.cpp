#include "base/files/lock.hpp"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <utility>

#include "base/error.hpp"
#include "tests/support/temp_dir.hpp"

using actformer::FileLock;
using actformer::test::TempDir;

namespace {

/// Done once, between the opening of a lock's file and its locking.
thread_local std::function<void()> before_next_flock;

}  // namespace

/// In front of the system's.
extern "C" int flock(int fd, int operation) noexcept {
    if (const auto what = std::exchange(before_next_flock, nullptr)) what();
    return static_cast<int>(::syscall(SYS_flock, fd, operation));
}

TEST(FileLock, KeepsOthersOutWhileItLives) {
    const TempDir dir;
    const auto path = dir / "lock";
    EXPECT_FALSE(FileLock::is_held(path));
    EXPECT_FALSE(std::filesystem::exists(path)) << "asking makes no file";
    {
        const FileLock held(path);
        EXPECT_TRUE(FileLock::is_held(path));
        EXPECT_FALSE(FileLock::if_free(path));
    }
    EXPECT_FALSE(FileLock::is_held(path));
    auto taken = FileLock::if_free(path);
    ASSERT_TRUE(taken);
    const FileLock moved = std::move(*taken);
    taken.reset();
    EXPECT_TRUE(FileLock::is_held(path)) << "it moves with its owner";
}

TEST(FileLock, WaitsForAnotherProcessAndGoesWithIt) {
    const TempDir dir;
    const auto path = dir / "lock";
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const auto child = fork();
    if (child == 0) {
        const FileLock held(path);
        static_cast<void>(!write(ready[1], "x", 1));
        usleep(100'000);
        _exit(0);  // without letting go
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_TRUE(FileLock::is_held(path));
    const FileLock waited(path);
    EXPECT_FALSE(FileLock::if_free(path));
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    close(ready[0]);
    close(ready[1]);
}

TEST(FileLock, IsOfTheFileThatIsThereNow) {
    const TempDir dir;
    const auto path = dir / "lock";
    before_next_flock = [&] { std::filesystem::remove(path); };
    const auto alone = FileLock::if_free(path);
    ASSERT_FALSE(before_next_flock) << "the system was not asked";
    EXPECT_TRUE(alone);
    EXPECT_TRUE(FileLock::is_held(path)) << "on a new file";
    std::filesystem::remove(path);

    std::optional<FileLock> others;
    before_next_flock = [&] {  // another removes it and begins anew
        std::filesystem::remove(path);
        others = FileLock::if_free(path);
    };
    EXPECT_FALSE(FileLock::if_free(path)) << "two hold it";
    EXPECT_TRUE(others);
}

TEST(FileLock, NamesAFolderThatIsNotThere) {
    const TempDir dir;
    try {
        FileLock::if_free(dir / "none/lock");
        FAIL() << "made a lock";
    } catch (const actformer::Error& e) {
        EXPECT_NE(std::string(e.what()).find("none/lock: cannot be made or written: No such file"),
                  std::string::npos)
            << e.what();
    }
}
