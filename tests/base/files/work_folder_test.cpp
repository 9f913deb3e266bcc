// Folders that a command works in and removes: whatever else lies at their name stays.
#include "base/files/work_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

bool is_own(const fs::path& below) {
    return is_called(below.filename(), "own.h5");
}

std::string refusal(const fs::path& folder) {
    return error_of([&] { expect_own_folder(folder, is_own); });
}

}  // namespace

TEST(WorkFolder, OfOwnFilesAloneIsTakenAndRemoved) {
    const TempDir dir;
    const auto folder = dir / "work";
    for (const auto* file : {"", "own.h5", "in/own.h5", "own.h5.partial", "own.h5.partial.1"}) {
        fs::create_directories(folder / "in");
        if (*file) write_file(folder / file, "own");
        EXPECT_NO_THROW(expect_own_folder(folder, is_own)) << file;
        remove_own_folder(folder, is_own);
        EXPECT_FALSE(fs::exists(folder)) << file;
        EXPECT_NO_THROW(expect_own_folder(folder, is_own)) << "nothing is there";
    }
}

TEST(WorkFolder, OfOthersStaysAndIsRefusedByName) {
    const TempDir dir;
    const auto folder = dir / "work";
    const std::pair<const char*, const char*> cases[] = {
        {"thesis", "work/thesis: "}, {"in/thesis", "work/in/thesis: "}, {"own.h5.old", "work/own.h5.old: "}};
    for (const auto& [file, named] : cases) {
        write_file(folder / "own.h5", "own");
        write_file(folder / file, "precious");
        const auto why = refusal(folder);
        EXPECT_NE(why.find(named), std::string::npos) << why;
        EXPECT_NE(why.find("move it, or choose another -o"), std::string::npos) << why;
        remove_own_folder(folder, is_own);
        EXPECT_EQ(read_file(folder / file), "precious");
        EXPECT_TRUE(fs::exists(folder / "own.h5"));
        fs::remove_all(folder);
    }
    write_file(folder, "precious");
    EXPECT_NE(refusal(folder).find("work: in the way"), std::string::npos) << refusal(folder);
    remove_own_folder(folder, is_own);
    EXPECT_EQ(read_file(folder), "precious");
}

TEST(WorkFolder, BehindALinkStays) {
    const TempDir dir;
    write_file(dir / "far/own.h5", "kept");
    fs::create_directory_symlink("far", dir / "link");
    fs::create_directories(dir / "work");
    fs::create_symlink("../far/own.h5", dir / "work/own.h5");
    fs::create_symlink("nowhere", dir / "dangling");
    for (const auto* folder : {"link", "dangling"}) {
        const auto why = refusal(dir / folder);
        EXPECT_NE(why.find(std::string(folder) + ": a symbolic link"), std::string::npos) << why;
        EXPECT_NE(why.find("remove it, or choose another -o"), std::string::npos) << why;
        remove_own_folder(dir / folder, is_own);
        EXPECT_TRUE(fs::is_symlink(dir / folder));
    }
    EXPECT_NE(refusal(dir / "work").find("work/own.h5: "), std::string::npos);
    ASSERT_EQ(::mkfifo((dir / "far/pipe").c_str(), 0600), 0);
    EXPECT_NE(refusal(dir / "far").find("far/pipe: "), std::string::npos);
    EXPECT_EQ(read_file(dir / "far/own.h5"), "kept");
}
