#include "ingest/formats/bvh/bvh_format.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

constexpr double most_limbs = 1 << 26;  // of one clip, all frames together: 800 MB of float32

struct BvhClip : RawClip {
    std::vector<kernels::KinematicJoint> joints;
    std::uint32_t recorded = 0;  ///< frames as recorded
    std::uint32_t frames = 0;    ///< frames once resampled
    float step = 1;              ///< recorded frames an output frame
    std::vector<float> values;   ///< (channels, recorded)

    std::size_t bytes() const override { return sizeof *this + sizeof(float) * values.size(); }
};

void check(const BvhOptions& options, const NamePattern& pattern) {
    if (!(options.scale > 1e-6F && options.scale < 1e6F))
        throw Error("scale {} is not a number of metres a unit; centimetres are 0.01", options.scale);
    if (!(options.fps == 0 || (options.fps >= 1 && options.fps <= 1000)))
        throw Error("{} frames a second cannot be resampled to; give 1 to 1000, or 0 for as recorded",
                    options.fps);
    if (!(options.smooth >= 0 && options.smooth <= 1000))
        throw Error("smoothing over {} frames makes no sense; give 0 for none, or up to 1000",
                    options.smooth);
    for (const auto& split : options.splits)
        for (const auto& condition : split.conditions)
            if (std::find(pattern.fields().begin(), pattern.fields().end(), condition.field) ==
                pattern.fields().end())
                throw Error("split {}: the name pattern has no field '{}'; it has {}", split.name,
                            condition.field, fmt::join(pattern.fields(), ", "));
    if (std::set<std::string>(options.classes.begin(), options.classes.end()).size() !=
        options.classes.size())
        throw Error("a class is listed twice: {}", fmt::join(options.classes, ","));
}

std::vector<std::string> classes_of(const BvhOptions& options, const std::vector<std::string>& actions) {
    if (options.classes.empty()) return actions;
    const bool any = std::any_of(actions.begin(), actions.end(), [&](const std::string& action) {
        return std::find(options.classes.begin(), options.classes.end(), action) != options.classes.end();
    });
    if (!any)
        throw Error("none of the classes {} is in a file name; the actions are {}",
                    fmt::join(options.classes, ","), fmt::join(actions, ","));
    return options.classes;
}

std::size_t root_of(const BvhOptions& options, const BvhFile& example) {
    if (options.root.empty()) return automatic_root(example);
    const int root = find_joint(example, options.root);
    if (root >= 0) return static_cast<std::size_t>(root);
    std::vector<std::string> names;
    for (const auto& joint : example.joints)
        if (!joint.end_site) names.push_back(joint.name);
    throw Error("no joint {} to take as root; the joints are {}", in_quotes(options.root),
                fmt::join(names, ", "));
}

/// A kept joint whose position channels are all 0 where its OFFSET is not; -1 where there is none. Its file
/// means positions to add to offsets; taken in their place, the limb would vanish.
int joint_without_length(const BvhFile& file, const Skeleton& skeleton) {
    double longest = 0;
    for (const auto& joint : file.joints)
        for (const double o : joint.offset) longest = std::max(longest, std::abs(o));
    for (std::size_t j = skeleton.root + 1; j < file.joints.size(); ++j) {
        const auto& joint = file.joints[j];
        double lost = 0;
        bool moves = !skeleton.kept[j];
        for (std::uint32_t c = 0; c < joint.channels.size() && !moves; ++c) {
            if (joint.channels[c] >= kernels::Channel::x_rotation) continue;
            const auto values = file.channel(joint.first_channel + c);
            moves = std::any_of(values.begin(), values.end(), [](float v) { return v != 0; });
            lost = std::max(lost, std::abs(joint.offset[static_cast<std::size_t>(joint.channels[c])]));
        }
        if (!moves && lost > 1e-3 * longest) return static_cast<int>(j);
    }
    return -1;
}

