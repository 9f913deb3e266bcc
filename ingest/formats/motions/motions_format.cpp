#include "ingest/formats/motions/motions_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_set>

#include "base/error.hpp"
#include "base/text/counted.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "ingest/formats/motions/body_doubts.hpp"
#include "ingest/formats/motions/position_clips.hpp"
#include "ingest/formats/motions/topology_file.hpp"
#include "ingest/formats/skeletal/up.hpp"
#include "ingest/smpl/smpl24.hpp"

namespace actformer::ingest {
namespace {

constexpr const char* unlabelled = "motion";

struct MotionClip : PositionClip {
    bool stored = false;  ///< `values` go to the dataset as they are
};

void check(const MotionsOptions& options) {
    if (!(options.scale > 1e-9 && options.scale < 1e9))
        throw Error("scale {} is not a number of metres a unit; millimetres are 0.001", options.scale);
    if (!(options.fps == 0 || (options.fps >= 1 && options.fps <= 1000)))
        throw Error("{} frames a second; give 1 to 1000, or 0 for as the files say", options.fps);
    if (options.persons > 100) throw Error("{} persons in a clip; give 1 to 100", options.persons);
    if (!up_named(options.up)) throw Error("up {}: give y, z, x, -y, -z or -x", in_quotes(options.up));
    if (!options.representation.empty() && options.representation != "limb" &&
        options.representation != "xyz")
        throw Error("joint positions become limb or xyz, not {}", in_quotes(options.representation));
    check_axes(options.axes);
}

/// What most have; `counts` is not empty.
template <typename T>
T commonest(const std::map<T, std::uint64_t>& counts) {
    return std::max_element(counts.begin(), counts.end(),
                            [](auto& a, auto& b) { return a.second < b.second; })
        ->first;
}

/// The largest difference between two rest skeletons along an axis, in metres.
float rest_difference(const std::vector<float>& rest, const std::vector<float>& other) {
    float most = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) most = std::max(most, std::abs(rest[i] - other[i]));
    return most;
}

/// But for the rounding of float32 and of texts.
bool same_rest(const std::vector<float>& rest, const std::vector<float>& other) {
    if (rest.size() != other.size()) return false;
    float largest = 0;
    for (const float x : other) largest = std::max(largest, std::abs(x));
    return rest_difference(rest, other) <= 1e-4F * largest;
}

std::string place_of(const FoundMotion& motion, std::uint64_t clip) {
    if (motion.key.empty() && !motion.numbered) return {};
    return motion.key.empty() ? fmt::format("clip {}: ", clip)
           : motion.numbered  ? fmt::format("'{}': clip {}: ", printable(motion.key), clip)
                              : fmt::format("'{}': ", printable(motion.key));
}

}  // namespace

struct MotionsFormat::Surveyed : MotionFile {
    std::string path;       ///< of the file, for messages
    std::string for_names;  ///< the same, as path_for_names() has it

    /// Where a clip is, as names and labels see it.
    std::string path_of(const FoundMotion& motion, std::uint64_t clip) const {
        auto out = for_names;
        if (!motion.key.empty()) out += "/" + motion.key;
        if (motion.numbered) out += fmt::format("_{}", clip);
        return out;
    }

    template <typename Use>
    void for_each_clip(Use use) const {
        for (const auto& motion : motions)
            for (std::uint64_t clip = 0; clip < motion.clips; ++clip) use(motion, clip);
    }
};

MotionsFormat::MotionsFormat(MotionsOptions options) : options_(std::move(options)) {
    check(options_);
    if (!options_.topology.empty()) arrays_.topology = topology_called(options_.topology);
    arrays_.axes = options_.axes;
    positions_.scale = options_.scale;
    positions_.axes = axes_below(*up_named(options_.up));
    positions_.limbs = options_.representation != "xyz";
    if (!options_.pattern.empty() || !options_.labels.empty())
        names_.emplace(options_.pattern, options_.labels);
}

MotionsFormat::~MotionsFormat() = default;

