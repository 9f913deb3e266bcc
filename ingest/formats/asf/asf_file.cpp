#include "ingest/formats/asf/asf_file.hpp"

#include <algorithm>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "ingest/formats/skeletal/text_reader.hpp"

namespace actformer::ingest {
namespace {

using kernels::Channel;

constexpr std::size_t most_bones = 1024;
constexpr double largest_length = 1e6;  // of lengths, so that their sums stay finite in float32

/// "RX", "TY" and the like.
std::optional<Channel> channel_named(std::string_view word) {
    constexpr std::string_view names[] = {"TX", "TY", "TZ", "RX", "RY", "RZ"};
    for (std::uint8_t i = 0; i < 6; ++i)
        if (is(word, names[i])) return static_cast<Channel>(i);
    return {};
}

class AsfReader {
  public:
    explicit AsfReader(TextReader& text) : text_(text) {}

    AsfSkeleton read() {
        for (text_.skip_blanks(); !text_.at_end(); text_.skip_blanks()) read_section();
        if (out_.root_channels.empty()) text_.fail("no :root section with an order; is this an .asf file?");
        if (bones_.empty()) text_.fail("no bone in a :bonedata section");
        put_in_order();
        finish_axes();
        return std::move(out_);
    }

  private:
    /// A bone as its lines have it.
    struct Entry {
        AsfBone bone;
        Vector3 direction{}, angles{};
        double length = 0;
        std::array<std::size_t, 3> order{0, 1, 2};
        std::vector<std::size_t> children;
        bool placed = false;
    };

    void read_section() {
        const auto word = text_.word();
        if (is(word, ":UNITS")) return read_lines([this](std::string_view w) { read_unit(w); });
        if (is(word, ":ROOT")) return read_lines([this](std::string_view w) { read_root(w); });
        if (is(word, ":BONEDATA")) return read_lines([this](std::string_view w) { read_bone_line(w); });
        if (is(word, ":HIERARCHY")) return read_lines([this](std::string_view w) { read_children(w); });
        if (!word.starts_with(':') && !word.starts_with('#')) {
            text_.move_to(word.data());
            text_.fail("{} in place of a section, as in :root; is this an .asf file?", text_.shown());
        }
        text_.skip_line();
        if (word.starts_with(':')) read_lines([](std::string_view) {});
    }

    /// Lines up to the next section, `line` being told the first word of each.
    template <typename Line>
    void read_lines(const Line& line) {
        text_.skip_line();
        for (text_.skip_blanks(); !text_.at_end() && *text_.at() != ':'; text_.skip_blanks()) {
            if (*text_.at() != '#') line(text_.word());
            text_.skip_line();
        }
    }

    void read_unit(std::string_view word) {
        if (!is(word, "ANGLE")) return;
        if (!is(text_.peek(), "DEG") && !is(text_.peek(), "RAD"))
            text_.fail("angles in {}, not deg or rad", text_.shown());
        if (is(text_.peek(), "RAD")) out_.radians_to_degrees = 180 / std::numbers::pi;
    }

    void read_root(std::string_view word) {
        if (is(word, "ORDER")) {
            out_.root_channels.clear();
            while (text_.more_on_line()) out_.root_channels.push_back(read_channel(out_.root_channels));
        } else if (is(word, "AXIS")) {
            root_order_ = read_order();
        } else if (is(word, "POSITION")) {
            out_.root_position = read_vector();
        } else if (is(word, "ORIENTATION")) {
            root_angles_ = read_vector();
        }
    }

    void read_bone_line(std::string_view word) {
        if (is(word, "BEGIN")) {
            if (open_) text_.fail("a begin before the end of bone {}", in_quotes(bones_.back().bone.name));
            if (bones_.size() == most_bones) text_.fail("more than {} bones", most_bones);
            bones_.emplace_back();
            open_ = true;
            return;
        }
        if (!open_) {
            text_.move_to(word.data());
            text_.fail("{} in place of begin", text_.shown());
        }
        Entry& bone = bones_.back();
        if (is(word, "NAME")) return read_name(bone);
        if (is(word, "DIRECTION")) bone.direction = read_vector();
        if (is(word, "LENGTH")) bone.length = text_.number("a length", largest_length);
        if (is(word, "AXIS")) {
            bone.angles = read_vector();
            if (text_.more_on_line()) bone.order = read_order();
        }
        if (is(word, "DOF"))
            while (text_.more_on_line()) bone.bone.channels.push_back(read_turn(bone));
        if (is(word, "END")) end_bone(bone, word.data());
    }

    void read_name(Entry& bone) {
        const auto name = text_.more_on_line() ? text_.word() : std::string_view();
        if (name.empty() || is(name, "ROOT")) text_.fail("{} cannot be a bone's name", in_quotes(name));
        bone.bone.name = printable(name);
    }

