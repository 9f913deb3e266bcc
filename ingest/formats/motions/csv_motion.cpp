#include "ingest/formats/motions/csv_motion.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.hpp"
#include "base/text/lines.hpp"
#include "base/text/lower_case.hpp"
#include "base/text/number.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t most_numbers = std::uint64_t{1} << 28;  // of one clip: 2 GB

bool same_word(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower_case(x) == lower_case(y); });
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && static_cast<unsigned char>(text.front()) <= ' ') text.remove_prefix(1);
    while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.remove_suffix(1);
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    return text;
}

class Lines {
  public:
    explicit Lines(std::string_view text) : left_(without_bom(text)) {
        const auto first = left_.substr(0, left_.find('\n'));
        for (const char c : {',', ';', '\t'})
            if (separator_ == ' ' && first.find(c) != std::string_view::npos) separator_ = c;
    }

    /// The fields of the next line that is not blank; false at the end.
    bool next(std::vector<std::string_view>& fields) {
        fields.clear();
        while (!left_.empty()) {
            ++number_;
            auto line = left_.substr(0, left_.find('\n'));
            left_.remove_prefix(std::min(left_.size(), line.size() + 1));
            if (trimmed(line).empty()) continue;
            split(line, fields);
            return true;
        }
        return false;
    }

    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
        throw Error("line {}: {}", number_, fmt::format(text, std::forward<Args>(args)...));
    }

    std::uint64_t number() const { return number_; }
    std::size_t bytes_left() const { return left_.size(); }

  private:
    void split(std::string_view line, std::vector<std::string_view>& fields) const {
        if (separator_ == ' ') line = trimmed(line);
        for (;;) {
            const auto end = std::min(line.find(separator_), line.size());
            if (separator_ != ' ' || end > 0) fields.push_back(trimmed(line.substr(0, end)));
            if (end == line.size()) return;
            line.remove_prefix(end + 1);
        }
    }

    std::string_view left_;
    char separator_ = ' ';
    std::uint64_t number_ = 0;
};

/// NaN for an empty field and for nan; false where it is no number.
bool number_of(std::string_view field, double& value) {
    if (field.empty() || same_word(field, "nan") || same_word(field, "na")) {
        value = nothing;
        return true;
    }
    const char* end =
        parse_number(field.data(), value);  // what follows the field in the text is no part of a number
    return end == field.data() + field.size();
}

std::uint64_t count_in(const Lines& lines, std::string_view field, std::string_view what) {
    std::uint64_t value = 0;
    const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
    if (result.ec != std::errc() || result.ptr != field.data() + field.size() ||
        value > std::numeric_limits<std::uint32_t>::max())
        lines.fail("{} is no number of a {}, from 0", in_quotes(field), what);
    return value;
}

double coordinate_in(const Lines& lines, std::string_view field) {
    double value = 0;
    if (!number_of(field, value)) lines.fail("{} where a coordinate should be", in_quotes(field));
    return value;
}

/// 0,1,2,... or 1,2,3,...: as pandas names the columns of an array.
bool numbers_columns(const std::vector<std::string_view>& fields) {
    const std::size_t first = fields[0] == "1" ? 1 : 0;
    for (std::size_t c = 0; c < fields.size(); ++c)
        if (fields[c] != std::to_string(first + c)) return false;
    return true;
}

/// One line a frame.
CsvMotion read_rows(Lines& lines, std::vector<std::string_view>& fields, std::size_t joints) {
    CsvMotion motion;
    motion.joints = joints;
    do {
        if (fields.size() != joints * 3)
            lines.fail(
                "{} numbers, not the {} of {} joints; or name the columns frame,person,joint,x,y,z in line 1",
                fields.size(), joints * 3, joints);
        for (const auto field : fields) motion.positions.push_back(coordinate_in(lines, field));
        ++motion.frames;
    } while (lines.next(fields));
    return motion;
}

/// One line a joint.
class Table {
  public:
    Table(Lines& lines, const std::vector<std::string_view>& header, const std::vector<std::string>& names)
        : lines_(lines), names_(names), width_(header.size()) {
        constexpr std::array<std::string_view, 6> wanted{"frame", "person", "joint", "x", "y", "z"};
        for (std::size_t c = 0; c < wanted.size(); ++c) {
            const auto found = std::find_if(header.begin(), header.end(), [&](std::string_view name) {
                return same_word(name, wanted[c]);
            });
            column_[c] = static_cast<std::size_t>(found - header.begin());
            if (column_[c] == width_ && wanted[c] != "person") lines.fail("no column called {}", wanted[c]);
        }
        for (std::size_t j = 0; j < names.size(); ++j) by_name_.emplace(names[j], j);
    }