void MotionsFormat::survey(const RawText& raw) {
    Surveyed file{look_into(raw, arrays_), std::string(raw.path), path_for_names(raw)};
    const std::lock_guard lock(surveying_);
    files_.emplace(raw.index, std::move(file));
}

void MotionsFormat::settle() {
    settle_skeleton();
    settle_header();
    settle_names();
    settle_classes();
    remark();
}

void MotionsFormat::settle_skeleton() {
    std::string fault;
    bool any = false;
    for (const auto& [index, file] : files_) {
        any = any || !file.motions.empty();
        if (!arrays_.topology && file.topology) arrays_.topology = file.topology;
        if (fault.empty() && !file.faults.empty())
            fault = fmt::format("; the first fault is in {}: {}", printable(file.path),
                                printable(file.faults[0].second));
    }
    if (!any) throw Error("no motion in any file{}", fault);
}

void MotionsFormat::settle_header() {
    std::map<std::uint32_t, std::uint64_t> persons;
    std::map<std::string, std::uint64_t> stored;
    std::map<double, std::uint64_t> rates;
    for (const auto& entry : files_) {
        const auto& file = entry.second;
        file.for_each_clip([&](const FoundMotion& motion, std::uint64_t) {
            ++persons[motion.persons];
            if (motion.stored) ++stored[file.representation.name()];
            if (file.fps) ++rates[*file.fps];
        });
    }
    DatasetHeader header;
    header.name = options_.dataset;
    header.topology = *arrays_.topology;
    header.persons = options_.persons > 0 ? options_.persons : commonest(persons);
    header.fps = options_.fps > 0 ? options_.fps : rates.empty() ? 30 : commonest(rates);
    header.centre_windows = options_.centre_windows;
    if (!stored.empty() && options_.representation.empty())
        header.representation = Representation::named(commonest(stored), "the files");
    else if (!options_.representation.empty())
        header.representation = Representation::named(options_.representation, "--representation");
    for (const auto& [index, file] : files_)
        if (header.representation == Representation::rot6d && header.rest.empty() && !file.motions.empty())
            header.rest = file.rest;
    if (header.representation == Representation::rot6d && header.rest.empty()) {
        const auto skeleton = generic_skeleton();
        if (header.topology.parents != smpl24().parents)
            throw Error(
                "rotations, but no rest pose that they turn: a file that tells it has the attribute rest, "
                "(joints, 3) metres "
                "from the parent");
        header.rest = skeleton.rest();
        header.origin.skeleton = skeleton.source;
        remarks_.emplace_back("the files do not tell the rest pose: that of a mean body is taken");
    }
    positions_.persons = header.persons;
    datasets_ = {std::move(header)};
    positions_.topology = &datasets_[0].topology;
}

void MotionsFormat::settle_names() {
    auto& header = datasets_[0];
    if (names_) {
        for (const auto& [index, file] : files_)
            file.for_each_clip([&, at = index, &from = file](const FoundMotion& motion, std::uint64_t clip) {
                names_->note(from.path_of(motion, clip), at);
            });
        names_->settle();
        header.fields = names_->fields();
    } else {
        const auto apart = [&] {
            std::unordered_set<std::string> names;
            bool distinct = true;
            for (const auto& [index, file] : files_)
                file.for_each_clip([&, &from = file](const FoundMotion& motion, std::uint64_t clip) {
                    distinct =
                        distinct && names.insert(name_of_path(from.path_of(motion, clip), folders_)).second;
                });
            return distinct;
        };
        constexpr std::size_t deepest = 16;
        while (!apart() && folders_ < deepest) ++folders_;
        if (folders_ == deepest) folders_ = 0;  // the very same paths: the first of each name is taken
        header.fields = {"action", "file"};
    }
    check_fields(options_.splits, header.fields);
    header.splits = options_.splits;
}

