#include "ingest/formats/bvh/bvh_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>
#include <utility>

#include "base/text/number.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/skeletal/text_reader.hpp"

namespace actformer::ingest {
namespace {

using kernels::Channel;

constexpr double largest = 1e9;  // of numbers: what follows from them then stays finite in float32

std::optional<Channel> channel_named(std::string_view word) {
    constexpr std::string_view names[] = {"XPOSITION", "YPOSITION", "ZPOSITION",
                                          "XROTATION", "YROTATION", "ZROTATION"};
    for (std::uint8_t i = 0; i < 6; ++i)
        if (is(word, names[i])) return static_cast<Channel>(i);
    return {};
}

/// HIERARCHY up to MOTION, the ROOTs one after the other. Open joints are followed through their parents, so that no nesting is too deep.
class HierarchyReader {
  public:
    HierarchyReader(TextReader& text, Recording& file) : text_(text), file_(file) {}

    void read() {
        if (!is(text_.peek(), "HIERARCHY"))
            text_.fail("{} in place of HIERARCHY; is this a BVH file?", text_.shown());
        text_.word();
        while (!is(text_.peek(), "MOTION") || open_ >= 0) read_entry();
        if (file_.joints.empty()) text_.fail("no ROOT before MOTION");
        if (file_.channels == 0) text_.fail("no joint has a channel");
        text_.word();
    }

  private:
    void read_entry() {
        const auto word = text_.peek();
        if (is(word, "ROOT") && open_ < 0) return begin_root();
        if (open_ < 0)
            text_.fail("{} in place of {}", text_.shown(), file_.joints.empty() ? "ROOT" : "MOTION");
        if (word.empty() || is(word, "MOTION"))
            text_.fail("{} inside joint {}: a {{ without its }}", text_.shown(), name_of(open_));
        const bool end_site = file_.joints[open_].end_site;
        if (is(word, "JOINT") && !end_site) return begin_joint(false);
        if (is(word, "END") && !end_site) return begin_joint(true);
        if (is(word, "OFFSET")) return read_offset();
        if (is(word, "CHANNELS")) return read_channels();
        if (word != "}") text_.fail("{} in place of OFFSET, CHANNELS, JOINT, End Site or }}", text_.shown());
        if (!has_offset_[open_]) text_.fail("joint {} has no OFFSET", name_of(open_));
        text_.word();
        open_ = file_.joints[open_].parent;
    }

    void begin_root() {
        names_.clear();
        begin_joint(false);
    }

    void begin_joint(bool end_site) {
        const char* start = text_.at();
        text_.word();
        const auto name = text_.rest_of_line();  // of an end site: the word Site
        RecordedJoint joint;
        joint.parent = open_;
        joint.end_site = end_site;
        joint.first_channel = file_.channels;
        if (!end_site) {
            joint.name = printable(name);
            if (name.empty()) throw TextFault{start, "a joint without a name"};
            if (!names_.insert(joint.name).second)
                throw TextFault{start, fmt::format("a second joint {}", in_quotes(name))};
        }
        if (file_.joints.size() == most_joints)
            throw TextFault{start, fmt::format("more than {} joints", most_joints)};
        if (text_.peek() != "{") text_.fail("{} in place of {{", text_.shown());
        text_.word();
        open_ = static_cast<int>(file_.joints.size());
        file_.joints.push_back(std::move(joint));
        has_offset_.push_back(false);
        has_channels_.push_back(false);
    }

    void read_offset() {
        if (has_offset_[open_]) text_.fail("a second OFFSET of joint {}", name_of(open_));
        text_.word();
        for (auto& o : file_.joints[open_].offset) o = text_.number("an offset", largest);
        has_offset_[open_] = true;
    }

    void read_channels() {
        if (has_channels_[open_]) text_.fail("a second CHANNELS of joint {}", name_of(open_));
        // Channels are numbered in the order of the frames' numbers, which is that of the joints.
        if (open_ + 1 != static_cast<int>(file_.joints.size())) text_.fail("CHANNELS after a child joint");
        text_.word();
        const char* start = text_.at();
        const double count = text_.number("a number of channels", largest);
        RecordedJoint& joint = file_.joints[open_];
        const bool fits = count >= 0 && count <= 6 && count == std::floor(count);
        if (!fits || (joint.end_site && count > 0))
            throw TextFault{start, fmt::format("{} channels of {}, not {}", count, name_of(open_),
                                               joint.end_site ? "0" : "a whole number up to 6")};
        for (int i = 0; i < static_cast<int>(count); ++i) joint.channels.push_back(read_channel(joint, i));
        if (channel_named(text_.peek())) text_.fail("more than the {} channels announced", count);
        file_.channels += static_cast<std::uint32_t>(count);
        has_channels_[open_] = true;
    }

