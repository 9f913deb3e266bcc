#include "ingest/pipeline/source.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>

#include "base/error.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::ingest;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

/// stem -> text of every file of a source.
std::vector<std::pair<std::string, std::string>> contents(const std::vector<fs::path>& raw) {
    Source source(raw, {".skeleton"});
    std::vector<std::pair<std::string, std::string>> out;
    std::vector<char> scratch;
    RawFile file;
    while (source.next(file)) {
        const auto text = file.text(scratch);
        for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(text.data()[text.size() + i], '\0') << "padding";
        out.emplace_back(file.stem, text);
    }
    EXPECT_EQ(source.bytes_read(), source.bytes_total());
    return out;
}

std::string message(const std::vector<fs::path>& raw) {
    try {
        contents(raw);
        return "no error";
    } catch (const actformer::Error& e) {
        return e.what();
    }
}

struct Files : testing::Test {
    void SetUp() override {
        write_file(dir / "raw/b/two.skeleton", "second");
        write_file(dir / "raw/a/one.SKELETON", "first");
        write_file(dir / "raw/a/notes.txt", "not one of ours");
        write_file(dir / "raw/a/._one.skeleton", "an archiver's companion");
        write_file(dir / "raw/c/empty.skeleton", "");
    }
    const std::vector<std::pair<std::string, std::string>> expected{
        {"one", "first"}, {"two", "second"}, {"empty", ""}};
    TempDir dir;
};

}  // namespace

TEST_F(Files, ComeOutOfNestedFoldersInOrder) {
    EXPECT_EQ(contents({dir / "raw"}), expected);
}

TEST_F(Files, LinkedFoldersAreFollowedAndCirclesEnd) {
    write_file(dir / "elsewhere/CMU/01/walk.skeleton", "linked");
    fs::create_directory_symlink(dir / "elsewhere/CMU", dir / "raw/b/CMU");
    fs::create_directory_symlink("..", dir / "raw/b/above");                     // a circle
    fs::create_directory_symlink(dir / "raw/b", dir / "elsewhere/CMU/01/back");  // another
    fs::create_directory_symlink(dir / "raw/c", dir / "raw/a/of c");             // what is there already
    fs::create_directory_symlink(dir / "raw/b/gone", dir / "raw/b/nowhere");
    fs::create_directory_symlink(dir.path(), dir / "raw/b/outside");  // and so to what was not given
    write_file(dir / "beside.skeleton", "not given");
    auto all = expected;
    all.insert(all.begin() + 1, {"walk", "linked"});
    EXPECT_EQ(contents({dir / "raw"}), all);
    Source source({dir / "raw"}, {".skeleton"});
    std::vector<std::string> inside;
    for (RawFile file; source.next_name(file);) inside.push_back(file.inside);
    EXPECT_EQ(inside, (std::vector<std::string>{"a/one.SKELETON", "b/CMU/01/walk.skeleton", "b/two.skeleton",
                                                "c/empty.skeleton"}));
}

TEST_F(Files, OfFoldersLeftOutAreNotThere) {
    fs::create_directory_symlink("../b", dir / "raw/a/link");
    fs::create_directory_symlink("raw/c", dir / "c");
    const std::vector<std::vector<fs::path>> given{{dir / "raw"},
                                                   {dir / "raw/a", dir / "raw/b", dir / "raw/c"}};
    for (const auto& raw : given) {
        Source source(raw, {".skeleton"}, usual_largest_file, 1, {dir / "raw/b", dir / "c", dir / "gone"});
        std::vector<std::string> stems;
        for (RawFile file; source.next_name(file);) stems.push_back(file.stem);
        EXPECT_EQ(stems, std::vector<std::string>{"one"}) << raw.size();
    }
}