/// The hierarchy's root stands at the origin: where the file puts it is a constant that re-centring takes
/// away.
std::vector<kernels::KinematicJoint> kinematic_joints(const BvhFile& file, const Skeleton& skeleton) {
    std::vector<kernels::KinematicJoint> out(file.joints.size());
    for (std::size_t j = 0; j < out.size(); ++j) {
        const auto& joint = file.joints[j];
        out[j].parent = joint.parent;
        for (std::size_t d = 0; d < 3 && j > 0; ++d) out[j].offset[d] = static_cast<float>(joint.offset[d]);
        out[j].channels = joint.channels;
        out[j].kept = skeleton.kept[j];
    }
    return out;
}

Rejection broken(std::string reason) {
    return {Rejection::Kind::broken, std::move(reason)};
}

}  // namespace

BvhFormat::BvhFormat(BvhOptions options) : options_(std::move(options)), pattern_(options_.pattern) {
    check(options_, pattern_);
}

void BvhFormat::survey(const RawText& raw) {
    const auto fields = pattern_.match(raw.stem);
    std::optional<std::variant<BvhFile, Rejection>> parsed;
    if (fields) {
        std::unique_lock lock(surveying_);
        const bool wanted = !found_.example || raw.index < found_.example_index;
        lock.unlock();
        if (wanted) parsed = parse_bvh(raw.text);
    }
    const std::lock_guard lock(surveying_);
    if (found_.first_name.empty() || raw.index < found_.first_index) {
        found_.first_name = raw.stem;
        found_.first_index = raw.index;
    }
    if (fields) found_.actions.insert((*fields)[pattern_.action()]);
    if (!parsed) return;
    if (auto* sound = std::get_if<BvhFile>(&*parsed)) {
        if (found_.example && found_.example_index < raw.index) return;
        found_.example = std::move(*sound);
        found_.example_index = raw.index;
    } else if (found_.fault.empty() || raw.index < found_.fault_index) {
        found_.fault = fmt::format("{}: {}", raw.path, std::get<Rejection>(*parsed).reason);
        found_.fault_index = raw.index;
    }
}

void BvhFormat::settle() {
    if (found_.actions.empty())
        throw Error("no file name fits the pattern '{}'; there is {}", printable(pattern_.text()),
                    found_.first_name.empty() ? "no file" : in_quotes(found_.first_name));
    if (!found_.example)
        throw Error("no BVH file is sound; the first fault is in {}",
                    found_.fault.empty() ? "a file that cannot be read" : printable(found_.fault));
    const auto& example = *found_.example;
    source_fps_ = example.fps();
    DatasetHeader header;
    header.name = options_.dataset;
    header.topology = skeleton_below(example, root_of(options_, example), options_.end_sites).topology;
    header.fps = options_.fps > 0 ? options_.fps : source_fps_;
    header.centre_windows = options_.centre_windows;
    header.classes = classes_of(options_, {found_.actions.begin(), found_.actions.end()});
    header.fields = pattern_.fields();
    header.splits = options_.splits;
    datasets_.push_back(std::move(header));
}

std::string BvhFormat::settings() const {
    std::string splits;
    for (const auto& split : options_.splits) {
        splits += fmt::format(" [{}", split.name);
        for (const auto& c : split.conditions)
            splits += fmt::format(" {}{}:{}", c.field, c.negated ? "!" : "", fmt::join(c.values, ","));
        splits += "]";
    }
    return fmt::format(
        "bvh: dataset '{}', names '{}', {} metres a unit, {} frames a second, Gaussian smoothing sigma {} "
        "frames, end "
        "sites {}, root '{}', joints {}, classes {}, splits{}{}",
        options_.dataset, pattern_.text(), options_.scale, datasets_[0].fps, options_.smooth,
        options_.end_sites ? "kept" : "dropped", datasets_[0].topology.names[0],
        fmt::join(datasets_[0].topology.names, ","), fmt::join(datasets_[0].classes, ","), splits,
        options_.centre_windows ? ", windows centred" : "");
}