    Channel read_channel(const RecordedJoint& joint, int i) {
        const auto channel = channel_named(text_.peek());
        if (!channel)
            text_.fail(
                "{} in place of channel {}, one of Xposition Yposition Zposition Xrotation Yrotation "
                "Zrotation",
                text_.shown(), i + 1);
        // Two rotations about one axis are Euler angles as in ZXZ; two positions on one contradict each
        // other.
        const auto& before = joint.channels;
        if (*channel < Channel::x_rotation &&
            std::find(before.begin(), before.end(), *channel) != before.end())
            text_.fail("channel {} twice", text_.shown());
        text_.word();
        return *channel;
    }

    std::string name_of(int joint) const {
        const RecordedJoint& j = file_.joints[joint];
        return j.end_site ? fmt::format("the End Site of {}", in_quotes(file_.joints[j.parent].name))
                          : in_quotes(j.name);
    }

    TextReader& text_;
    Recording& file_;
    int open_ = -1;  ///< the joint whose braces we are in
    std::vector<bool> has_offset_, has_channels_;
    std::unordered_set<std::string> names_;  ///< below the ROOT in hand
};

/// Frames, frame time and the numbers, one line a frame.
class MotionReader {
  public:
    MotionReader(TextReader& text, Recording& file) : text_(text), file_(file) {}

    void read() {
        read_frames();
        read_frame_time();
        std::vector<double> row(file_.channels), origin(file_.channels, 0);
        file_.values.resize(std::size_t{file_.channels} * file_.frames);
        for (std::uint32_t f = 0; f < file_.frames; ++f) {
            read_frame(f, row);
            if (f == 0) set_origin(row, origin);
            float* value = &file_.values[f];
            for (std::uint32_t c = 0; c < file_.channels; ++c, value += file_.frames)
                *value = static_cast<float>(row[c] - origin[c]);
        }
        text_.skip_blanks();
        if (!text_.at_end()) text_.fail("{} after the {} frames announced", text_.shown(), file_.frames);
    }

  private:
    /// `first`, `second` (or none) and a colon, in one word or several.
    void keyword(std::string_view first, std::string_view second, const char* whole) {
        const char* start = (text_.skip_blanks(), text_.at());
        for (const auto part : {first, second}) {
            text_.skip_spaces();
            if (text_.left() < part.size() || !is({text_.at(), part.size()}, part)) {
                text_.move_to(start);
                text_.fail("{} in place of {}", text_.shown(), whole);
            }
            text_.move_to(text_.at() + part.size());
        }
        text_.skip_spaces();
        if (*text_.at() != ':') text_.fail("{} in place of the : of {}", text_.shown(), whole);
        text_.move_to(text_.at() + 1);
    }

    void read_frames() {
        keyword("FRAMES", "", "Frames:");
        text_.skip_blanks();
        const char* start = text_.at();
        const double frames = text_.number("a number of frames", 1e300);
        if (frames < 1 || frames != std::floor(frames))
            throw TextFault{start, fmt::format("{} frames, not a whole number of 1 or more", frames)};
        // A number takes two characters, blank included. Believe no more than that before making room for
        // them.
        if (frames * file_.channels * 2 > static_cast<double>(text_.left()) + 1 || frames > 4e9)
            throw TextFault{
                start, fmt::format("{} frames of {} numbers do not fit in the {} bytes that follow", frames,
                                   file_.channels, text_.left())};
        file_.frames = static_cast<std::uint32_t>(frames);
    }

    void read_frame_time() {
        keyword("FRAME", "TIME", "Frame Time:");
        text_.skip_blanks();
        const char* start = text_.at();
        const auto shown = text_.shown();
        file_.frame_time = text_.number("a frame time", 1e300);
        if (!(file_.frame_time >= 1e-5 && file_.frame_time <= 1))
            throw TextFault{start, fmt::format("frame time {}, not between 0.00001 and 1 seconds", shown)};
        text_.skip_spaces();
        if (!text_.at_end() && *text_.at() != '\n') text_.fail("{} after the frame time", text_.shown());
    }

