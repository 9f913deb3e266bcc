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

class Reader {
  public:
    explicit Reader(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

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
        for (std::size_t d = 0; d < 3; ++d) {
            at_ = skip_blanks(at_, end_);
            const char* stop = at_ < end_ ? parse_number(at_, joint[d]) : nullptr;
            if (!stop || static_cast<unsigned char>(*stop) > ' ' || !(std::abs(joint[d]) < farthest))
                fail("{} where a coordinate in metres should be", in_quotes(token()));
            at_ = stop;
        }
        end_line(3, joint_fields);
    }

    /// Limbs are taken here, in double, so that float32 serves for all that follows.
    void store(SkeletonFile& file, std::string_view id, std::uint32_t frame, const Joints& positions) {
        if (file.bodies.empty()) origin_ = positions[0];
        auto body =
            std::find_if(file.bodies.begin(), file.bodies.end(), [&](const Body& b) { return b.id == id; });
        if (body == file.bodies.end()) {
            body = file.bodies.insert(body, Body{id, {}, {}});
            const auto expected = std::min<std::size_t>(file.frames - frame, 4096);
            body->times.reserve(expected);
            body->limbs.reserve(expected * ntu_joints * 3);
        }
        if (!body->times.empty() && body->times.back() == frame)
            body->limbs.resize(body->limbs.size() - ntu_joints * 3);
        else
            body->times.push_back(frame);
        std::array<float, ntu_joints * 3 + 1>
            limbs;  // four are stored at once, the next joint over the fourth
        for (std::size_t j = 0; j < ntu_joints; ++j) {
            const auto& parent = j == 0 ? origin_ : positions[ntu25_parents[j]];
            for (std::size_t d = 0; d < 4; ++d)
                limbs[3 * j + d] = static_cast<float>(positions[j][d] - parent[d]);
        }
        body->limbs.insert(body->limbs.end(), limbs.begin(), limbs.end() - 1);
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
};

}  // namespace

std::variant<SkeletonFile, Rejection> read_skeleton(std::string_view text) {
    text = without_bom(text);
    if (text.empty()) return Rejection{Rejection::Kind::broken, "an empty file"};
    try {
        return Reader(text).read();
    } catch (const Error& e) {
        return Rejection{Rejection::Kind::broken, e.what()};
    }
}

}  // namespace actformer::ingest
