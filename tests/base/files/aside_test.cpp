// Files that appear whole or not at all.
#include "base/files/aside.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <future>
#include <thread>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/regular_file.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

bool says(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
}

}  // namespace

TEST(Aside, AppearsWhenItIsCommitted) {
    const TempDir dir;
    write_file(dir / "a.h5", "old");
    Aside file(dir / "a.h5");
    file.write("new");
    EXPECT_EQ(read_file(dir / "a.h5"), "old");
    EXPECT_TRUE(fs::exists(dir / "a.h5.partial"));
    file.commit();
    EXPECT_EQ(read_file(dir / "a.h5"), "new");
    EXPECT_EQ(files_in(dir.path()), 1U);
}

TEST(Aside, LeavesNothingWhereItIsNot) {
    const TempDir dir;
    Aside(dir / "a").write("text");
    EXPECT_EQ(files_in(dir.path()), 0U);
}

TEST(Aside, SaysWhyNothingCanBeWritten) {
    const TempDir dir;
    EXPECT_TRUE(says(error_of([&] { Aside(dir / "none/a"); }), "there is no folder"));
    EXPECT_TRUE(says(error_of([&] { Aside{dir.path()}; }), "it is a folder"));
    EXPECT_TRUE(says(error_of([&] { Aside("/proc/a"); }), "/proc/a: cannot be written: "));
    EXPECT_TRUE(says(error_of([&] { write_whole("/dev/full/a", "text"); }), "/dev/full/a"));
    EXPECT_TRUE(says(error_of([&] { check_output(dir / "none/a"); }), "there is no folder"));
    check_output(dir / "a");
    EXPECT_EQ(files_in(dir.path()), 0U);
}

TEST(Aside, GoesBackAndForth) {
    const TempDir dir;
    Aside file(dir / "a");
    file.write_at(4, "5678");
    file.write_at(0, "12");
    EXPECT_EQ(file.size(), 8U);
    std::string read(10, 'x');
    file.read_at(0, read.data(), read.size());
    EXPECT_EQ(read, std::string("12\0\0005678\0\0", 10));
    file.resize(6);
    file.commit();
    EXPECT_EQ(read_file(dir / "a"), std::string("12\0\00056", 6));
}

TEST(Aside, TakesThePlaceOfWhatAKilledProgramLeft) {
    const TempDir dir;
    write_file(dir / "a.partial", "left");
    write_file(dir / "a.partial.1", "left");
    write_whole(dir / "a", "whole");
    EXPECT_EQ(read_file(dir / "a"), "whole");
    EXPECT_EQ(files_in(dir.path()), 1U);
}

TEST(Aside, OfSeveralWritersTheLastToCommitWins) {
    const TempDir dir;
    Aside first(dir / "a"), second(dir / "a");
    first.write("first");
    second.write("second");
    second.commit();
    EXPECT_EQ(read_file(dir / "a"), "second");
    first.commit();
    EXPECT_EQ(read_file(dir / "a"), "first");
    EXPECT_EQ(files_in(dir.path()), 1U);
}