/// Those that all files tell alike, in their order; else the actions of the clips, sorted.
void MotionsFormat::settle_classes() {
    std::set<std::vector<std::string>> told;
    std::set<std::string> actions;
    for (const auto& [index, file] : files_) {
        if (!file.motions.empty()) told.insert(file.classes);
        file.for_each_clip([&, &from = file](const FoundMotion& motion, std::uint64_t clip) {
            const auto clips = clips_of(from, motion, clip);
            if (const auto* all = std::get_if<std::vector<NamedClip>>(&clips))
                for (const auto& one : *all) {
                    actions.insert(one.action);
                    fields_of_clips_.insert(one.fields);
                }
        });
    }
    const auto known = [&](const std::string& action) {
        return std::find(told.begin()->begin(), told.begin()->end(), action) != told.begin()->end();
    };
    told_classes_ =
        told.size() == 1 && !told.begin()->empty() && std::all_of(actions.begin(), actions.end(), known);
    datasets_[0].classes =
        told_classes_ ? *told.begin() : std::vector<std::string>(actions.begin(), actions.end());
}

void MotionsFormat::remark() {
    std::vector<std::string> guesses, numbered;
    bool lengths = true;
    for (const auto& [index, file] : files_) {
        if (!file.guess.empty()) guesses.push_back(fmt::format("{}: {}", printable(file.path), file.guess));
        if (file.numbered_columns) numbered.push_back(printable(file.path));
        for (const auto& motion : file.motions)
            lengths = lengths && (!motion.stored || !file.bone_length.empty());
    }
    if (!guesses.empty())
        remarks_.push_back(
            fmt::format("{} of (?, ?, joints, 3) taken by their lengths ({}); --axes says otherwise",
                        guesses.size() == 1 ? "an array" : "arrays", first_few(guesses)));
    if (!numbered.empty())
        remarks_.push_back(fmt::format(
            "line 1 numbers the columns of {} ({}) and is no frame; where it is one, put a line of "
            "names before it",
            counted(numbered.size(), "file"), first_few(numbered)));
    if (!lengths && datasets_[0].representation == Representation::limb)
        remarks_.emplace_back("the files do not tell how long the limbs are: usual lengths are taken");
    if (names_)
        for (auto& line : names_->remarks(datasets_[0].classes)) remarks_.push_back(std::move(line));
    for (auto& line : empty_splits(options_.splits, datasets_[0].fields, fields_of_clips_))
        remarks_.push_back(std::move(line));
}

std::vector<NamedClip> MotionsFormat::told_by_file(const Surveyed& file, const FoundMotion& motion,
                                                   std::uint64_t clip) const {
    const auto path = file.path_of(motion, clip);
    std::optional<std::uint32_t> label;
    if (clip < motion.labels.size() && motion.labels[clip] >= 0)
        label = static_cast<std::uint32_t>(motion.labels[clip]);
    if (!label) label = label_in(name_of_path(path, 0));
    const auto action = !label                         ? unlabelled
                        : *label < file.classes.size() ? printable(file.classes[*label])
                                                       : fmt::format("A{:03}", *label + 1);
    return {{name_of_path(path, folders_), action, {action, name_of_path(file.for_names, 0)}, {}, {}}};
}

std::variant<std::vector<NamedClip>, Rejection> MotionsFormat::clips_of(const Surveyed& file,
                                                                        const FoundMotion& motion,
                                                                        std::uint64_t clip) const {
    if (!names_) return told_by_file(file, motion, clip);
    return names_->clips_of(file.path_of(motion, clip));
}

std::string MotionsFormat::settings() const {
    const auto& header = datasets_[0];
    const auto splits = to_text(options_.splits);
    return fmt::format(
        "motions: dataset '{}', {}, axes '{}', {} up, {} metres a unit, {} frames a second, {} persons, {}, "
        "{}, joints {} below {}, "
        "classes {}, splits{}{}",
        options_.dataset, names_ ? names_->settings() : "names and labels of the files", options_.axes,
        options_.up, options_.scale, header.fps, header.persons, header.representation.name(),
        options_.clean ? "smoothed by a Gaussian of sigma 3 frames" : "not smoothed",
        fmt::join(header.topology.names, ","), fmt::join(header.topology.parents, ","),
        fmt::join(header.classes, ","), splits, options_.centre_windows ? ", windows centred" : "");
}