    void read_frame(std::uint32_t frame, std::vector<double>& row) {
        text_.skip_blanks();
        if (text_.at_end()) text_.fail("the text ends after {} of {} frames", frame, file_.frames);
        const char* p = text_.at();
        for (std::size_t c = 0; c < row.size(); ++c) {
            while (is_space(*p)) ++p;
            const char* end = parse_number(p, row[c]);
            if (!end || static_cast<unsigned char>(*end) > ' ') refuse_number(p, c);
            if (std::abs(row[c]) > 360) row[c] = reduced(p, c, row[c]);
            p = end;
        }
        while (is_space(*p)) ++p;
        text_.move_to(p);
        if (*p != '\n' && !text_.at_end()) refuse_extra(p);
    }

    /// Whole turns matter not, and cost float32 its precision.
    double reduced(const char* p, std::size_t c, double value) {
        text_.move_to(p);
        if (std::abs(value) > largest) text_.fail("{} is too large", text_.shown());
        if (rotation_.empty())
            for (const auto& joint : file_.joints)
                for (const auto channel : joint.channels) rotation_.push_back(channel >= Channel::x_rotation);
        return rotation_[c] ? std::remainder(value, 360) : value;
    }

    [[noreturn]] void refuse_number(const char* p, std::size_t before) {
        text_.move_to(p);
        if (text_.at_end() || *p == '\n') text_.fail("{} numbers, not {}", before, file_.channels);
        text_.fail("{} is not a number", text_.shown());
    }

    [[noreturn]] void refuse_extra(const char* p) {
        std::size_t numbers = file_.channels;
        for (text_.move_to(p); !text_.at_end() && *text_.at() != '\n'; text_.skip_spaces(), ++numbers)
            if (text_.word().empty()) break;
        text_.move_to(p);
        text_.fail("{} numbers, not {}", numbers, file_.channels);
    }

    /// Positions of the roots count from where they are in the first frame.
    void set_origin(const std::vector<double>& row, std::vector<double>& origin) {
        for (auto& joint : file_.joints) {
            if (joint.parent >= 0) continue;
            for (std::size_t c = 0; c < joint.channels.size(); ++c) {
                if (!is_position(joint.channels[c])) continue;
                const std::size_t column = joint.first_channel + c;
                origin[column] = row[column];
                joint.offset[axis_of(joint.channels[c])] = row[column];
            }
        }
    }

    TextReader& text_;
    Recording& file_;
    std::vector<bool> rotation_;  ///< (channels) once asked for
};

/// The skeletons apart: joints and channels of each lie together. A root's OFFSET, where its position channels left any of it, tells
/// where it stands in the first frame.
std::vector<Recording> separate(Recording file) {
    std::vector<std::size_t> first;
    for (std::size_t j = 0; j < file.joints.size(); ++j)
        if (file.joints[j].parent < 0) first.push_back(j);
    first.push_back(file.joints.size());
    std::vector<Recording> persons;
    for (std::size_t p = 0; p + 1 < first.size(); ++p) {
        Recording person{{}, 0, file.frames, file.frame_time, {}, {}};
        const std::uint32_t first_channel = file.joints[first[p]].first_channel;
        for (std::size_t j = first[p]; j < first[p + 1]; ++j) {
            auto joint = std::move(file.joints[j]);
            if (joint.parent >= 0) joint.parent -= static_cast<int>(first[p]);
            joint.first_channel -= first_channel;
            person.channels += static_cast<std::uint32_t>(joint.channels.size());
            person.joints.push_back(std::move(joint));
        }
        person.origin = std::exchange(person.joints[0].offset, {});
        const auto begin =
            file.values.begin() + static_cast<std::ptrdiff_t>(std::size_t{first_channel} * file.frames);
        const auto size = static_cast<std::ptrdiff_t>(std::size_t{person.channels} * file.frames);
        if (first.size() == 2)
            person.values = std::move(file.values);
        else
            person.values.assign(begin, begin + size);
        persons.push_back(std::move(person));
    }
    return persons;
}

}  // namespace

std::variant<std::vector<Recording>, Rejection> parse_bvh(std::string_view text) {
    return read_text_with(text, [](TextReader& reader) {
        Recording file;
        HierarchyReader(reader, file).read();
        MotionReader(reader, file).read();
        return separate(std::move(file));
    });
}

}  // namespace actformer::ingest
