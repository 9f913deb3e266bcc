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
constexpr auto number_key = "line";

/// "line 3", "lines 3, 5".
std::string lines_at(const std::vector<std::size_t>& places) {
    std::vector<std::string> numbers;
    for (const auto place : places) numbers.push_back(std::to_string(place));
    return fmt::format("line{} {}", places.size() == 1 ? "" : "s", few_and_more(numbers, 5));
}

/// Follows the numbers of whole lines through a log.
class Numbering {
  public:
    enum class Says { next, later, earlier };

    /// Of the line that stands at `place`.
    Says of(const nlohmann::ordered_json& object, std::size_t place) {
        const auto found = object.find(number_key);
        if (found == object.end() || !found->is_number_unsigned()) return Says::next;
        const auto said = found->get<std::size_t>(), expected = last_ + (place - place_);
        if (said <= last_) return Says::earlier;
        last_ = said;
        place_ = place;
        return said > expected ? Says::later : Says::next;
    }

  private:
    std::size_t last_ = 0, place_ = 0;  ///< the last number, and where it stood
};

}  // namespace

std::string checked_line(nlohmann::ordered_json object, std::size_t number) {
    object.erase(number_key);
    object[number_key] = number;
    return with_checksum(std::move(object)).dump() + "\n";
}

std::string CheckedLines::fault(const std::filesystem::path& file) const {
    std::vector<std::string> faults;
    if (!missing.empty()) faults.push_back("lines are missing before " + lines_at(missing));
    if (!damaged.empty()) faults.push_back(lines_at(damaged) + ": damaged");
    if (damaged.empty() && cut_short) faults.emplace_back("its last line is cut short");
    return faults.empty() ? "" : fmt::format("{}: {}", file.string(), fmt::join(faults, "; "));
}

CheckedLines read_checked_lines(const std::filesystem::path& path) {
    CheckedLines out;
    if (std::error_code missing; !std::filesystem::exists(path, missing)) return out;
    std::vector<char> scratch;
    auto text = read_text(path, scratch, largest_log);
    Numbering numbering;
    for (std::size_t place = 1; !text.empty(); ++place) {
        const auto size = std::min(text.find('\n'), text.size());
        const bool ends = size < text.size();
        auto object = json_or_discarded<nlohmann::ordered_json>(text.substr(0, size));
        const bool whole = object.is_object() && own_checksum_of(object) != OwnChecksum::wrong;
        const auto said = whole ? numbering.of(object, place) : Numbering::Says::next;
        if (said == Numbering::Says::later) out.missing.push_back(place);
        if (whole && said != Numbering::Says::earlier) {
            object.erase(number_key);
            object.erase("checksum");
            out.objects.push_back(std::move(object));
        } else if (whole || ends) {
            out.damaged.push_back(place);
        } else {
            out.cut_short = true;
        }
        text.remove_prefix(size + (ends ? 1 : 0));
    }
    return out;
}

}  // namespace actformer
