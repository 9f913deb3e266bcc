#include "ingest/formats/asf/amc_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ingest/formats/skeletal/text_reader.hpp"

namespace actformer::ingest {
namespace {

using kernels::Channel;

constexpr double largest = 1e9;
constexpr std::size_t most_frames = std::size_t{1} << 24;

/// The turn that `channels` with `values` make, the first first.
Matrix3 turn_of(const std::vector<Channel>& channels, const double* values, double degrees) {
    Matrix3 m = identity3;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (!is_position(channels[c])) m = rotation_about(axis_of(channels[c]), values[c] * degrees) * m;
    return m;
}

/// Degrees about z, y and x, of which m = Rz Ry Rx.
Vector3 angles_of(const Matrix3& m) {
    const double cosine = std::hypot(m[0][0], m[1][0]);
    constexpr double degrees = 180 / std::numbers::pi;
    const double y = std::atan2(-m[2][0], cosine) * degrees;
    if (cosine < 1e-9) return {0, y, std::atan2(-m[1][2], m[1][1]) * degrees};
    return {std::atan2(m[1][0], m[0][0]) * degrees, y, std::atan2(m[2][1], m[2][2]) * degrees};
}

const std::vector<Channel> turns_zyx{Channel::z_rotation, Channel::y_rotation, Channel::x_rotation};

class AmcReader {
  public:
    AmcReader(TextReader& text, const AsfSkeleton& skeleton)
        : text_(text), skeleton_(skeleton), degrees_(skeleton.radians_to_degrees) {
        first_.push_back(0);
        std::size_t numbers = skeleton.root_channels.size();
        for (const auto& bone : skeleton.bones) {
            first_.push_back(numbers);
            numbers += bone.channels.size();
        }
        row_.resize(numbers);
        seen_.resize(first_.size());
    }

    Recording read() {
        read_head();
        while (text_.skip_blanks(), !text_.at_end()) read_frame();
        if (frames_ == 0) text_.fail("no frame; is this an .amc file?");
        return recording();
    }

  private:
    void read_head() {
        for (text_.skip_blanks(); !text_.at_end() && (*text_.at() == '#' || *text_.at() == ':');
             text_.skip_blanks()) {
            if (is(text_.peek(), ":RADIANS")) degrees_ = 180 / std::numbers::pi;
            if (is(text_.peek(), ":DEGREES")) degrees_ = 1;
            text_.skip_line();
        }
    }

    void read_frame() {
        const char* start = text_.at();
        const double number = text_.number("a frame's number", 1e9);
        if (text_.more_on_line()) text_.fail("{} after the number of a frame", text_.shown());
        if (frames_ > 0 && number != last_number_ + 1)
            throw TextFault{start, fmt::format("frame {} follows frame {}", number, last_number_)};
        if (frames_ == most_frames) throw TextFault{start, "too many frames"};
        last_number_ = number;
        std::fill(seen_.begin(), seen_.end(), false);
        std::size_t expected = 0;  // bones come in one order in all frames
        for (text_.skip_blanks(); !text_.at_end() && !starts_number(); text_.skip_blanks())
            read_bone(frames_ == 0 ? order_.size() : expected++);
        check_seen(start);
        append_row();
        ++frames_;
    }

    bool starts_number() const { return (*text_.at() >= '0' && *text_.at() <= '9') || *text_.at() == '-'; }

    /// `place` in the frame: where the first frame had a bone of this name too, no name need be looked up.
    void read_bone(std::size_t place) {
        const char* start = text_.at();
        const auto name = text_.word();
        std::size_t bone =
            place < order_.size() && name_of(order_[place]) == name ? order_[place] : find(name, start);
        if (frames_ == 0) order_.push_back(bone);
        if (seen_[bone])
            throw TextFault{start, fmt::format("{} twice in frame {}", in_quotes(name), last_number_)};
        seen_[bone] = true;
        const auto& channels = channels_of(bone);
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (!text_.more_on_line())
                text_.fail("{} numbers of {}, not {}", c, in_quotes(name), channels.size());
            double& value = row_[first_[bone] + c];
            value = text_.number("a number", largest);
            if (!is_position(channels[c])) value = std::remainder(value, 360 / degrees_);
        }
        if (text_.more_on_line())
            text_.fail("more than the {} numbers of {}", channels.size(), in_quotes(name));
    }

    /// 0 is the root, b + 1 bone b.
    std::string_view name_of(std::size_t bone) const {
        return bone == 0 ? std::string_view("root") : skeleton_.bones[bone - 1].name;
    }
    const std::vector<Channel>& channels_of(std::size_t bone) const {
        return bone == 0 ? skeleton_.root_channels : skeleton_.bones[bone - 1].channels;
    }