class MotionsFormat::FileReader {
  public:
    FileReader(const MotionsFormat& format, const Surveyed& file, ClipSink& sink)
        : format_(format), header_(format.datasets_[0]), file_(file), sink_(sink) {}

    void read(const RawText& raw) {
        for (const auto& [key, why] : file_.faults)
            reject(key.empty() ? why : fmt::format("'{}': {}", printable(key), why));
        if (file_.motions.empty()) return;
        if (auto why = other_skeleton(); !why.empty()) return reject(std::move(why));
        if (const auto fps = file_.fps;
            fps && format_.options_.fps == 0 && std::abs(*fps - header_.fps) > 1e-3)
            return reject(fmt::format("{:.6g} frames a second, not {:.6g} as most; --fps F takes all as F",
                                      *fps, header_.fps));
        take_motions(
            raw, file_, header_.topology, format_.arrays_.axes,
            {[this, &raw](const FoundMotion& found, const JointArray& array) {
                 add_array(raw, found, array);
             },
             [this](const FoundMotion& found, const MotionsFile& file) { add_stored(found, file); }});
    }

  private:
    void reject(std::string reason, Rejection::Kind kind = Rejection::Kind::broken) {
        sink_.take(Rejection{kind, std::move(reason)});
    }

    /// Files without names give joints their numbers.
    static bool tells_name(const Topology& topology, std::size_t joint) {
        const auto number = std::to_string(joint);
        return topology.names[joint] != number && topology.names[joint] != "joint " + number;
    }

    /// Why the file's motions are not of the dataset's skeleton; empty where they are.
    std::string other_skeleton() const {
        if (file_.topology && format_.options_.topology.empty()) {
            const auto &own = *file_.topology, &wanted = header_.topology;
            if (own.parents != wanted.parents) return "its skeleton is not that of the first file";
            for (std::size_t j = 0; j < wanted.joints(); ++j)
                if (own.names[j] != wanted.names[j] && tells_name(own, j) && tells_name(wanted, j))
                    return fmt::format(
                        "its joint {} is {}, and {} in the first file; --topology takes joints by their "
                        "order",
                        j, in_quotes(own.names[j]), in_quotes(wanted.names[j]));
        }
        if (file_.rest.empty() || header_.rest.empty() || same_rest(file_.rest, header_.rest)) return {};
        if (file_.rest.size() != header_.rest.size()) return "its skeleton is not that of the first file";
        return fmt::format(
            "its rest skeleton is not that of the first file: offsets differ by up to {:.2g} m; ingest it on "
            "its "
            "own",
            rest_difference(file_.rest, header_.rest));
    }

    /// Calls `make` with each of the clips that names and labels make of a motion.
    template <typename Make>
    void for_each(const FoundMotion& found, std::uint64_t clip, Make make) {
        const auto place = place_of(found, clip);
        auto clips = format_.clips_of(file_, found, clip);
        if (auto* rejection = std::get_if<Rejection>(&clips))
            return reject(place + rejection->reason, rejection->kind);
        for (auto& named : std::get<std::vector<NamedClip>>(clips)) {
            std::variant<std::unique_ptr<MotionClip>, Rejection> made = make(named);
            if (auto* rejection = std::get_if<Rejection>(&made)) {
                reject(place + rejection->reason, rejection->kind);
                continue;
            }
            auto& out = std::get<std::unique_ptr<MotionClip>>(made);
            const auto label = std::find(header_.classes.begin(), header_.classes.end(), named.action);
            if (label == header_.classes.end()) {
                reject(fmt::format("{}'{}' is none of the classes", place, named.action),
                       Rejection::Kind::dropped);
                continue;
            }
            out->label = static_cast<std::uint32_t>(label - header_.classes.begin());
            out->name = std::move(named.name);
            out->fields = std::move(named.fields);
            sink_.take(std::move(out));
        }
    }

