#include "ingest/formats/gta/jta_file.hpp"

#include <array>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/text/number.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/gta/gta_skeleton.hpp"

namespace actformer::ingest {
namespace {

constexpr std::size_t numbers_a_row = 10;
constexpr double most_frames = 1 << 20, farthest_joint = 1e6;  // metres
constexpr std::uint32_t all_joints = (std::uint32_t{1} << gta_joints) - 1;

/// A person in a frame.
struct Body {
    std::uint32_t seen = 0;  ///< bit j: joint j
    std::array<double, gta_joints * 3> positions{};
};

class Reader {
  public:
    explicit Reader(std::string_view text) : p_(text.data()), end_(text.data() + text.size()) {}

    JtaFile read() {
        expect('[');
        if (!next_is(']')) do {
                read_row();
                ++row_;
            } while (follows(','));
        expect(']');
        skip_blanks();
        if (p_ != end_) fail("more behind the list of rows");
        return gathered();
    }

  private:
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
        throw Error("row {}: {}", row_, fmt::format(reason, std::forward<Args>(args)...));
    }

    void skip_blanks() {
        while (p_ != end_ && (*p_ == ' ' || *p_ == '\n' || *p_ == '\t' || *p_ == '\r')) ++p_;
    }
    bool next_is(char c) {
        skip_blanks();
        return p_ != end_ && *p_ == c;
    }
    bool follows(char c) {
        if (!next_is(c)) return false;
        ++p_;
        return true;
    }
    void expect(char c) {
        if (!follows(c))
            fail("{} in place of '{}'", p_ == end_ ? "the end of the text" : in_quotes({p_, 1}), c);
    }

    double number() {
        skip_blanks();
        double value = 0;
        const char* after = p_ == end_ ? nullptr : parse_number(p_, value);
        if (!after || after > end_)
            fail("{} in place of a number", p_ == end_ ? "the end of the text" : in_quotes({p_, 1}));
        p_ = after;
        return value;
    }

    std::int64_t whole(double value, double most, const char* what) const {
        if (!(value >= 0 && value <= most && value == std::floor(value))) fail("{} is no {}", value, what);
        return static_cast<std::int64_t>(value);
    }

    void read_row() {
        std::array<double, numbers_a_row> row{};
        expect('[');
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (i > 0) expect(',');
            row[i] = number();
        }
        expect(']');
        const auto frame = whole(row[0], most_frames, "number of a frame");
        const auto person = whole(row[1], 1e15, "number of a person");
        const auto joint = static_cast<std::size_t>(whole(row[2], gta_joints - 1, "joint of JTA's 22"));
        auto& body = bodies_[person][frame];
        if (body.seen >> joint & 1)
            fail("joint {} of person {} comes twice in frame {}", joint, person, frame);
        body.seen |= std::uint32_t{1} << joint;
        for (std::size_t d = 0; d < 3; ++d) {
            if (!(std::abs(row[5 + d]) <= farthest_joint)) fail("{} is no position in metres", row[5 + d]);
            body.positions[3 * joint + d] = row[5 + d];
        }
        first_ = std::min(first_, frame);
        last_ = std::max(last_, frame);
    }

    JtaFile gathered() const {
        JtaFile out;
        if (bodies_.empty()) return out;
        out.frames = static_cast<std::uint32_t>(last_ - first_ + 1);
        for (const auto& [id, frames] : bodies_) {
            JtaPerson person{id, {}, {}};
            for (const auto& [frame, body] : frames) {
                if (body.seen != all_joints) continue;
                person.times.push_back(static_cast<std::uint32_t>(frame - first_));
                person.positions.insert(person.positions.end(), body.positions.begin(), body.positions.end());
            }
            if (person.times.empty())
                ++out.incomplete;
            else
                out.persons.push_back(std::move(person));
        }
        return out;
    }

    const char* p_;
    const char* end_;
    std::size_t row_ = 0;
    std::map<std::int64_t, std::map<std::int64_t, Body>> bodies_;  ///< by person and frame
    std::int64_t first_ = std::int64_t{1} << 40, last_ = 0;
};

}  // namespace

std::variant<JtaFile, Rejection> read_jta(std::string_view text) {
    Reader reader(text);
    try {
        return reader.read();
    } catch (const Error& e) {
        return Rejection{Rejection::Kind::broken, e.what()};
    }
}

}  // namespace actformer::ingest
