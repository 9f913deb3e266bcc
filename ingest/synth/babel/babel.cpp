#include "ingest/synth/babel/babel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files/file.hpp"
#include "base/threads/parallel.hpp"
#include "ingest/export/npz/npz_writer.hpp"
#include "ingest/synth/babel/acts.hpp"
#include "ingest/synth/babel/plan.hpp"
#include "ingest/synth/folder.hpp"
#include "ingest/synth/smpl/smpl_motion.hpp"

namespace actformer::ingest::synth {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t joints_of_smplh = 52, between = 12;  // frames from one action to the next

/// Where an action begins and ends, in seconds.
struct Span {
    std::size_t act;
    double start, end;
};

struct Sequence {
    SmplMotion motion;  ///< at play_fps, z up
    std::vector<Span> spans;
};

Sequence perform(const PlannedSequence& planned, std::size_t number, std::uint64_t seed) {
    Sequence out;
    Random random{seed, 0xBABE2, number};
    const auto performer = 1 + random.below(60);
    for (std::size_t i = 0; i < planned.acts.size(); ++i) {
        auto motion = smpl_solo(*acts()[planned.acts[i]].programme, {seed, 0xBABE3, number, i},
                                static_cast<std::uint64_t>(performer), of_mocap);
        const auto frames = motion.size();
        if (i == 0) place(motion, random.uniform(-180, 180), {random.normal(), 0, random.normal()});
        go_on(out.motion, std::move(motion), between);
        const auto end = static_cast<double>(out.motion.size()) / play_fps;
        out.spans.push_back({planned.acts[i], end - static_cast<double>(frames) / play_fps, end});
    }
    out.motion = in_axes(out.motion, z_up);
    return out;
}

/// As AMASS's files: hands are flat, bodies the mean one. Returns how many bytes the file has.
std::uint64_t write_npz(const fs::path& file, const SmplMotion& motion, double fps) {
    std::vector<double> poses, way;
    for (const auto& pose : motion) {
        auto vectors = rotation_vectors(pose);
        vectors.resize(3 * 22);  // SMPL+H has no hands as joints 22 and 23, but fingers
        vectors.resize(3 * joints_of_smplh, 0);
        poses.insert(poses.end(), vectors.begin(), vectors.end());
        way.insert(way.end(), {pose.pelvis.x, pose.pelvis.y, pose.pelvis.z});
    }
    const std::uint64_t frames = motion.size();
    const std::vector<double> betas(16, 0), soft_tissue(frames * 8, 0);
    make_folders(file.parent_path());
    NpzWriter npz(file, Sync::later);
    npz.add("trans", {frames, 3}, way);
    npz.add("gender", std::string("neutral"));
    npz.add("mocap_framerate", {}, std::span(&fps, 1));
    npz.add("betas", {16}, betas);
    npz.add("dmpls", {frames, 8}, soft_tissue);
    npz.add("poses", {frames, 3 * joints_of_smplh}, poses);
    npz.finish();
    return fs::file_size(file);
}

std::string uuid(Random& random) {
    const auto a = random.bits(), b = random.bits();
    return fmt::format("{:08x}-{:04x}-4{:03x}-a{:03x}-{:012x}", a >> 32, a >> 16 & 0xFFFF, a & 0xFFF, b >> 52,
                       b & 0xFFFFFFFFFFFF);
}

Json label(const std::string& text, const Json& categories, Random& random) {
    return {{"raw_label", text}, {"proc_label", text}, {"seg_id", uuid(random)}, {"act_cat", categories}};
}

Json timed_label(const std::string& text, const Json& categories, double start, double end, Random& random) {
    auto out = label(text, categories, random);
    out["start_t"] = start;
    out["end_t"] = end;
    return out;
}

/// Rounded as people set them.
double tidy(double seconds) {
    return std::max(0.0, std::round(seconds * 1000) / 1000);
}

Json labels_of(const Sequence& sequence, Random& random) {
    std::vector<Json> labels;
    double before = 0;
    for (const auto& span : sequence.spans) {
        const auto& act = acts()[span.act];
        const std::string name(act.category);
        if (span.start > before)
            labels.push_back(timed_label("transition", Json::array({"transition"}), tidy(before),
                                         tidy(span.start), random));
        Json categories = Json::array({name});
        const bool together = random.chance(0.5);
        for (const auto also : act.also)
            if (together) categories.push_back(also);
        labels.push_back(timed_label(name, categories, tidy(span.start), tidy(span.end), random));
        for (const auto also : act.also)  // or as a label of its own, that overlaps
            if (!together)
                labels.push_back(timed_label(std::string(also), Json::array({also}),
                                             tidy(span.start + random.uniform(0, 0.4)),
                                             tidy(span.end + random.uniform(-0.4, 0.3)), random));
        before = span.end;
    }
    if (random.chance(0.05)) labels.push_back(timed_label("unclear", nullptr, 0, tidy(before), random));
    for (std::size_t i = labels.size(); i > 1; --i)
        std::swap(labels[i - 1], labels[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
    return labels;
}

Json annotation(Json labels, bool several, Random& random) {
    return {{"babel_lid", uuid(random)},
            {"anntr_id", uuid(random)},
            {"mul_act", several},
            {"labels", std::move(labels)}};
}

/// What BABEL says of one recording. Where there is one action, now and then of the whole alone.
Json described(const PlannedSequence& planned, const Sequence& sequence, std::size_t number,
               std::uint64_t seed) {
    Random random{seed, 0xBABE4, number};
    const auto& first = acts()[sequence.spans[0].act].category;
    const bool several = sequence.spans.size() > 1;
    Json out{{"babel_sid", number},
             {"url", ""},
             {"feat_p", planned.feat_p()},
             {"dur", tidy(static_cast<double>(sequence.motion.size()) / play_fps)}};
    out["seq_ann"] =
        annotation(Json::array({label(std::string(first), Json::array({first}), random)}), several, random);
    out["frame_ann"] = several ? annotation(labels_of(sequence, random), true, random) : Json();
    return out;
}

}  // namespace

StandInSummary synthesise_babel(const StandInOptions& options) {
    claim_folder(options.folder, "actformer synth babel", options.seed, options.clips);
    const auto planned = plan(options.clips, options.seed);
    std::vector<Json> descriptions(planned.size());
    Counting counting(options);
    parallel_for(planned.size(), thread_count(options.threads), [&](std::size_t i, unsigned) {
        const auto& one = planned[i];
        const auto sequence = perform(one, i, options.seed);
        descriptions[i] = described(one, sequence, i, options.seed);
        const auto file = options.folder / "amass" / one.set / one.subject / (one.trial + "_poses.npz");
        const bool there = fs::exists(file);
        const auto motion = there ? SmplMotion() : resampled(sequence.motion, one.fps);
        const auto bytes = there ? 0 : write_npz(file, motion, one.fps);
        for (std::size_t act = 0; act < one.acts.size(); ++act)
            counting.clip_done(act == 0 ? motion.size() : 0, act == 0 ? bytes : 0, !there);
    });
    for (const bool validation : {false, true}) {
        Json all = Json::object();
        for (std::size_t i = 0; i < planned.size(); ++i)
            if (planned[i].validation == validation) all[std::to_string(i)] = std::move(descriptions[i]);
        write_file(options.folder / "babel_v1.0_release" / (validation ? "val.json" : "train.json"),
                   all.dump());
    }
    return counting.summary();
}

}  // namespace actformer::ingest::synth