    void add_array(const RawText& raw, const FoundMotion& found, const JointArray& array) {
        for (std::uint64_t clip = 0; clip < array.clips(); ++clip) {
            for_each(found, clip, [&](const NamedClip& named) { return positions(array, clip, named); });
            raw.release(array.end_of_clip(clip));
        }
    }

    std::variant<std::unique_ptr<MotionClip>, Rejection> positions(const JointArray& array,
                                                                   std::uint64_t clip,
                                                                   const NamedClip& named) const {
        if (header_.representation == Representation::rot6d)
            return Rejection{Rejection::Kind::dropped,
                             "joint positions, and not rotations as the others are"};
        auto request = format_.positions_;
        request.start = named.start.value_or(0);
        request.end = named.end;
        auto read = read_positions(array, clip, request);
        if (auto* rejection = std::get_if<Rejection>(&read)) return std::move(*rejection);
        auto out = std::make_unique<MotionClip>();
        out->take(std::get<ClipPositions>(std::move(read)));
        add_body_doubts(*out, request);
        return out;
    }

    /// Of joint positions; those relative to the parents are limbs that need no length.
    void add_body_doubts(PositionClip& clip, const PositionsRequest& request) const {
        const auto joints = header_.topology.joints();
        Motion motion{clip.name, clip.frames, request.persons, static_cast<std::uint32_t>(joints), 3, {}};
        motion.values.swap(clip.values);
        if (const auto height = height_of(motion, std::vector<float>(joints, 1)))
            for (auto& doubt : body_doubts(*height, request)) clip.doubts.push_back(std::move(doubt));
        clip.values.swap(motion.values);
    }

    std::optional<BodyHeight> height_of(const Motion& motion, const std::vector<float>& bone_length) const {
        return body_height(motion, {header_.representation, header_.topology, bone_length, header_.rest});
    }

    void add_stored(const FoundMotion& found, const MotionsFile& file) {
        for_each(found, 0, [&](const NamedClip& named) { return stored(found, file, named); });
    }

    std::variant<std::unique_ptr<MotionClip>, Rejection> stored(const FoundMotion& found,
                                                                const MotionsFile& file,
                                                                const NamedClip& named) const {
        const auto& options = format_.options_;
        if (file_.representation != header_.representation)
            return Rejection{
                Rejection::Kind::dropped,
                fmt::format("holds {}, not {}", file_.representation.name(), header_.representation.name())};
        if (found.persons != header_.persons)
            return Rejection{Rejection::Kind::dropped,
                             fmt::format("{} persons, not {}", found.persons, header_.persons)};
        if (options.clean || options.scale != 1 || options.up != "y")
            return Rejection{
                Rejection::Kind::dropped,
                fmt::format("{} stay as they are: no --clean, --scale or --up for them",
                            file_.representation == Representation::rot6d ? "rotations"
                            : file_.representation == Representation::xyz ? "positions in the public layout"
                                                                          : "limbs")};
        auto motion = file.read(found.key);
        if (const auto bad = std::find_if(motion.values.begin(), motion.values.end(),
                                          [](float x) { return !std::isfinite(x); });
            bad != motion.values.end())
            return Rejection{Rejection::Kind::broken,
                             fmt::format("frame {}: a number that is not finite",
                                         static_cast<std::size_t>(bad - motion.values.begin()) /
                                             (std::size_t{motion.persons} * motion.nodes * motion.numbers))};
        auto out = std::make_unique<MotionClip>();
        const auto span = frame_span(named.start, named.end, motion.frames);
        if (span.empty())
            return Rejection{Rejection::Kind::dropped, "the labels cut out frames that are not there"};
        span.add_doubts(out->doubts);
        const auto row = std::size_t{motion.persons} * motion.nodes * motion.numbers;
        out->frames = span.last - span.first;
        out->stored = true;
        motion.values.erase(motion.values.begin() + static_cast<std::ptrdiff_t>(span.last * row),
                            motion.values.end());
        motion.values.erase(motion.values.begin(),
                            motion.values.begin() + static_cast<std::ptrdiff_t>(span.first * row));
        motion.frames = out->frames;
        out->bone_length = lengths(file.details(found.key).bone_length, motion.values);
        add_stored_doubts(*out, motion);
        out->values = std::move(motion.values);
        return out;
    }