ParsedClip BvhFormat::parse(const RawText& raw) const {
    const DatasetHeader& header = datasets_[0];
    const auto fields = pattern_.match(raw.stem);
    if (!fields)
        return broken(fmt::format("the name does not fit the pattern '{}'", printable(pattern_.text())));
    const auto& action = (*fields)[pattern_.action()];
    const auto label = std::find(header.classes.begin(), header.classes.end(), action);
    if (label == header.classes.end())
        return Rejection{Rejection::Kind::dropped, fmt::format("action '{}' is none of the classes", action)};

    auto parsed = parse_bvh(raw.text);
    if (auto* rejection = std::get_if<Rejection>(&parsed)) return std::move(*rejection);
    auto& file = std::get<BvhFile>(parsed);

    const int root = find_joint(file, header.topology.names[0]);
    if (root < 0)
        return broken(fmt::format("no joint '{}', the root of the first file", header.topology.names[0]));
    const auto skeleton = skeleton_below(file, static_cast<std::size_t>(root), header.topology);
    if (const auto difference = first_difference(skeleton.topology, header.topology); !difference.empty())
        return broken(fmt::format("another skeleton than the first file's: {}", difference));
    if (const int joint = joint_without_length(file, skeleton); joint >= 0)
        return broken(
            fmt::format("the position channels of {} are 0 in place of its OFFSET; remove them",
                        file.joints[joint].end_site ? "an End Site" : in_quotes(file.joints[joint].name)));
    const double fps = file.fps();
    if (options_.fps == 0 && std::abs(fps - source_fps_) > 1e-4 * source_fps_)
        return broken(fmt::format(
            "{:.6g} frames a second, not {:.6g} as in the first file; --fps resamples all to one rate", fps,
            source_fps_));

    const double step = options_.fps > 0 ? fps / options_.fps : 1;
    const double frames = std::floor((file.frames - 1) / step + 1e-4) + 1;
    if (frames * static_cast<double>(header.topology.joints()) > most_limbs)
        return broken(fmt::format("{:.0f} frames of {} joints are too many for one clip", frames,
                                  header.topology.joints()));
    auto clip = std::make_unique<BvhClip>();
    clip->name = printable(raw.stem);
    clip->label = static_cast<std::uint32_t>(label - header.classes.begin());
    clip->fields = *fields;
    clip->joints = kinematic_joints(file, skeleton);
    clip->recorded = file.frames;
    clip->frames = static_cast<std::uint32_t>(frames);
    clip->step = static_cast<float>(step);
    clip->values = std::move(file.values);
    return clip;
}

kernels::CleanedBatch BvhFormat::clean(kernels::Device& device, std::size_t dataset,
                                       std::span<const std::unique_ptr<RawClip>> clips,
                                       std::vector<std::uint32_t>& frames) const {
    kernels::ClipBatch batch;
    batch.joints = static_cast<std::uint32_t>(datasets_[dataset].topology.joints());
    batch.first = {0};
    std::vector<kernels::KinematicClip> kinematics;
    for (const auto& raw : clips) {
        const auto& clip = static_cast<const BvhClip&>(*raw);
        kinematics.push_back({clip.joints, clip.recorded, clip.values});
        batch.frames.push_back(clip.frames);
        batch.step.push_back(clip.step);
        batch.first.push_back(batch.first.back() + clip.recorded);
        for (std::uint32_t t = 0; t < clip.recorded; ++t) batch.times.push_back(static_cast<float>(t));
    }
    frames = batch.frames;
    const auto limbs = kernels::forward_kinematics(device, kinematics, options_.scale);
    const auto radius = static_cast<std::uint32_t>(std::ceil(4 * options_.smooth));
    return kernels::clean(device, batch, limbs, {options_.smooth, radius});
}

}  // namespace actformer::ingest