    CsvMotion read() {
        std::vector<std::string_view> fields;
        while (lines_.next(fields)) add(fields);
        if (rows_.empty()) lines_.fail("no joint below the line that names the columns");
        return arranged();
    }

  private:
    struct Row {
        std::uint64_t frame, person, joint;
        double at[3];
    };

    void add(const std::vector<std::string_view>& fields) {
        if (fields.size() != width_)
            lines_.fail("{} values, not {} as the first line names columns", fields.size(), width_);
        Row row{count_in(lines_, fields[column_[0]], "frame"),
                column_[1] == width_ ? 0 : count_in(lines_, fields[column_[1]], "person"),
                joint_in(fields[column_[2]]),
                {}};
        for (std::size_t d = 0; d < 3; ++d) row.at[d] = coordinate_in(lines_, fields[column_[3 + d]]);
        last_frame_ = std::max(last_frame_, row.frame);
        last_person_ = std::max(last_person_, row.person);
        rows_.push_back(row);
    }

    std::uint64_t joint_in(std::string_view field) const {
        if (const auto named = by_name_.find(field); named != by_name_.end()) return named->second;
        std::uint64_t joint = 0;
        const auto result = std::from_chars(field.data(), field.data() + field.size(), joint);
        if (result.ec != std::errc() || result.ptr != field.data() + field.size() || joint >= names_.size())
            lines_.fail("no joint {}; there are {} and the numbers 0 to {}", in_quotes(field),
                        fmt::join(names_, ", "), names_.size() - 1);
        return joint;
    }

    CsvMotion arranged() const {
        CsvMotion motion{last_frame_ + 1, last_person_ + 1, names_.size(), {}};
        // Frames and persons that no line speaks of cost memory: as much as a clip may have, and no more than a hundred for each line.
        const auto most_bodies =
            std::min<std::uint64_t>(100 * (rows_.size() + 1), most_numbers / (motion.joints * 3));
        if (motion.frames > most_bodies || motion.persons > most_bodies / motion.frames)
            throw Error(
                "{} frames of {} persons for {} lines: frames and persons are numbered from 0, one by one",
                motion.frames, motion.persons, rows_.size());
        const auto bodies = motion.frames * motion.persons;
        motion.positions.assign(bodies * motion.joints * 3, nothing);
        std::vector<bool> seen(bodies * motion.joints);
        for (const auto& row : rows_) {
            const auto at = (row.frame * motion.persons + row.person) * motion.joints + row.joint;
            if (seen[at])
                throw Error("joint {} of person {} is there twice in frame {}", in_quotes(names_[row.joint]),
                            row.person, row.frame);
            seen[at] = true;
            std::copy(row.at, row.at + 3, &motion.positions[at * 3]);
        }
        return motion;
    }

    Lines& lines_;
    const std::vector<std::string>& names_;
    std::size_t width_;
    std::array<std::size_t, 6> column_{};
    std::unordered_map<std::string_view, std::uint64_t> by_name_;
    std::vector<Row> rows_;
    std::uint64_t last_frame_ = 0, last_person_ = 0;
};

}  // namespace

CsvMotion read_csv_motion(std::string_view text, const std::vector<std::string>& names) {
    Lines lines(text);
    std::vector<std::string_view> fields;
    if (!lines.next(fields)) throw Error("no line in it");
    const bool names_columns = std::any_of(fields.begin(), fields.end(),
                                           [](std::string_view field) { return same_word(field, "joint"); });
    if (names_columns) return Table(lines, fields, names).read();
    double ignored = 0;
    const bool words = std::none_of(fields.begin(), fields.end(),
                                    [&](std::string_view field) { return number_of(field, ignored); });
    const bool numbered = fields.size() == names.size() * 3 && numbers_columns(fields);
    if ((words || numbered) && !lines.next(fields)) lines.fail("no frame below the first line");
    auto motion = read_rows(lines, fields, names.size());
    motion.numbered_columns = numbered;
    return motion;
}

}  // namespace actformer::ingest
