#include "ingest/formats/ntu/ntu_format.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/formats/ntu/name.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"

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
    header.persons = persons;
    header.fields = {"setup", "camera", "performer", "replication", "action"};
    header.splits = ntu_splits();
    for (int action = 1; action <= ntu::actions; ++action)
        if (ntu::two_persons(action) == (persons == 2)) header.classes.emplace_back(ntu::action_name(action));
    return header;
}

std::uint32_t label_of(int action) {
    std::uint32_t label = 0;
    for (int before = 1; before < action; ++before)
        label += ntu::two_persons(before) == ntu::two_persons(action);
    return label;
}

/// The `persons` bodies seen in most frames, ties going to the first seen.
bool keep_most_seen(std::vector<Body>& bodies, std::size_t persons) {
    std::stable_sort(bodies.begin(), bodies.end(),
                     [](const Body& a, const Body& b) { return a.times.size() > b.times.size(); });
    if (bodies.size() < persons) return false;
    bodies.resize(persons);
    return true;
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

NtuFormat::NtuFormat(std::unordered_set<std::string> missing, kernels::Smoothing smoothing)
    : missing_(std::move(missing)),
      smoothing_(smoothing),
      datasets_{family("ntu-1p", 1), family("ntu-2p", 2)} {}

std::string NtuFormat::settings() const {
    auto text =
        fmt::format("ntu: Gaussian smoothing sigma {} radius {} frames", smoothing_.sigma, smoothing_.radius);
    if (missing_.empty()) return text;
    Checksum names;
    for (const auto& name : std::set<std::string>(missing_.begin(), missing_.end())) names.add(name + "\n");
    return text + fmt::format(", {} clips named as missing ({})", missing_.size(), names.hex());
}

std::optional<Rejection> NtuFormat::refuse(const RawText& raw) const {
    if (!missing_.contains(std::string(raw.stem))) return {};
    return Rejection{Rejection::Kind::missing, "named in the missing list"};
}

void NtuFormat::read(const RawText& raw, ClipSink& sink) const {
    sink.take(parse(raw));
}

ParsedClip NtuFormat::parse(const RawText& raw) const {
    const auto name = parse_ntu_name(raw.stem);
    if (!name)
        return Rejection{Rejection::Kind::broken,
                         "the name is not SsssCcccPpppRrrrAaaa with an action from 001 to 120"};
    auto read = read_skeleton(raw.text);
    if (auto* rejection = std::get_if<Rejection>(&read)) return std::move(*rejection);
    auto& file = std::get<SkeletonFile>(read);

    auto clip = std::make_unique<NtuClip>();
    clip->dataset = ntu::two_persons(name->action) ? 1 : 0;
    const auto persons = datasets_[clip->dataset].persons,
               seen = static_cast<std::uint32_t>(file.bodies.size());
    if (seen == 0) return Rejection{Rejection::Kind::broken, "no body in any frame"};
    if (!keep_most_seen(file.bodies, persons))
        return Rejection{Rejection::Kind::dropped, fmt::format("{} of {} persons seen", seen, persons)};
    clip->name = raw.stem;
    clip->label = label_of(name->action);
    for (const int value : {name->setup, name->camera, name->performer, name->replication, name->action})
        clip->fields.push_back(std::to_string(value));
    clip->frames = file.frames;
    clip->bodies = std::move(file.bodies);
    for (auto& body : clip->bodies) body.id = {};  // the text goes away
    return clip;
}

kernels::CleanedBatch NtuFormat::clean(kernels::Device& device, std::size_t dataset,
                                       std::span<const std::unique_ptr<RawClip>> clips,
                                       std::vector<std::uint32_t>& frames) const {
    kernels::ClipBatch batch;
    batch.persons = datasets_[dataset].persons;
    batch.joints = ntu_joints;
    batch.first = {0};
    for (const auto& raw : clips) {
        const auto& clip = static_cast<const NtuClip&>(*raw);
        batch.frames.push_back(clip.frames);
        batch.step.push_back(1);
        for (const auto& body : clip.bodies) {
            for (const auto time : body.times) batch.times.push_back(static_cast<float>(time));
            batch.first.push_back(static_cast<std::uint32_t>(batch.times.size()));
        }
    }
    frames = batch.frames;
    auto limbs = kernels::limb_buffer(device, batch.times.size(), ntu_joints);
    limbs.write_with([&](std::span<float> to) {
        auto at = to.begin();
        for (const auto& raw : clips)
            for (const auto& body : static_cast<const NtuClip&>(*raw).bodies)
                at = std::copy(body.limbs.begin(), body.limbs.end(), at);
    });
    return kernels::clean(device, batch, limbs, smoothing_);
}

}  // namespace actformer::ingest