    /// Of a motion in the public layout.
    void add_stored_doubts(PositionClip& clip, const Motion& motion) const {
        if (file_.representation == Representation::limb && !has_unit_limbs(motion))
            clip.doubts.emplace_back(
                "limbs that are not of length 1: joint positions? --axes kct and the like takes them so");
        else if (const auto height = height_of(motion, clip.bone_length))
            for (auto& doubt : stored_body_doubts(*height, header_.topology))
                clip.doubts.push_back(std::move(doubt));
    }

    /// The motion's own, else the file's, else those between its positions where it holds these, else usual ones.
    std::vector<float> lengths(std::vector<float> own, const std::vector<float>& values) const {
        const auto joints = header_.topology.joints(), wanted = header_.persons * joints;
        if (own.size() == wanted) return own;
        if (file_.bone_length.size() == wanted) return file_.bone_length;
        if (header_.representation == Representation::xyz)
            return mean_limb_lengths(values, header_.persons, header_.topology);
        const auto usual =
            header_.rest.empty() ? usual_bone_lengths(header_.topology) : rest_lengths(header_.rest);
        std::vector<float> out;
        for (std::size_t p = 0; p < header_.persons; ++p) out.insert(out.end(), usual.begin(), usual.end());
        return out;
    }

    const MotionsFormat& format_;
    const DatasetHeader& header_;
    const Surveyed& file_;
    ClipSink& sink_;
};

void MotionsFormat::read(const RawText& raw, ClipSink& sink) const {
    const auto file = files_.find(raw.index);
    if (file == files_.end()) throw Error("it could not be read when the files were looked at");
    FileReader(*this, file->second, sink).read(raw);
}

namespace {

using Clips = std::vector<const MotionClip*>;

/// Numbers of a frame, all persons together.
std::size_t frame_size(const DatasetHeader& header) {
    return std::size_t{header.persons} * header.representation.nodes(header.topology) *
           header.representation.numbers();
}

/// The clips of `made` where they belong among the stored ones.
kernels::CleanedBatch with_stored(const Clips& clips, const kernels::CleanedBatch& made,
                                  const DatasetHeader& header) {
    kernels::CleanedBatch out;
    const auto motion = std::make_shared<std::vector<float>>();
    const auto bones = header.persons * header.topology.joints();
    std::size_t row = 0, fresh = 0;
    for (const auto* clip : clips) {
        if (clip->stored) {
            motion->insert(motion->end(), clip->values.begin(), clip->values.end());
            out.bone_length.insert(out.bone_length.end(), clip->bone_length.begin(), clip->bone_length.end());
            continue;
        }
        const auto size = clip->frames * frame_size(header);
        motion->insert(motion->end(), made.motion.data() + row, made.motion.data() + row + size);
        const auto lengths = made.bone_length.begin() + static_cast<std::ptrdiff_t>(fresh++ * bones);
        out.bone_length.insert(out.bone_length.end(), lengths, lengths + static_cast<std::ptrdiff_t>(bones));
        row += size;
    }
    out.motion = *motion;
    out.memory = motion;
    return out;
}

}  // namespace

kernels::CleanedBatch MotionsFormat::clean(kernels::Device& device, std::size_t dataset,
                                           std::span<const std::unique_ptr<RawClip>> clips,
                                           std::vector<std::uint32_t>& frames) const {
    const auto& header = datasets_[dataset];
    Clips all;
    std::vector<const PositionClip*> fresh;
    frames.clear();
    for (const auto& raw : clips) {
        const auto& clip = static_cast<const MotionClip&>(*raw);
        frames.push_back(clip.frames);
        all.push_back(&clip);
        if (!clip.stored) fresh.push_back(&clip);
    }
    kernels::CleanedBatch made;
    if (!fresh.empty()) made = cleaned(device, fresh, header, options_.clean);
    return fresh.size() == all.size() ? std::move(made) : with_stored(all, made, header);
}

}  // namespace actformer::ingest
