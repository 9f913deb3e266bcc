#include "ingest/formats/bvh/bvh_format.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <utility>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"
#include "base/text/suggestion.hpp"
#include "ingest/formats/frame_span.hpp"
#include "ingest/formats/skeletal/persons.hpp"
#include "ingest/formats/skeletal/rearrange.hpp"
#include "ingest/formats/stillness.hpp"

namespace actformer::ingest {
namespace {

constexpr double most_limbs = 1 << 26;  // of one clip, all frames and persons together: 800 MB of float32
constexpr std::uint64_t largest_text = std::uint64_t{128} << 20;

struct BvhClip : RawClip {
    struct Person {
        std::vector<kernels::KinematicJoint> joints;
        std::vector<float> values;  ///< (channels, recorded)
    };
    std::vector<Person> persons;
    std::uint32_t recorded = 0;  ///< frames as recorded
    std::uint32_t frames = 0;    ///< frames once resampled
    float step = 1;              ///< recorded frames an output frame

    std::size_t bytes() const override {
        std::size_t bytes = sizeof *this;
        for (const auto& person : persons) bytes += sizeof(float) * person.values.size();
        return bytes;
    }
};

Rejection broken(std::string reason) {
    return {Rejection::Kind::broken, std::move(reason)};
}

Rejection dropped(std::string reason) {
    return {Rejection::Kind::dropped, std::move(reason)};
}

std::vector<kernels::KinematicJoint> kinematic_joints(const Recording& recording, const Skeleton& skeleton) {
    std::vector<kernels::KinematicJoint> out(recording.joints.size());
    for (std::size_t j = 0; j < out.size(); ++j) {
        const auto& joint = recording.joints[j];
        out[j].parent = joint.parent;
        for (std::size_t d = 0; d < 3; ++d) out[j].offset[d] = static_cast<float>(joint.offset[d]);
        out[j].channels = joint.channels;
        out[j].kept = skeleton.kept[j];
    }
    return out;
}

/// Persons recorded in one world: each where it was as the first is where it was. Theirs are the frames that all have.
std::string put_together(std::vector<Recording>& persons) {
    std::uint32_t fewest = persons[0].frames, most = fewest;
    for (const auto& person : persons) {
        fewest = std::min(fewest, person.frames);
        most = std::max(most, person.frames);
        if (std::abs(person.fps() - persons[0].fps()) > 1e-3 * persons[0].fps())
            return fmt::format("persons at {:.6g} and at {:.6g} frames a second are of different clips",
                               persons[0].fps(), person.fps());
    }
    if (most > fewest + 1)
        return fmt::format("persons of {} and of {} frames are of different clips", fewest, most);
    for (auto& person : persons) {
        if (person.frames > fewest) person = cut(person, 0, fewest);
        if (&person == &persons[0]) continue;
        Vector3 way{};
        for (std::size_t d = 0; d < 3; ++d) way[d] = person.origin[d] - persons[0].origin[d];
        shift(person, way);
    }
    return {};
}

/// Of a clip from frame `first` on, where the options skip `skipped` frames.
std::string jump_doubt(std::uint32_t first, std::uint32_t skipped) {
    return "the first frame is a jump, as from a reference pose; " +
           (first > skipped ? "a start_frame of one more in the labels leaves it out"
                            : fmt::format("--skip-first {} leaves it out", first + 1));
}

std::uint32_t frame_at(const ClipPlace& place, double fps) {
    return static_cast<std::uint32_t>(
        std::min(std::round(place.in_seconds ? place.value * fps : place.value), 4e9));
}

}  // namespace

BvhFormat::BvhFormat(BvhOptions options)
    : options_(std::move(options)),
      names_(options_.pattern, options_.labels),
      settings_(options_, names_.fields()),
      recordings_(options_.asf) {}

bool BvhFormat::is_wanted(const std::vector<NamedClip>& clips) const {
    return options_.classes.empty() || std::any_of(clips.begin(), clips.end(), [&](const NamedClip& clip) {
               return std::find(options_.classes.begin(), options_.classes.end(), clip.action) !=
                      options_.classes.end();
           });
}

void BvhFormat::survey(const RawText& raw) {
    if (Recordings::is_asf(raw)) {
        const std::unique_lock lock(surveying_);
        return recordings_.add_asf(raw);
    }
    const auto clips = names_.clips_of(raw);
    const bool fits = std::holds_alternative<std::vector<NamedClip>>(clips);
    {
        const std::unique_lock lock(surveying_);
        names_.note(raw);
        if (!fits) return;
        for (const auto& clip : std::get<std::vector<NamedClip>>(clips)) {
            actions_.insert(clip.action);
            if (is_wanted({clip})) fields_of_clips_.insert(clip.fields);
        }
        if (!is_wanted(std::get<std::vector<NamedClip>>(clips))) return;
        if (Recordings::is_amc(raw) && !recordings_.has_own_asf(raw)) {
            waiting_.push_back({std::string(raw.path), std::string(raw.stem),
                                std::string(raw.text) + std::string(text_padding, '\0'),
                                std::string(raw.inside), raw.index});
            return;
        }
    }
    look_at(raw);
}

void BvhFormat::look_at(const RawText& raw) {
    std::shared_lock reading(surveying_);
    auto parsed = recordings_.read(raw);
    reading.unlock();
    if (const auto* rejection = std::get_if<Rejection>(&parsed)) {
        const std::unique_lock lock(surveying_);
        if (fault_.empty() || raw.index < fault_index_) {
            fault_ = fmt::format("{}: {}", raw.path, rejection->reason);
            fault_index_ = raw.index;
        }
        return;
    }
    auto& persons = std::get<std::vector<Recording>>(parsed);
    auto file = BvhSurvey::look_at(persons, options_, settings_);
    file.index = raw.index;
    file.path = raw.path;
    file.name = printable(raw.stem);
    file.group = names_.group_of(raw);
    const std::unique_lock lock(surveying_);
    survey_.add(std::move(file), persons.front(), options_.end_sites);
}

void BvhFormat::settle() {
    names_.settle();
    for (const auto& waiting : std::exchange(waiting_, {})) look_at(waiting.raw());
    const auto classes = wanted_classes();
    if (survey_.files().empty())
        throw Error("no BVH file is sound; the first fault is in {}",
                    fault_.empty() ? "a file that cannot be read" : printable(fault_));
    decision_ = survey_.decide(options_, settings_);
    const bool all_classes = options_.classes.empty();
    for (auto& line : names_.remarks(all_classes ? classes : std::vector<std::string>()))
        decision_.remarks.push_back(std::move(line));
    remark_classes(classes);
    for (auto& line : empty_splits(options_.splits, names_.fields(), fields_of_clips_))
        decision_.remarks.push_back(std::move(line));
    gather_groups();
    DatasetHeader header;
    header.name = options_.dataset;
    header.topology = decision_.topology;
    header.persons = static_cast<std::uint32_t>(decision_.persons);
    header.fps = options_.fps > 0 ? options_.fps : decision_.fps;
    header.centre_windows = options_.centre_windows;
    header.classes = classes;
    header.fields = names_.fields();
    header.splits = options_.splits;
    datasets_.push_back(std::move(header));
}

std::vector<std::string> BvhFormat::wanted_classes() const {
    if (options_.classes.empty()) return {actions_.begin(), actions_.end()};
    const bool any = std::any_of(options_.classes.begin(), options_.classes.end(),
                                 [&](const std::string& action) { return actions_.contains(action); });
    if (!any)
        throw Error("none of the classes {} is in a file name; the actions are {}",
                    fmt::join(options_.classes, ","), fmt::join(actions_, ","));
    return options_.classes;
}

/// Of classes that were asked for and have no clip, and of names that make a class of nearly every file.
void BvhFormat::remark_classes(const std::vector<std::string>& classes) {
    for (const auto& action : classes)
        if (!actions_.contains(action))
            decision_.remarks.push_back(fmt::format("no file is of class {}{}", in_quotes(action),
                                                    suggestion(action, {actions_.begin(), actions_.end()})));
    constexpr std::size_t few = 10;  // of so few files each may well be the only one of its class
    const auto files = survey_.files().size();
    if (files > few && 2 * classes.size() > files)
        decision_.remarks.push_back(
            fmt::format("{} classes in {} files: {{action}} of --name may take in more than the action",
                        classes.size(), files));
}

void BvhFormat::gather_groups() {
    for (const auto& file : survey_.files())
        if (!file.group.empty()) groups_[file.group].push_back(file.path);
    for (const auto& [group, paths] : groups_)
        for (const auto& path : paths)
            if (std::error_code error; paths.size() > 1 && !std::filesystem::is_regular_file(path, error))
                throw Error(
                    "{}: persons in files of their own cannot be read out of an archive; unpack it and give "
                    "the folder",
                    path);
}

std::string BvhFormat::settings() const {
    const auto splits = to_text(options_.splits);
    std::string more;
    if (settings_.up != Up::y) more += fmt::format(", {} up", name_of(settings_.up));
    if (settings_.positions != Positions::told)
        more += fmt::format(", positions: {}", name_of(settings_.positions));
    if (options_.recorded_fps > 0)
        more += fmt::format(", recorded at {} frames a second", options_.recorded_fps);
    if (options_.skip_first > 0) more += fmt::format(", without the first {} frames", options_.skip_first);
    if (!options_.start.empty()) more += fmt::format(", from {}", options_.start);
    if (!options_.end.empty()) more += fmt::format(", to {}", options_.end);
    if (!options_.asf.empty()) more += fmt::format(", skeleton {}", checksum_file(options_.asf));
    return fmt::format(
        "bvh: dataset '{}', {}, {} persons a clip, {} metres a unit, {} frames a second, Gaussian smoothing "
        "sigma {} "
        "frames, end "
        "sites {}, root '{}', joints {}, classes {}, splits{}{}{}",
        options_.dataset, names_.settings(), decision_.persons, decision_.scale, datasets_[0].fps,
        options_.smooth, options_.end_sites ? "kept" : "dropped", datasets_[0].topology.names[0],
        fmt::join(datasets_[0].topology.names, ","), fmt::join(datasets_[0].classes, ","), splits,
        options_.centre_windows ? ", windows centred" : "", more);
}

void BvhFormat::read(const RawText& raw, ClipSink& sink) const {
    if (Recordings::is_asf(raw)) return;
    const auto named = names_.clips_of(raw);
    if (const auto* rejection = std::get_if<Rejection>(&named)) return sink.take(*rejection);
    const auto& clips = std::get<std::vector<NamedClip>>(named);
    if (!is_wanted(clips))
        return sink.take(dropped(fmt::format("action '{}' is none of the classes", clips[0].action)));
    const auto* group = group_of(raw);
    if (group && group->front() != raw.path) return;  // a person of a clip that another file stands for

    auto parsed = persons_of(raw, group);
    if (auto* rejection = std::get_if<Rejection>(&parsed)) return sink.take(std::move(*rejection));
    auto& persons = std::get<std::vector<Recording>>(parsed);
    std::vector<Skeleton> skeletons;
    if (auto fault = fit(persons, skeletons)) return sink.take(std::move(*fault));
    for (const auto& clip : clips) {
        auto made = make_clip(clip, persons, skeletons);
        auto* rejection = std::get_if<Rejection>(&made);
        if (rejection && clips.size() > 1)
            rejection->reason = fmt::format("clip {}: {}", clip.name, rejection->reason);
        sink.take(std::move(made));
    }
}

const BvhFormat::Paths* BvhFormat::group_of(const RawText& raw) const {
    const auto key = names_.group_of(raw);
    const auto found = key.empty() ? groups_.end() : groups_.find(key);
    const bool in_it = found != groups_.end() &&
                       std::find(found->second.begin(), found->second.end(), raw.path) != found->second.end();
    return in_it ? &found->second : nullptr;
}

std::variant<std::vector<Recording>, Rejection> BvhFormat::persons_of(const RawText& raw,
                                                                      const Paths* group) const {
    auto parsed = recordings_.read(raw);
    if (std::holds_alternative<Rejection>(parsed)) return parsed;
    auto& persons = std::get<std::vector<Recording>>(parsed);
    std::vector<char> scratch;
    for (std::size_t i = 1; group && i < group->size(); ++i) {
        const auto& path = (*group)[i];
        auto other =
            recordings_.read({path, raw.stem, read_text(path, scratch, largest_text), path, raw.index});
        if (auto* rejection = std::get_if<Rejection>(&other))
            return broken(fmt::format("{}: {}", printable(path), rejection->reason));
        auto& more = std::get<std::vector<Recording>>(other);
        std::move(more.begin(), more.end(), std::back_inserter(persons));
    }
    if (persons.size() != decision_.persons)
        return dropped(fmt::format("persons: {}, not {}; --persons {} takes such clips", persons.size(),
                                   decision_.persons, persons.size()));
    if (auto fault = put_together(persons); !fault.empty()) return broken(std::move(fault));
    return parsed;
}

std::optional<Rejection> BvhFormat::fit(std::vector<Recording>& persons,
                                        std::vector<Skeleton>& skeletons) const {
    for (auto& person : persons) {
        auto found = find_skeleton(person, decision_.topology);
        if (const auto* difference = std::get_if<std::string>(&found))
            return broken(fmt::format("another skeleton than that of most files: {}", *difference));
        auto& skeleton = skeletons.emplace_back(std::get<Skeleton>(std::move(found)));
        if (settings_.positions == Positions::told)
            if (const auto joints = joints_that_vanish(person, skeleton); !joints.empty())
                return broken(
                    fmt::format("the position channels of {} are near 0, where their OFFSETs are not; "
                                "--positions add adds "
                                "the two, and --positions ignore leaves the channels out",
                                fmt::join(joints, ", ")));
        settle_positions(person, skeleton, settings_.positions);
        put_in_order(person, skeleton, decision_.topology);
        turn_up(person, skeleton, settings_.up);
    }
    const double fps = options_.recorded_fps > 0 ? options_.recorded_fps : persons[0].fps();
    if (options_.fps == 0 && std::abs(fps - decision_.fps) > 1e-4 * decision_.fps)
        return broken(fmt::format(
            "{:.6g} frames a second, not {:.6g} as in most files; --fps resamples all to one rate", fps,
            decision_.fps));
    return {};
}

ParsedClip BvhFormat::make_clip(const NamedClip& named, const std::vector<Recording>& persons,
                                const std::vector<Skeleton>& skeletons) const {
    const DatasetHeader& header = datasets_[0];
    const auto label = std::find(header.classes.begin(), header.classes.end(), named.action);
    if (label == header.classes.end())
        return dropped(fmt::format("action '{}' is none of the classes", named.action));

    const double fps = options_.recorded_fps > 0 ? options_.recorded_fps : persons[0].fps();
    const std::uint32_t recorded = persons[0].frames;
    const auto span = frame_span(named.start, named.end, recorded);
    const std::uint32_t skipped = std::max(options_.skip_first, frame_at(settings_.start, fps)),
                        first = std::max(skipped, named.start.value_or(0));
    const std::uint32_t last = std::min(span.last, settings_.end ? frame_at(*settings_.end, fps) : recorded);
    if (first >= last)
        return broken(fmt::format("no frame is left of {}: from {} to {}", recorded, first, last));

    const double step = options_.fps > 0 ? fps / options_.fps : 1;
    const double frames = std::floor((last - first - 1) / step + 1e-4) + 1;
    if (frames * static_cast<double>(header.topology.joints() * persons.size()) > most_limbs)
        return broken(fmt::format("{:.0f} frames of {} joints are too many for one clip", frames,
                                  header.topology.joints()));
    auto clip = std::make_unique<BvhClip>();
    clip->name = named.name;
    clip->label = static_cast<std::uint32_t>(label - header.classes.begin());
    clip->fields = named.fields;
    clip->recorded = last - first;
    clip->frames = static_cast<std::uint32_t>(frames);
    clip->step = static_cast<float>(step);
    std::vector<bool> still;
    bool jumps = false;
    for (std::size_t p = 0; p < persons.size(); ++p) {
        auto person = cut(persons[p], first, last);
        still.push_back(stands_still(person));
        jumps = jumps || begins_with_jump(person, skeletons[p].root);
        clip->persons.push_back({kinematic_joints(person, skeletons[p]), std::move(person.values)});
    }
    clip->doubts = stillness_doubts(clip->recorded, still);
    if (jumps) clip->doubts.push_back(jump_doubt(first, skipped));
    span.add_doubts(clip->doubts);
    return clip;
}

kernels::CleanedBatch BvhFormat::clean(kernels::Device& device, std::size_t dataset,
                                       std::span<const std::unique_ptr<RawClip>> clips,
                                       std::vector<std::uint32_t>& frames) const {
    kernels::ClipBatch batch;
    batch.joints = static_cast<std::uint32_t>(datasets_[dataset].topology.joints());
    batch.persons = datasets_[dataset].persons;
    batch.first = {0};
    std::vector<kernels::KinematicClip> kinematics;
    for (const auto& raw : clips) {
        const auto& clip = static_cast<const BvhClip&>(*raw);
        batch.frames.push_back(clip.frames);
        batch.step.push_back(clip.step);
        for (const auto& person : clip.persons) {
            kinematics.push_back({person.joints, clip.recorded, person.values});
            batch.first.push_back(batch.first.back() + clip.recorded);
            for (std::uint32_t t = 0; t < clip.recorded; ++t) batch.times.push_back(static_cast<float>(t));
        }
    }
    frames = batch.frames;
    const auto limbs = kernels::forward_kinematics(device, kinematics, decision_.scale);
    const auto radius = static_cast<std::uint32_t>(std::ceil(4 * options_.smooth));
    return kernels::clean(device, batch, limbs, {options_.smooth, radius});
}

}  // namespace actformer::ingest
