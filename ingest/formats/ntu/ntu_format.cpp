#include "ingest/formats/ntu/ntu_format.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/detections.hpp"
#include "ingest/formats/frame_span.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/formats/ntu/name.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"
#include "ingest/formats/ntu/tracks.hpp"
#include "ingest/formats/stillness.hpp"

namespace actformer::ingest {
namespace {

struct NtuClip : RawClip {
    std::uint32_t frames = 0;
    std::vector<Body> bodies;  ///< those kept, as many as the dataset has persons

    std::size_t bytes() const override {
        std::size_t all = sizeof *this;
        for (const auto& body : bodies) all += 4 * (body.times.size() + body.limbs.size());
        return all;
    }
};

/// Classes of one family in the order of their numbers, and each action's label among them.
DatasetHeader family(const std::string& name, std::uint32_t persons) {
    DatasetHeader header;
    header.name = name;
    header.topology = ntu25();
    header.origin.kind = DataOrigin::Kind::recorded;
    header.persons = persons;
    header.fields = ntu_fields();
    header.splits = ntu_splits();
    header.classes = ntu::class_names(static_cast<int>(persons));
    return header;
}

using ntu::label_of;

constexpr auto zeros_doubt = "bodies or joints at 0 0 0 or NaN were not seen: filled from the frames around";
constexpr auto tracks_doubt = "a body's tracking number changes: --join-tracks makes one body of such tracks";
constexpr auto seldom_doubt = "persons seen in less than half of the frames: filled from the frames around";
constexpr auto ghost_doubt =
    "a body that is left out moves more than one kept, perhaps a ghost: --bodies motion takes those that "
    "move most";

/// What bodies the reader left out; empty where there are none.
std::string left_out(const SkeletonFile& file) {
    if (file.never_seen.empty()) return {};
    return fmt::format("a body whose {} is never seen is left out",
                       in_quotes(ntu25().names[file.never_seen[0]]));
}

/// Whether the two choices show the same bodies, whatever their order.
bool same(std::vector<std::size_t> a, std::vector<std::size_t> b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
}

/// Whether one of the `kept` goes on in another track.
bool goes_on(const std::vector<std::size_t>& kept, const std::vector<std::vector<std::size_t>>& persons) {
    return std::any_of(persons.begin(), persons.end(), [&](const auto& tracks) {
        return tracks.size() > 1 && std::any_of(tracks.begin(), tracks.end(), [&](std::size_t track) {
                   return std::find(kept.begin(), kept.end(), track) != kept.end();
               });
    });
}

/// Doubts about the bodies that are kept.
void add_doubts(const SkeletonFile& file, std::vector<std::string>& doubts) {
    std::vector<bool> still;
    for (const auto& body : file.bodies) still.push_back(stands_still(body));
    for (auto& doubt : stillness_doubts(file.frames, still)) doubts.push_back(std::move(doubt));
    if (std::any_of(file.bodies.begin(), file.bodies.end(),
                    [&](const Body& body) { return 2 * body.times.size() < file.frames; }))
        doubts.emplace_back(seldom_doubt);
}

/// Keeps frames `first` to `last`, the latter not among them, and the bodies seen there.
void cut(SkeletonFile& file, std::uint32_t first, std::uint32_t last) {
    constexpr std::size_t numbers = ntu_joints * 3;
    std::vector<Body> bodies;
    for (const auto& body : file.bodies) {
        const auto from = std::lower_bound(body.times.begin(), body.times.end(), first) - body.times.begin(),
                   to = std::lower_bound(body.times.begin(), body.times.end(), last) - body.times.begin();
        if (from == to) continue;
        auto& kept = bodies.emplace_back(Body{body.id, {}, {}});
        for (auto i = from; i < to; ++i)
            kept.times.push_back(body.times[static_cast<std::size_t>(i)] - first);
        kept.limbs.assign(body.limbs.begin() + from * std::ptrdiff_t{numbers},
                          body.limbs.begin() + to * std::ptrdiff_t{numbers});
    }
    file.bodies = std::move(bodies);
    file.frames = last - first;
}

std::vector<std::string> numbers(int first, int last, int step = 1) {
    std::vector<std::string> out;
    for (int i = first; i <= last; i += step) out.push_back(std::to_string(i));
    return out;
}

}  // namespace

std::vector<Split> ntu_splits() {
    std::vector<std::string> performers;
    for (int p = 1; p <= 106; ++p)
        if (ntu::xsub_train(p)) performers.push_back(std::to_string(p));
    const Condition ntu60{"action", numbers(1, 60)};
    const std::vector<std::string> cameras{"2", "3"}, even = numbers(2, 32, 2);
    return {{"xsub/train", {{"performer", performers}}},
            {"xsub/test", {{"performer", performers, true}}},
            {"xview/train", {ntu60, {"camera", cameras}}},
            {"xview/test", {ntu60, {"camera", cameras, true}}},
            {"xset/train", {{"setup", even}}},
            {"xset/test", {{"setup", even, true}}}};
}

NtuFormat::NtuFormat(NtuOptions options) : options_(std::move(options)) {
    if (options_.own)
        own_.emplace(*options_.own);
    else
        datasets_ = {family("ntu-1p", 1), family("ntu-2p", 2)};
}

void NtuFormat::settle() {
    if (own_) datasets_ = {own_->settle()};
}

std::vector<std::string> NtuFormat::remarks() const {
    return own_ ? own_->remarks() : std::vector<std::string>();
}

std::string NtuFormat::settings() const {
    const auto& [missing, bodies, join_tracks, smoothing, own] = options_;
    auto text =
        fmt::format("ntu: Gaussian smoothing sigma {} radius {} frames", smoothing.sigma, smoothing.radius);
    if (own_) text += ", " + own_->settings();
    if (bodies == BodyRule::motion) text += ", bodies that move most";
    if (join_tracks) text += ", tracks joined";
    if (missing.empty()) return text;
    Checksum names;
    for (const auto& name : std::set<std::string>(missing.begin(), missing.end())) names.add(name + "\n");
    return text + fmt::format(", {} clips named as missing ({})", missing.size(), names.hex());
}

std::optional<Rejection> NtuFormat::refuse(const RawText& raw) const {
    if (!options_.missing.contains(std::string(raw.stem))) return {};
    return Rejection{Rejection::Kind::missing, "named in the missing list"};
}

void NtuFormat::read(const RawText& raw, ClipSink& sink) const {
    auto planned = clips_of(raw);
    if (auto* rejection = std::get_if<Rejection>(&planned)) return sink.take(std::move(*rejection));
    auto& clips = std::get<std::vector<Planned>>(planned);
    auto read = read_skeleton(raw.text);
    if (auto* rejection = std::get_if<Rejection>(&read)) return sink.take(std::move(*rejection));
    auto& file = std::get<SkeletonFile>(read);
    if (clips.size() == 1) return sink.take(make_clip(std::move(clips[0]), std::move(file)));
    for (auto& clip : clips) {
        const auto name = clip.name;
        auto made = make_clip(std::move(clip), file);
        if (auto* rejection = std::get_if<Rejection>(&made))
            rejection->reason = fmt::format("clip {}: {}", name, rejection->reason);
        sink.take(std::move(made));
    }
}

std::variant<std::vector<NtuFormat::Planned>, Rejection> NtuFormat::clips_of(const RawText& raw) const {
    if (own_) return named_clips_of(raw);
    const auto name = parse_ntu_name(raw.stem);
    if (!name)
        return Rejection{Rejection::Kind::broken,
                         "the name is not SsssCcccPpppRrrrAaaa with an action from 001 to 120; --name or "
                         "--labels takes other names"};
    Planned clip{ntu::two_persons(name->action) ? std::size_t{1} : 0,
                 std::string(raw.stem),
                 label_of(name->action),
                 {},
                 {},
                 {}};
    clip.fields = ntu_fields_of(*name);
    return std::vector{std::move(clip)};
}

std::variant<std::vector<NtuFormat::Planned>, Rejection> NtuFormat::named_clips_of(const RawText& raw) const {
    auto named = own_->clips_of(raw);
    if (auto* rejection = std::get_if<Rejection>(&named)) return std::move(*rejection);
    const auto& classes = datasets_[0].classes;
    std::vector<Planned> out;
    for (auto& clip : std::get<std::vector<NamedClip>>(named)) {
        const auto label = std::lower_bound(classes.begin(), classes.end(), clip.action) - classes.begin();
        out.push_back({0, std::move(clip.name), static_cast<std::uint32_t>(label), std::move(clip.fields),
                       clip.start, clip.end});
    }
    return out;
}

bool NtuFormat::choose_bodies(SkeletonFile& file, std::size_t persons,
                              std::vector<std::string>& doubts) const {
    const auto tracks = persons_of(file.bodies);
    if (options_.join_tracks) file.bodies = joined(file.bodies, tracks);
    if (file.bodies.size() < persons) return false;
    const auto kept = preferred(file.bodies, persons, options_.bodies);
    if (file.filled) doubts.emplace_back(zeros_doubt);
    if (!options_.join_tracks && goes_on(kept, tracks)) doubts.emplace_back(tracks_doubt);
    if (options_.bodies == BodyRule::frames && file.bodies.size() > persons &&
        !same(kept, preferred(file.bodies, persons, BodyRule::motion)))
        doubts.emplace_back(ghost_doubt);
    std::vector<Body> bodies;
    for (const auto body : kept) bodies.push_back(std::move(file.bodies[body]));
    file.bodies = std::move(bodies);
    add_doubts(file, doubts);
    return true;
}

ParsedClip NtuFormat::make_clip(Planned planned, SkeletonFile file) const {
    const auto span = frame_span(planned.start, planned.end, file.frames);
    if (planned.start || planned.end) {
        if (span.empty())
            return Rejection{Rejection::Kind::broken,
                             fmt::format("no frame is left of {}: from {} to {}", file.frames,
                                         planned.start.value_or(0), span.last)};
        cut(file, span.first, span.last);
    }
    auto clip = std::make_unique<NtuClip>();
    span.add_doubts(clip->doubts);
    clip->dataset = planned.dataset;
    const auto persons = datasets_[clip->dataset].persons,
               seen = static_cast<std::uint32_t>(file.bodies.size());
    const auto lost = left_out(file), also = lost.empty() ? "" : "; " + lost;
    if (seen == 0) return Rejection{Rejection::Kind::broken, "no body in any frame" + also};
    if (!choose_bodies(file, persons, clip->doubts))
        return Rejection{Rejection::Kind::dropped,
                         fmt::format("{} of {} persons seen{}", seen, persons, also)};
    if (!lost.empty()) clip->doubts.push_back(lost);
    clip->name = std::move(planned.name);
    clip->label = planned.label;
    clip->fields = std::move(planned.fields);
    clip->frames = file.frames;
    clip->bodies = std::move(file.bodies);
    for (auto& body : clip->bodies) body.id = {};  // the text goes away
    return clip;
}

kernels::CleanedBatch NtuFormat::clean(kernels::Device& device, std::size_t dataset,
                                       std::span<const std::unique_ptr<RawClip>> clips,
                                       std::vector<std::uint32_t>& frames) const {
    return clean_detections<NtuClip>(
        device, datasets_[dataset].persons, ntu_joints, clips,
        [](const NtuClip& clip) -> auto& { return clip.bodies; }, options_.smoothing, frames);
}

}  // namespace actformer::ingest