TEST(Aside, ManyWritersAtOnceNeverFail) {
    const TempDir dir;
    const std::string text(100'000, 'x');
    std::vector<std::future<void>> writers;
    for (int w = 0; w < 4; ++w)
        writers.push_back(std::async(std::launch::async, [&] {
            for (int i = 0; i < 50; ++i) write_whole(dir / "a", text, Sync::later);
        }));
    for (auto& writer : writers) EXPECT_NO_THROW(writer.get());
    EXPECT_EQ(read_file(dir / "a"), text);
    EXPECT_EQ(files_in(dir.path()), 1U);
}

TEST(Aside, NeverFollowsALinkAtItsTemporaryName) {
    const TempDir dir;
    write_file(dir / "elsewhere", "precious");
    fs::create_symlink(dir / "elsewhere", dir / "a.partial");
    fs::create_symlink(dir / "nowhere", dir / "a.partial.1");
    ASSERT_EQ(::mkfifo((dir / "a.partial.2").c_str(), 0600), 0);
    write_whole(dir / "a", "whole");
    EXPECT_EQ(read_file(dir / "a"), "whole");
    EXPECT_EQ(read_file(dir / "elsewhere"), "precious");
    EXPECT_FALSE(fs::exists(dir / "nowhere"));
    EXPECT_TRUE(fs::is_symlink(dir / "a.partial"));
    fs::create_hard_link(dir / "elsewhere", dir / "b.partial");
    write_whole(dir / "b", "whole");
    EXPECT_EQ(read_file(dir / "elsewhere"), "precious");
}

TEST(Aside, FollowsALinkAtItsName) {
    const TempDir dir;
    fs::create_directories(dir / "far/deep");
    write_file(dir / "far/deep/a", "old");
    fs::create_symlink("far/deep/a", dir / "link");
    fs::create_symlink("far/new", dir / "dangling");
    fs::create_symlink("far", dir / "folder");
    write_whole(dir / "link", "new");
    write_whole(dir / "dangling", "new");
    write_whole(dir / "folder/third", "new");
    EXPECT_TRUE(fs::is_symlink(dir / "link"));
    EXPECT_TRUE(fs::is_symlink(dir / "dangling"));
    for (const auto* file : {"far/deep/a", "far/new", "far/third"})
        EXPECT_EQ(read_file(dir / file), "new") << file;
    EXPECT_EQ(files_in(dir / "far"), 3U);
    EXPECT_EQ(files_in(dir.path()), 4U);
}

TEST(Aside, LeavesDevicesAndFifosAlone) {
    const TempDir dir;
    EXPECT_TRUE(says(error_of([] { write_whole("/dev/full", "text"); }),
                     "/dev/full: cannot be written: No space left on device; free some space"));
    write_whole("/dev/null", "text");
    EXPECT_TRUE(fs::is_character_file("/dev/full") && fs::is_character_file("/dev/null"));
    EXPECT_TRUE(says(error_of([] { Aside("/dev/null").write_at(0, "x"); }), "a device or a FIFO"));
    const auto fifo = dir / "fifo";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    EXPECT_TRUE(says(error_of([&] { write_whole(fifo, "text"); }), "nobody reads from it"));
    const std::string text(200'000, 'x');  // more than the system keeps of what nobody has read
    const Descriptor reader(fifo, O_RDONLY | O_NONBLOCK);
    ASSERT_EQ(::fcntl(reader.get(), F_SETFL, 0), 0);
    auto writing = std::async(std::launch::async, [&] { write_whole(fifo, text); });
    pollfd begun{reader.get(), POLLIN, 0};
    ASSERT_EQ(::poll(&begun, 1, 60'000), 1);  // before the writer is there one would read the end
    std::string read(text.size(), '\0');
    EXPECT_EQ(read_fully(reader.get(), read.data(), read.size(), fifo), text.size());
    EXPECT_NO_THROW(writing.get());
    EXPECT_EQ(read, text);
    EXPECT_TRUE(fs::is_fifo(fifo));
    EXPECT_EQ(files_in(dir.path()), 1U);
}

TEST(Aside, KeepsThatADeviceIsNotForIt) {
    Aside file("/dev/null");
    const auto why = error_of([&] { file.size(); });
    EXPECT_TRUE(says(why, "/dev/null: cannot be written: it is a device or a FIFO"));
    EXPECT_EQ(error_of([&] { file.check(); }), why) << "for a library between that swallows it";
}

TEST(Aside, KeepsItsFailure) {
    Aside file("/dev/full");
    file.write("text");
    const auto why = error_of([&] { file.settle(); });
    EXPECT_TRUE(says(why, "No space left"));
    EXPECT_EQ(error_of([&] { file.check(); }), why);
    EXPECT_EQ(error_of([&] { file.commit(); }), why);
}

TEST(WriteWhole, WritesAnySizeAndReplaces) {
    const TempDir dir;
    for (const std::size_t size : {0UL, 1UL, 4095UL, 1UL << 20, (2UL << 20) + 4097}) {
        std::string text(size, 'x');
        for (std::size_t i = 0; i < size; i += 97) text[i] = static_cast<char>('a' + i % 26);
        for (const std::size_t into_page :
             {0UL, 1UL}) {  // from a page's beginning on it may go past the page cache
            std::vector<char> room(size + 2 * 4096);
            const auto misfit = reinterpret_cast<std::uintptr_t>(room.data()) % 4096;
            auto* at = room.data() + 4096 - misfit + into_page;
            std::copy(text.begin(), text.end(), at);
            write_whole(dir / "a", {at, size});
            EXPECT_EQ(read_file(dir / "a"), text) << size << " from " << into_page;
            EXPECT_EQ(files_in(dir.path()), 1U);
        }
    }
}

/// A file system of 1 MiB, where that may be made.
class SmallDisk {
  public:
    SmallDisk() : mounted_(::mount("none", dir_.path().c_str(), "tmpfs", 0, "size=1m") == 0) {}
    ~SmallDisk() {
        if (mounted_) ::umount2(dir_.path().c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    bool is_there() const { return mounted_; }
    const fs::path& path() const { return dir_.path(); }

  private:
    TempDir dir_;
    bool mounted_;
};

TEST(Aside, AFullDiskIsToldAndNothingStays) {
    const SmallDisk disk;
    if (!disk.is_there()) GTEST_SKIP() << "may not mount a small file system here";
    write_whole(disk.path() / "log", "line\n");
    const std::string much(std::size_t{2} << 20, 'x');
    EXPECT_TRUE(says(error_of([&] { write_whole(disk.path() / "a", much); }),
                     "/a: cannot be written: No space left"));
    EXPECT_EQ(files_in(disk.path()), 1U);
    EXPECT_TRUE(
        says(error_of([&] { append(disk.path() / "log", much); }), "/log: cannot be written: No space left"));
    EXPECT_EQ(read_file(disk.path() / "log"), "line\n") << "what was added in part is taken back";
}

TEST(Append, PutsBytesBehindTheFile) {
    const TempDir dir;
    append(dir / "log", "one\n");
    append(dir / "log", "two\n");
    EXPECT_EQ(read_file(dir / "log"), "one\ntwo\n");
    EXPECT_TRUE(says(error_of([&] { append(dir / "none/log", "x"); }), "none/log: cannot be written: "));
}

TEST(Append, OpensNeitherLinksNorWhatIsNoRegularFile) {
    const TempDir dir;
    fs::create_symlink("/dev/full", dir / "full");
    fs::create_symlink("nowhere", dir / "dangling");
    fs::create_directory(dir / "folder");
    ASSERT_EQ(::mkfifo((dir / "fifo").c_str(), 0600), 0);
    for (const auto& [name, kind] : {std::pair{"full", "a symbolic link"},
                                     {"dangling", "a symbolic link"},
                                     {"folder", "a folder"},
                                     {"fifo", "a FIFO"}}) {
        const auto why = fmt::format("{}: {}, where a regular file is expected; move it away", name, kind);
        const auto path = dir / name;
        EXPECT_TRUE(says(error_of([&] { append(path, "x"); }), why));
        EXPECT_TRUE(says(error_of([&] { open_regular(path, O_RDONLY); }), why));
    }
    EXPECT_FALSE(fs::exists(dir / "nowhere"));
    EXPECT_TRUE(says(error_of([] { append("/dev/full", "x"); }), "/dev/full: a device, where"));
    EXPECT_LT(open_regular(dir / "none", O_RDONLY).get(), 0);
}

TEST(MakeFolders, FollowsALinkThatLeadsToNothingYet) {
    const TempDir dir;
    fs::create_symlink("far/deep", dir / "link");
    make_folders(dir / "link");
    EXPECT_TRUE(fs::is_directory(dir / "far/deep"));
    write_file(dir / "file", "text");
    EXPECT_TRUE(says(error_of([&] { make_folders(dir / "file/inside"); }),
                     "file/inside: the folder cannot be made: "));
}
