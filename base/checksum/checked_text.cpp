#include "base/checksum/checked_text.hpp"

#include <vector>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"

namespace actformer {
namespace {

constexpr std::string_view before_sum = "# checksum ";
constexpr std::uint64_t largest_text = std::uint64_t{1} << 26;

std::string comment_of(std::string_view text) {
    return std::string(before_sum) + checksum(text);
}

}  // namespace

std::string with_checksum_comment(std::string text) {
    return text + comment_of(text) + "\n";
}

void expect_checksum_comment(const std::filesystem::path& path) {
    std::vector<char> scratch;
    const auto text = read_text(path, scratch, largest_text);
    const auto lines =
        text.substr(0, text.find_last_not_of("\r\n") + 1);  // editors change how the last one ends
    const auto before = lines.substr(0, lines.rfind('\n') + 1);
    const auto last = lines.substr(before.size());
    if (last.starts_with(before_sum) && last != comment_of(before))
        throw Error("{}: damaged; take out its last line, the checksum, if it is right all the same",
                    path.string());
}

}  // namespace actformer