TEST_F(Files, WhatIsNoRegularFileIsSkippedByName) {
    ASSERT_EQ(::mkfifo((dir / "raw/b/pipe.skeleton").c_str(), 0600), 0);
    fs::create_symlink(dir / "raw/b/pipe.skeleton", dir / "raw/b/link.skeleton");
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{AF_UNIX, {}};
    const auto place = (dir / "raw/s.skeleton").string();
    place.copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(socket);
    Source source({dir / "raw"}, {".skeleton"});
    TextMemory memory(1 << 20);
    std::map<std::string, std::string> said;
    for (RawFile file; source.next(file);) try {
            memory.read(file);
        } catch (const actformer::Error& e) {
            said[file.stem] = e.what();
        }
    EXPECT_EQ(said, (std::map<std::string, std::string>{
                        {"link", (dir / "raw/b/link.skeleton").string() + ": a FIFO, and no regular file"},
                        {"pipe", (dir / "raw/b/pipe.skeleton").string() + ": a FIFO, and no regular file"},
                        {"s", place + ": a socket, and no regular file"}}));
    EXPECT_EQ(message({dir / "raw/b/pipe.skeleton"}),
              (dir / "raw/b/pipe.skeleton").string() + ": a FIFO, where a regular file is expected");
    EXPECT_EQ(message({"/dev/null"}), "/dev/null: a device, where a regular file is expected");
}

TEST_F(Files, ComeOutOfArchives) {
    const std::map<std::string, std::string> commands{
        {"x.zip", "cd raw && zip -qr ../x.zip a/one.SKELETON a/notes.txt a/._one.skeleton b c"},
        {"x.tar", "cd raw && tar cf ../x.tar a b c"},
        {"x.tar.gz", "cd raw && tar czf ../x.tar.gz a b c"},
        {"x.tar.xz", "cd raw && tar cJf ../x.tar.xz a b c"},
        {"x.tar.bz2", "cd raw && tar cjf ../x.tar.bz2 a b c"}};
    const std::map<std::string, std::string> packers{
        {"x.zip", "zip"}, {"x.tar.gz", "gzip"}, {"x.tar.xz", "xz"}, {"x.tar.bz2", "bzip2"}};
    std::string absent;
    for (const auto& [name, command] : commands) {
        if (const auto packer = packers.find(name); packer != packers.end() && !has_program(packer->second)) {
            absent += " " + packer->second;
            continue;
        }
        const auto packed = run_command("cd " + dir.path().string() + " && " + command);
        ASSERT_EQ(packed.exit, 0) << command << ": " << packed.output;
        auto found = contents({dir / name});
        std::sort(found.begin(), found.end());
        auto sorted = expected;
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(found, sorted) << name;
    }
    if (!absent.empty()) GTEST_SKIP() << "there is no" << absent;
}

TEST_F(Files, ThatArePackedInAFolderAreToldAndNotRead) {
    const auto not_read = [&](const std::vector<fs::path>& raw) {
        return Source(raw, {".skeleton"}).not_read();
    };
    using Lines = std::vector<std::string>;
    EXPECT_EQ(not_read({dir / "raw"}), Lines());
    const auto listing = Source({dir / "raw"}, {".skeleton"}).listing();
    ASSERT_EQ(run_command("cd " + dir.path().string() + " && tar cf raw/b/S002.tar raw/a").exit, 0);
    for (const char* name : {"raw/a/S003.TAR.gz", "raw/c/S004.zip", "raw/c/S005.7z", "raw/a/._S003.tar.gz",
                             "raw/b/three.skeleton.gz"})
        write_file(dir / name, "");
    fs::create_directories(dir / "raw/folder.zip");
    const auto in_raw = " in " + (dir / "raw").string();
    const auto compressed = "1 compressed file" + in_raw + " is not read (b/three.skeleton.gz): unpack it";
    EXPECT_EQ(not_read({dir / "raw"}), (Lines{"4 archives" + in_raw +
                                                  " are not read (a/S003.TAR.gz, b/S002.tar, c/S004.zip, "
                                                  "...): unless unpacked there, give them as RAW too",
                                              compressed}));
    EXPECT_EQ(contents({dir / "raw"}), expected);
    EXPECT_EQ(Source({dir / "raw"}, {".skeleton"}).listing(), listing);
    fs::remove(dir / "raw/c/S004.zip");
    fs::remove(dir / "raw/c/S005.7z");
    EXPECT_EQ(not_read({dir / "raw/b/../b/S002.tar", dir / "raw"}),
              (Lines{"1 archive" + in_raw +
                         " is not read (a/S003.TAR.gz): unless unpacked there, give it as RAW too",
                     compressed}));
    write_file(dir / "packed/S006.rar", "");
    EXPECT_EQ(message({dir / "packed"}), fmt::format("{0}: no .skeleton file there; 1 archive in {0} is not "
                                                     "read (S006.rar): unless unpacked there, give it as "
                                                     "RAW too",
                                                     (dir / "packed").string()));
}

