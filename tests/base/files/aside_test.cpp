// Files that appear whole or not at all.
#include "base/files/aside.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
using actformer::Aside;
namespace fs = std::filesystem;

namespace {

template <typename Do>
std::string error_of(const Do& run) {
    try {
        run();
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

}  // namespace

TEST(Aside, AppearsWhenItIsCommitted) {
    const TempDir dir;
    write_file(dir / "a.h5", "old");
    Aside file(dir / "a.h5");
    EXPECT_EQ(file.partial(), dir / "a.h5.partial");
    write_file(file.partial(), "new");
    EXPECT_EQ(read_file(dir / "a.h5"), "old");
    file.commit();
    EXPECT_EQ(read_file(dir / "a.h5"), "new");
    EXPECT_EQ(files_in(dir.path()), 1U);
}

TEST(Aside, LeavesNothingWhereItIsNot) {
    const TempDir dir;
    {
        const Aside file(dir / "a.mp4", ".mp4");
        EXPECT_EQ(file.partial(), dir / "a.mp4.partial.mp4");
        EXPECT_TRUE(fs::exists(file.partial()));
    }
    EXPECT_EQ(files_in(dir.path()), 0U);
    EXPECT_NE(error_of([&] { Aside(dir / "b").commit(false); }).find("b: cannot be written whole"),
              std::string::npos);
    EXPECT_EQ(files_in(dir.path()), 0U);
}

TEST(Aside, SaysWhyNothingCanBeWritten) {
    const TempDir dir;
    EXPECT_NE(error_of([&] { Aside(dir / "none/a"); }).find("there is no folder"), std::string::npos);
    EXPECT_NE(error_of([&] { Aside{dir.path()}; }).find("it is a folder"), std::string::npos);
    EXPECT_NE(error_of([&] { Aside("/proc/a"); }).find("/proc/a: cannot be written: "), std::string::npos);
    EXPECT_NE(error_of([&] { write_whole("/dev/full/a", "text"); }).find("/dev/full/a"), std::string::npos);
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
