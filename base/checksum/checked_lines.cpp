#include "base/checksum/checked_lines.hpp"

#include <algorithm>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/first_few.hpp"
#include "base/text/json.hpp"

namespace actformer {
namespace {

constexpr std::uint64_t largest_log = std::uint64_t{1} << 30;  // bytes: those of millions of lines

}  // namespace

std::string checked_line(const nlohmann::ordered_json& object) {
    return with_checksum(object).dump() + "\n";
}

std::string CheckedLines::fault(const std::filesystem::path& file) const {
    if (damaged.empty()) return cut_short ? file.string() + ": its last line is cut short" : "";
    std::vector<std::string> numbers;
    for (const auto number : damaged) numbers.push_back(std::to_string(number));
    return fmt::format("{}: line{} {}: damaged", file.string(), damaged.size() == 1 ? "" : "s",
                       few_and_more(numbers, 5));
}

CheckedLines read_checked_lines(const std::filesystem::path& path) {
    CheckedLines out;
    if (std::error_code missing; !std::filesystem::exists(path, missing)) return out;
    std::vector<char> scratch;
    auto text = read_text(path, scratch, largest_log);
    for (std::size_t number = 1; !text.empty(); ++number) {
        const auto size = std::min(text.find('\n'), text.size());
        const bool ends = size < text.size();
        auto object = json_or_discarded<nlohmann::ordered_json>(text.substr(0, size));
        if (object.is_object() && own_checksum_of(object) != OwnChecksum::wrong)
            out.objects.push_back(std::move(object));
        else if (ends)
            out.damaged.push_back(number);
        else
            out.cut_short = true;
        text.remove_prefix(size + (ends ? 1 : 0));
    }
    return out;
}

}  // namespace actformer