    void end_bone(Entry& bone, const char* at) {
        open_ = false;
        if (bone.bone.name.empty()) throw TextFault{at, "a bone without a name"};
        for (std::size_t d = 0; d < 3; ++d) bone.bone.stick[d] = bone.length * bone.direction[d];
        if (!index_.emplace(bone.bone.name, bones_.size() - 1).second)
            throw TextFault{at, fmt::format("a second bone {}", in_quotes(bone.bone.name))};
    }

    void read_children(std::string_view word) {
        if (is(word, "BEGIN") || is(word, "END")) return;
        const bool of_root = is(word, "ROOT");
        const auto parent = of_root ? bones_.size() : find(word);
        while (text_.more_on_line()) {
            const auto name = text_.word();
            Entry& child = bones_[find(name)];
            if (child.placed)
                throw TextFault{name.data(), fmt::format("bone {} has a parent already", in_quotes(name))};
            child.placed = true;
            (of_root ? roots_ : bones_[parent].children).push_back(find(name));
        }
    }

    std::size_t find(std::string_view name) const {
        const auto found = index_.find(printable(name));
        if (found == index_.end())
            throw TextFault{name.data(), fmt::format("no bone {} in :bonedata", in_quotes(name))};
        return found->second;
    }

    Channel read_channel(const std::vector<Channel>& before) {
        const auto channel = channel_named(text_.peek());
        if (!channel) text_.fail("{} in place of TX, TY, TZ, RX, RY or RZ", text_.shown());
        if (std::find(before.begin(), before.end(), *channel) != before.end())
            text_.fail("{} twice", text_.shown());
        text_.word();
        return *channel;
    }

    Channel read_turn(const Entry& bone) {
        const auto channel = channel_named(text_.peek());
        if (channel && *channel < Channel::x_rotation)
            text_.fail("bone {} slides along {}; only bones that turn can be read", in_quotes(bone.bone.name),
                       text_.shown());
        return read_channel(bone.bone.channels);
    }

    Vector3 read_vector() {
        Vector3 v{};
        for (auto& value : v) value = text_.number("a number", largest_length);
        return v;
    }

    /// "XYZ": turns about x, then y, then z.
    std::array<std::size_t, 3> read_order() {
        const auto word = text_.peek();
        std::array<std::size_t, 3> order{};
        std::array<bool, 3> named{};
        for (std::size_t i = 0; i < word.size() && word.size() == 3; ++i) {
            const auto axis = static_cast<std::size_t>((word[i] | 0x20) - 'x');
            if (axis > 2) break;
            order[i] = axis;
            named[axis] = true;
        }
        if (!(named[0] && named[1] && named[2]))
            text_.fail("{} in place of an order of axes, as in XYZ", text_.shown());
        text_.word();
        return order;
    }

    /// Bones as the hierarchy has them. Those that are not in it are left out.
    void put_in_order() {
        std::vector<std::pair<std::size_t, int>> open;  // a bone, and the index of its parent in the order
        const auto add_open = [&](const std::vector<std::size_t>& bones, int parent) {
            for (auto b = bones.rbegin(); b != bones.rend(); ++b) open.emplace_back(*b, parent);
        };
        add_open(roots_, -1);
        if (open.empty()) text_.fail("no bone hangs at the root in a :hierarchy section");
        while (!open.empty()) {
            const auto [b, parent] = open.back();
            open.pop_back();
            Entry& entry = bones_[b];
            entry.bone.parent = parent;
            entry.bone.axes = axes(entry.angles, entry.order);
            add_open(entry.children, static_cast<int>(out_.bones.size()));
            out_.bones.push_back(std::move(entry.bone));
        }
    }

    Matrix3 axes(const Vector3& angles, const std::array<std::size_t, 3>& order) const {
        Matrix3 m = identity3;
        for (const auto axis : order) m = rotation_about(axis, angles[axis] * out_.radians_to_degrees) * m;
        return m;
    }

    void finish_axes() { out_.root_axes = axes(root_angles_, root_order_); }

    TextReader& text_;
    AsfSkeleton out_;
    std::vector<Entry> bones_;
    std::unordered_map<std::string, std::size_t> index_;
    std::vector<std::size_t> roots_;
    std::array<std::size_t, 3> root_order_{0, 1, 2};
    Vector3 root_angles_{};
    bool open_ = false;  ///< between the begin and the end of a bone
};

}  // namespace

std::variant<AsfSkeleton, Rejection> parse_asf(std::string_view text) {
    return read_text_with(text, [](TextReader& reader) { return AsfReader(reader).read(); });
}

}  // namespace actformer::ingest
