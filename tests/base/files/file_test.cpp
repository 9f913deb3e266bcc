#include "base/files/file.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "base/error.hpp"
#include "base/files/memory_for.hpp"
#include "tests/support/little_memory.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;

namespace {

/// What reading a file of `size` bytes says where `limit` are allowed.
std::string refusal(std::uint64_t size, std::uint64_t limit) {
    const test::TempDir dir;
    const auto path = dir / "notes";
    write_whole(path, "");
    std::filesystem::resize_file(path, size);
    std::vector<char> scratch;
    try {
        read_text(path, scratch, limit);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST(TextFiles, SayWhatIsTooLarge) {
    const std::uint64_t mebibyte = 1 << 20;
    EXPECT_EQ(refusal(2 * mebibyte, 2 * mebibyte), "");
    EXPECT_NE(refusal(2 * mebibyte + 1, 2 * mebibyte)
                  .find("notes: 3 MiB, and a file of this kind has at most 2 MiB; "),
              std::string::npos);
    EXPECT_NE(refusal(1025, 1024).find("notes: 1025 bytes, and a file of this kind has at most 1024 bytes; "),
              std::string::npos);
}

TEST(TextFiles, NameTheOneThatThereIsNoMemoryFor) {
    if (test::address_sanitized) GTEST_SKIP() << test::why_not;
    const test::TempDir dir;
    const auto path = dir / "notes";
    write_whole(path, "");
    std::filesystem::resize_file(path, std::uint64_t{1} << 30);
    const auto read = [&] {
        test::leave_little_memory();
        std::vector<char> scratch;
        try {
            read_text(path, scratch, std::uint64_t{1} << 40);
        } catch (const NoMemoryFor& e) {
            std::_Exit(std::strstr(e.what(), "notes: not enough memory") ? 3 : 4);
        }
        std::_Exit(5);
    };
    EXPECT_EXIT(read(), testing::ExitedWithCode(3), "");
}