TEST_F(Files, ThatBeginLikeUnusualArchivesStartNoProgram) {
    for (const auto* name : {"lrzip", "grzip"}) {
        write_file(dir / "bin" / name, "#!/bin/sh\ntouch '" + (dir / "started").string() + "'\n");
        ASSERT_EQ(::chmod((dir / "bin" / name).c_str(), 0755), 0);
    }
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", ((dir / "bin").string() + ":" + path).c_str(), 1);
    for (const auto& begin : {std::string("LRZI\0\6", 6), std::string("GRZipII\0\2\4:)", 12)}) {
        write_file(dir / "x.tar.lrz", begin + std::string(100, '\0'));
        EXPECT_NE(message({dir / "x.tar.lrz"}).find("neither a folder nor an archive"), std::string::npos);
        EXPECT_FALSE(fs::exists(dir / "started")) << begin;
    }
    ::setenv("PATH", path.c_str(), 1);
}

TEST_F(Files, OfAnArchiveThatIsATextWithPathsAreNotRead) {
    const auto secret = (dir / "secret").string();
    write_file(secret, "not meant for anybody");
    write_file(dir / "list.skeletons", "#mtree\n./a.skeleton type=file contents=" + secret + "\n");
    EXPECT_NE(message({dir / "list.skeletons"}).find("neither a folder nor an archive"), std::string::npos);
}

TEST_F(Files, LargeOnesOutOfArchivesAreUnpackedToADiskWhileTheyAreRead) {
    const std::string large(33 << 20, 'x');
    write_file(dir / "raw/d/large.skeleton", large);
    ASSERT_EQ(run_command("cd " + dir.path().string() + " && tar czf x.tar.gz raw/a/one.SKELETON raw/d").exit,
              0);
    Source source({dir / "x.tar.gz"}, {".skeleton"});
    RawFile file;
    ASSERT_TRUE(source.next(file));
    EXPECT_TRUE(file.in_memory);
    ASSERT_TRUE(source.next(file));
    EXPECT_FALSE(file.in_memory);
    const auto on_disk = file.on_disk();
    {
        TextMemory memory(std::uint64_t{1} << 40);
        const auto raw = memory.read(file);
        EXPECT_TRUE(raw.text == large);
        EXPECT_NE(raw.mapped, nullptr);
        EXPECT_FALSE(raw.on_disk);
        EXPECT_TRUE(raw.path.ends_with("x.tar.gz:raw/d/large.skeleton")) << raw.path;
    }
    EXPECT_TRUE(fs::exists(on_disk));
    EXPECT_FALSE(source.next(file));
    file = {};
    EXPECT_FALSE(fs::exists(on_disk.parent_path()));

    Source small({dir / "x.tar.gz"}, {".skeleton"}, std::uint64_t{32} << 20);
    std::vector<char> scratch;
    ASSERT_TRUE(small.next(file) && small.next(file));
    EXPECT_THROW(static_cast<void>(file.text(scratch)), actformer::Error);
}

