#include "ingest/formats/ntu/skeleton_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/text/lines.hpp"
#include "base/text/number.hpp"
#include "base/text/printable.hpp"
#include "base/text/three_numbers.hpp"

namespace actformer::ingest {
namespace {

constexpr int joint_fields = 12;
constexpr int body_fields = 10;
constexpr double farthest = 1e6;  // metres; float32 limbs stay finite and exact enough far beyond any room

using Joints = std::array<Point, ntu_joints>;

// How far ahead text is asked for. The length of a line is known only once it is there, so that it would be waited for.
constexpr std::ptrdiff_t ahead = 1024;

/// A joint's line as it nearly always is: twelve fields on 65 to 128 characters, the first three numbers. Moves `line` past
/// it. False for any other line, however sound.
inline bool read_plain_joint(const char*& line, const char* end, Point& joint) {
    if (end - line < 128) return false;
    __builtin_prefetch(line + ahead);
    __builtin_prefetch(line + ahead + 64);
    const auto low = masks_of_64(line), high = masks_of_64(line + 64);
    if (low.newline != 0 || high.newline == 0) return false;
    const auto begins = ~low.blank & (low.blank << 1 | 1);
    const auto later =
        ~high.blank & (high.blank << 1 | low.blank >> 63) & ((high.newline - 1) & ~high.newline);
    if (std::popcount(begins) + std::popcount(later) != joint_fields) return false;
    if (!read_three_plainly(line, low.blank, joint)) return false;
    line += 64 + std::countr_zero(high.newline) + 1;
    return true;
}

bool is_none(const Point& joint) {
    return joint[0] == 0 && joint[1] == 0 && joint[2] == 0;
}

/// How many of the joints are none.
std::size_t missing(const Joints& joints) {
    std::size_t count = 0;
    for (const auto& joint : joints) count += is_none(joint);
    return count;
}

/// Puts joint `j` where it is none: linearly between the frames around, held at the ends. False where no frame shows it.
bool fill(std::vector<Joints>& poses, const std::vector<std::uint32_t>& times, std::size_t j) {
    std::size_t before = poses.size();  // the last that shows it; none so far
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (is_none(poses[i][j])) continue;
        const auto& after = poses[i][j];
        for (std::size_t gap = before == poses.size() ? 0 : before + 1; gap < i; ++gap)
            for (std::size_t d = 0; d < 3; ++d) {
                if (before == poses.size()) {
                    poses[gap][j][d] = after[d];
                    continue;
                }
                const double from = poses[before][j][d],
                             part = static_cast<double>(times[gap] - times[before]) /
                                    static_cast<double>(times[i] - times[before]);
                poses[gap][j][d] = from + (after[d] - from) * part;
            }
        before = i;
    }
    for (std::size_t i = before + 1; i < poses.size(); ++i) poses[i][j] = poses[before][j];
    return before < poses.size();
}

void append_limbs(std::vector<float>& limbs, const Joints& positions, const Point& origin) {
    std::array<float, ntu_joints * 3 + 1> row;  // four are stored at once, the next joint over the fourth
    for (std::size_t j = 0; j < ntu_joints; ++j) {
        const auto& parent = j == 0 ? origin : positions[ntu25_parents[j]];
        for (std::size_t d = 0; d < 4; ++d) row[3 * j + d] = static_cast<float>(positions[j][d] - parent[d]);
    }
    limbs.insert(limbs.end(), row.begin(), row.end() - 1);
}

class Reader {
  public:
    /// `keep_positions`: limbs are taken at the end, when joints that are none have been filled.
    Reader(std::string_view text, bool keep_positions)
        : at_(text.data()), end_(text.data() + text.size()), keep_positions_(keep_positions) {}

    /// Whether a joint of a body that was seen is none: it takes a reading with `keep_positions`.
    bool lacks_joints() const { return lacks_joints_; }

    SkeletonFile read() {
        SkeletonFile file;
        const auto frames = count("frames");
        if (frames > static_cast<std::uint64_t>(end_ - at_) ||
            frames > std::numeric_limits<std::uint32_t>::max())
            fail("{} frames cannot be in this file: cut short, or not a skeleton file", frames);
        file.frames = static_cast<std::uint32_t>(frames);
        for (std::uint32_t frame = 0; frame < file.frames; ++frame) {
            place_ = frame;
            const auto bodies = count("bodies");
            for (std::uint64_t b = 0; b < bodies; ++b) read_body(file, frame);
        }
        refuse_leftovers();
        if (keep_positions_) fill_joints(file);
        return file;
    }

  private:
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
        throw Error("line {}: {}", line_, fmt::format(text, std::forward<Args>(args)...));
    }

    /// Begins the next line; `what` names what it should hold.
    void begin_line(std::string_view what) {
        if (at_ >= end_)
            throw Error("ends after line {}, in frame {}, where {} should be: cut short", line_, place_,
                        what);
        ++line_;
        at_ = skip_blanks(at_, end_);
    }

    void end_line(int fields_so_far, int fields_wanted) {
        int more = 0;
        at_ = end_of_line(at_, end_, more);
        if (fields_so_far + more != fields_wanted) {
            if (at_ == end_)
                fail("{} fields, not {}: the file is cut short", fields_so_far + more, fields_wanted);
            fail("{} fields, not {}", fields_so_far + more, fields_wanted);
        }
        at_ += at_ < end_;
    }

    std::string_view token() const {
        const char* stop = at_;
        while (stop<end_&& static_cast<unsigned char>(*stop)> ' ') ++stop;
        return {at_, static_cast<std::size_t>(stop - at_)};
    }

