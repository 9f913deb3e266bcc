#include "base/files/mapped_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;

TEST(MappedFile, EndsInZerosWhateverItsLength) {
    const TempDir dir;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, page - 65, page - 64, page - 1, page, page + 1, 3 * page}) {
        std::string text(size, 'x');
        for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>('a' + i % 26);
        write_file(dir / "file", text);
        const MappedFile file(dir / "file");
        ASSERT_EQ(file.text(), text) << size;
        const char* end = file.text().data() + size;
        EXPECT_TRUE(std::all_of(end, end + text_padding, [](char c) { return c == '\0'; })) << size;
        file.release(end);
        EXPECT_EQ(file.text(), text) << "what was released can still be read, " << size;
    }
}

TEST(MappedFile, CutShortWhileItIsReadEndsTheProgramInALineThatNamesIt) {
    const TempDir dir;
    for (const auto* name : {"one", "other"}) write_file(dir / name, std::string(100'000, 'x'));
    const auto read_what_is_gone = [&] {
        MappedFile one(dir / "one");
        const MappedFile other(dir / "other"), moved(std::move(one));
        std::filesystem::resize_file(dir / "one", 10);
        const volatile char* last = &moved.text()[99'999];
        std::exit(*last);
    };
    EXPECT_EXIT(read_what_is_gone(), testing::ExitedWithCode(1),
                "^actformer: .*/one: cut short by another program");
}

TEST(MappedFile, ChangesNothingOfOtherBusErrors) {
    const TempDir dir;
    write_file(dir / "file", "x");
    const auto fail_elsewhere = [&] {
        const MappedFile file(dir / "file");
        std::raise(SIGBUS);
    };
    EXPECT_EXIT(fail_elsewhere(), testing::KilledBySignal(SIGBUS), "");
}

TEST(MappedFile, NamesAFileThatIsNotThere) {
    EXPECT_THROW(MappedFile("/nowhere/at/all"), Error);
}