    std::size_t find(std::string_view name, const char* at) const {
        const auto wanted = printable(name);
        for (std::size_t b = 0; b < first_.size(); ++b)
            if (name_of(b) == wanted) return b;
        throw TextFault{at, fmt::format("the skeleton has no bone {}", in_quotes(name))};
    }

    void check_seen(const char* start) const {
        for (std::size_t b = 0; b < seen_.size(); ++b)
            if (!seen_[b] && !channels_of(b).empty())
                throw TextFault{start,
                                fmt::format("frame {} has no numbers of '{}'", last_number_, name_of(b))};
    }

    /// Place of the root, then z, y and x of the root and of every bone that turns.
    void append_row() {
        Vector3 place = skeleton_.root_position;
        for (std::size_t c = 0; c < skeleton_.root_channels.size(); ++c)
            if (is_position(skeleton_.root_channels[c]))
                place[axis_of(skeleton_.root_channels[c])] += row_[c];
        if (frames_ == 0) origin_ = place;
        for (std::size_t d = 0; d < 3; ++d) rows_.push_back(static_cast<float>(place[d] - origin_[d]));
        append_turn(skeleton_.root_axes, skeleton_.root_channels, row_.data());
        for (std::size_t b = 0; b < skeleton_.bones.size(); ++b)
            if (!skeleton_.bones[b].channels.empty())
                append_turn(skeleton_.bones[b].axes, skeleton_.bones[b].channels, &row_[first_[b + 1]]);
    }

    void append_turn(const Matrix3& axes, const std::vector<Channel>& channels, const double* values) {
        for (const double angle : angles_of(axes * turn_of(channels, values, degrees_) * transposed(axes)))
            rows_.push_back(static_cast<float>(angle));
    }

    Recording recording() {
        Recording out;
        out.frames = static_cast<std::uint32_t>(frames_);
        out.frame_time = amc_frame_time;
        out.origin = origin_;
        RecordedJoint root;
        root.name = "root";
        root.channels = {Channel::x_position, Channel::y_position, Channel::z_position,
                         Channel::z_rotation, Channel::y_rotation, Channel::x_rotation};
        out.channels = 6;
        out.joints.push_back(std::move(root));
        std::vector<int> end(skeleton_.bones.size());  // a bone's end among the joints
        for (std::size_t b = 0; b < skeleton_.bones.size(); ++b) {
            const auto& bone = skeleton_.bones[b];
            append_joints(bone, bone.parent < 0 ? 0 : end[bone.parent], out);
            end[b] = static_cast<int>(out.joints.size()) - 1;
        }
        out.values.resize(rows_.size());
        for (std::size_t f = 0; f < frames_; ++f)
            for (std::size_t c = 0; c < out.channels; ++c)
                out.values[c * frames_ + f] = rows_[f * out.channels + c];
        return out;
    }

    /// A pivot at its start, where the bone turns, and the joint at its end.
    static void append_joints(const AsfBone& bone, int parent, Recording& out) {
        RecordedJoint joint;
        joint.parent = parent;
        joint.first_channel = out.channels;
        if (!bone.channels.empty()) {
            RecordedJoint pivot = joint;
            pivot.pivot = true;
            pivot.channels = turns_zyx;
            out.channels += 3;
            joint.parent = static_cast<int>(out.joints.size());
            joint.first_channel = out.channels;
            out.joints.push_back(std::move(pivot));
        }
        joint.name = bone.name;
        joint.offset = bone.stick;
        out.joints.push_back(std::move(joint));
    }

    TextReader& text_;
    const AsfSkeleton& skeleton_;
    double degrees_;                  ///< a unit of angles
    std::vector<std::size_t> first_;  ///< of the root and of each bone, in row_
    std::vector<double> row_;         ///< the frame's numbers
    std::vector<bool> seen_;          ///< in the frame: the root and each bone
    std::vector<std::size_t> order_;  ///< of the first frame
    std::vector<float> rows_;         ///< (frames, channels)
    std::size_t frames_ = 0;
    double last_number_ = 0;
    Vector3 origin_{};
};

}  // namespace

std::variant<Recording, Rejection> parse_amc(std::string_view text, const AsfSkeleton& skeleton) {
    return read_text_with(text, [&](TextReader& reader) { return AmcReader(reader, skeleton).read(); });
}

}  // namespace actformer::ingest