    std::uint64_t count(std::string_view what) {
        begin_line(what);
        std::uint64_t value = 0;
        const auto [stop, error] = std::from_chars(at_, end_, value);
        if (error != std::errc() || (stop<end_&& static_cast<unsigned char>(*stop)> ' '))
            fail("{} where the number of {} should be", in_quotes(token()), what);
        at_ = stop;
        end_line(1, 1);
        return value;
    }

    void read_body(SkeletonFile& file, std::uint32_t frame) {
        begin_line("a body");
        const auto id = token();
        at_ += id.size();
        end_line(1, body_fields);
        const auto joints = count("joints");
        if (joints != ntu_joints) fail("{} joints, not {}", joints, ntu_joints);
        Joints positions;
        read_joints(positions);
        store(file, id, frame, positions);
    }

    void read_joints(Joints& positions) {
        for (std::size_t joint = 0; joint < ntu_joints;) {
            joint = read_plain_joints(positions, joint);
            if (joint < ntu_joints) read_odd_joint(positions[joint++]);
        }
    }

    /// As many as come, from joint `first` on; tells which comes next. Calls nothing, so that constants stay in registers.
    std::size_t read_plain_joints(Joints& positions, std::size_t first) {
        const char* at = at_;
        auto joint = first;
        while (joint < ntu_joints && read_plain_joint(at, end_, positions[joint])) ++joint;
        line_ += joint - first;
        at_ = at;
        return joint;
    }

    /// Field by field, to take what is unusual and to name what is wrong.
    void read_odd_joint(Point& joint) {
        begin_line("a joint");
        bool none = false;
        for (std::size_t d = 0; d < 3; ++d) {
            at_ = skip_blanks(at_, end_);
            if (const auto word = token(); is_nan(word)) {
                none = true;
                at_ += word.size();
                continue;
            }
            const char* stop = at_ < end_ ? parse_number(at_, joint[d]) : nullptr;
            if (!stop || static_cast<unsigned char>(*stop) > ' ' || !(std::abs(joint[d]) < farthest))
                fail("{} where a coordinate in metres should be", in_quotes(token()));
            at_ = stop;
        }
        if (none) joint = {};
        end_line(3, joint_fields);
    }

    /// As in "NaN", "-nan" or "-nan(ind)".
    static bool is_nan(std::string_view word) {
        if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
        const auto same = [&](std::size_t i, char lower) { return (word[i] | 0x20) == lower; };
        return word.size() >= 3 && same(0, 'n') && same(1, 'a') && same(2, 'n') &&
               (word.size() == 3 || word[3] == '(');
    }

    /// Limbs are taken here, in double, so that float32 serves for all that follows.
    void store(SkeletonFile& file, std::string_view id, std::uint32_t frame, const Joints& positions) {
        if (const auto none = missing(positions); none > 0) {
            file.filled = true;
            if (none == ntu_joints) return;
            lacks_joints_ = true;
        }
        if (file.bodies.empty()) origin_ = positions[0];
        auto& body = body_called(file, id, frame);
        const bool again = !body.times.empty() && body.times.back() == frame;
        if (!again) body.times.push_back(frame);
        if (keep_positions_) {
            auto& poses = poses_[static_cast<std::size_t>(&body - file.bodies.data())];
            if (again) poses.pop_back();
            poses.push_back(positions);
            return;
        }
        if (again) body.limbs.resize(body.limbs.size() - ntu_joints * 3);
        append_limbs(body.limbs, positions, origin_);
    }

    Body& body_called(SkeletonFile& file, std::string_view id, std::uint32_t frame) {
        for (auto& body : file.bodies)
            if (body.id == id) return body;
        auto& body = file.bodies.emplace_back(Body{id, {}, {}});
        const auto expected = std::min<std::size_t>(file.frames - frame, 4096);
        body.times.reserve(expected);
        if (keep_positions_)
            poses_.emplace_back().reserve(expected);
        else
            body.limbs.reserve(expected * ntu_joints * 3);
        return body;
    }

    /// Makes limbs of the positions kept.
    void fill_joints(SkeletonFile& file) {
        std::vector<Body> whole;
        for (std::size_t b = 0; b < poses_.size(); ++b) {
            auto& body = file.bodies[b];
            std::size_t whole_joints = 0;
            while (whole_joints < ntu_joints && fill(poses_[b], body.times, whole_joints)) ++whole_joints;
            if (whole_joints < ntu_joints) {
                file.never_seen.push_back(whole_joints);
                continue;
            }
            if (whole.empty()) origin_ = poses_[b][0][0];
            for (const auto& pose : poses_[b]) append_limbs(body.limbs, pose, origin_);
            whole.push_back(std::move(body));
        }
        file.bodies = std::move(whole);
    }

    void refuse_leftovers() {
        while (at_ < end_) {
            ++line_;
            int fields = 0;
            at_ = end_of_line(at_, end_, fields);
            if (fields) fail("text after the last frame that line 1 counts");
            ++at_;
        }
    }

    const char* at_;
    const char* end_;
    std::uint64_t line_ = 0;
    std::uint32_t place_ = 0;
    Point origin_{};
    bool keep_positions_, lacks_joints_ = false;
    std::vector<std::vector<Joints>> poses_;  ///< of each body, where they are kept
};

}  // namespace

std::variant<SkeletonFile, Rejection> read_skeleton(std::string_view text) {
    text = without_bom(text);
    if (text.empty()) return Rejection{Rejection::Kind::broken, "an empty file"};
    try {
        Reader reader(text, false);
        auto file = reader.read();
        return reader.lacks_joints() ? Reader(text, true).read() : std::move(file);
    } catch (const Error& e) {
        return Rejection{Rejection::Kind::broken, e.what()};
    }
}

}  // namespace actformer::ingest