TEST_F(Files, ComeOutOfArchivesWhereTheyAreWanted) {
    ASSERT_EQ(run_command("cd " + dir.path().string() + " && tar czf x.tar.gz raw").exit, 0);
    Source source({dir / "x.tar.gz"}, {".skeleton"});
    source.unpack_only([](const RawFile& file) { return file.stem == "one"; });
    std::map<std::string, std::size_t> bytes;
    for (RawFile file; source.next(file);) bytes[file.stem] = file.bytes.size();
    EXPECT_EQ(bytes, (std::map<std::string, std::size_t>{{"empty", 0}, {"one", 5 + 64}, {"two", 0}}));
}

TEST_F(Files, ComeInTheOrderOfThePaths) {
    const auto found = contents({dir / "raw/b", dir / "raw/a/one.SKELETON"});
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].first, "two");
    EXPECT_EQ(found[1].first, "one");
}

TEST_F(Files, NamesAreListedWithoutTheirBytes) {
    run_command("cd " + dir.path().string() + " && tar czf x.tar.gz raw");
    Source source({dir / "x.tar.gz"}, {".skeleton"});
    RawFile file;
    int n = 0;
    while (source.next_name(file)) ++n;
    EXPECT_EQ(n, 3);
}

TEST_F(Files, ThatAreNotThereAreNamed) {
    EXPECT_NE(message({dir / "absent"}).find("absent: no such file or folder"), std::string::npos);
    EXPECT_NE(message({dir / "raw/a/notes.txt"}).find("notes.txt: neither a folder nor an archive"),
              std::string::npos);
    write_file(dir / "x.tar.gz", "<!DOCTYPE html><html><body>Quota exceeded</body></html>");
    EXPECT_NE(message({dir / "x.tar.gz"}).find("x.tar.gz: an HTML page in place of an archive"),
              std::string::npos);
    fs::create_directories(dir / "nothing");
    EXPECT_NE(message({dir / "nothing"}).find("no .skeleton file there"), std::string::npos);
}

TEST_F(Files, InABrokenArchiveStopWithItsName) {
    for (int i = 0; i < 50; ++i) {
        std::string text;
        for (unsigned j = 0; j < 3000; ++j) text += std::to_string(i * 7919U + j * j * 104729U);
        write_file(dir / ("raw/many/" + std::to_string(i) + ".skeleton"), text);
    }
    for (const std::string name : {"x.tar.gz", "x.tar.xz", "x.zip"}) {
        const auto make = name == "x.zip" ? "zip -qr x.zip raw" : "tar caf " + name + " raw";
        const std::string packer = name == "x.zip" ? "zip" : name == "x.tar.xz" ? "xz" : "gzip";
        if (!has_program(packer)) GTEST_SKIP() << "there is no " << packer;
        ASSERT_EQ(run_command("cd " + dir.path().string() + " && " + make).exit, 0) << make;
        const auto whole = read_file(dir / name);
        write_file(dir / name, whole.substr(0, whole.size() / 2));
        const auto what = message({dir / name});
        EXPECT_NE(what.find(name + ": broken archive"), std::string::npos) << what;
        EXPECT_NE(what.find("download it again"), std::string::npos) << what;
    }
}

TEST_F(Files, ThatCannotBeReadSayWhyWhenTheyAreWanted) {
    fs::create_symlink(dir / "gone", dir / "raw/dangling.skeleton");
    Source source({dir / "raw"}, {".skeleton"});
    std::vector<char> scratch;
    RawFile file;
    int unreadable = 0;
    while (source.next(file)) try {
            static_cast<void>(file.text(scratch));
        } catch (const actformer::Error& e) {
            ++unreadable;
            EXPECT_NE(std::string(e.what()).find("cannot be read: No such file"), std::string::npos);
        }
    EXPECT_EQ(unreadable, 1);
}

TEST_F(Files, ChangeTheListingWhenTheyChange) {
    const auto before = Source({dir / "raw"}, {".skeleton"}).listing();
    EXPECT_EQ(Source({dir / "raw"}, {".skeleton"}).listing(), before);
    write_file(dir / "raw/b/two.skeleton", "changed");
    EXPECT_NE(Source({dir / "raw"}, {".skeleton"}).listing(), before);
}
