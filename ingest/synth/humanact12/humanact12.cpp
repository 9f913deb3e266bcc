#include "ingest/synth/humanact12/humanact12.hpp"

#include <array>

#include "base/threads/parallel.hpp"
#include "ingest/synth/folder.hpp"
#include "ingest/synth/pickle_writer.hpp"
#include "ingest/synth/programmes/everyday.hpp"
#include "ingest/synth/programmes/ntu.hpp"
#include "ingest/synth/smpl/smpl_motion.hpp"

namespace actformer::ingest::synth {
namespace {

/// What is done in each class, in the order of the labels.
const std::array<std::vector<const Programme*>, 12>& classes() {
    static const auto ntu = [](int action) { return &programme_of(action); };
    static const auto day = [](std::string_view name) { return &everyday_programme(name); };
    static const std::array<std::vector<const Programme*>, 12> all{{
        {ntu(97), ntu(104), ntu(101), day("waist movements")},  // warm_up
        {day("walk")},
        {day("run")},
        {day("jump"), ntu(27)},
        {ntu(1)},  // drink
        {day("lift_dumbbell")},
        {ntu(8)},  // sit
        {ntu(2)},  // eat
        {day("turn steering wheel")},
        {ntu(28)},  // phone
        {day("boxing")},
        {ntu(7)}  // throw
    }};
    return all;
}

struct Clip {
    std::uint64_t frames = 0;
    std::vector<double> poses, joints;  ///< (frames, 72) and (frames, 24, 3)
};

Clip clip_at(std::size_t i, std::uint64_t seed) {
    const auto label = i % classes().size(), turn = i / classes().size();
    const auto& programmes = classes()[label];
    const std::vector<std::uint64_t> key{seed, 0x4AC7, i};
    Random random{seed, 0x4AC8, i};
    auto motion =
        smpl_solo(*programmes[turn % programmes.size()], key, 1 + turn % 12, of_video);  // twelve persons
    const double heading = 40 * random.normal();
    place_before_camera(motion, heading, 0.3 * random.normal(), 2.6);
    Clip clip{motion.size(), {}, {}};
    for (const auto& pose : in_axes(motion, below_camera)) {
        const auto vectors = rotation_vectors(pose);
        clip.poses.insert(clip.poses.end(), vectors.begin(), vectors.end());
        for (const auto& at : smpl_places(pose)) clip.joints.insert(clip.joints.end(), {at.x, at.y, at.z});
    }
    return clip;
}

}  // namespace

StandInSummary synthesise_humanact12(const StandInOptions& options) {
    claim_folder(options.folder, "actformer synth humanact12", options.seed);
    std::vector<Clip> clips(options.clips);
    Counting counting(options);
    parallel_for(clips.size(), thread_count(options.threads), [&](std::size_t i, unsigned) {
        clips[i] = clip_at(i, options.seed);
        counting.clip_done(clips[i].frames, 0);
    });
    PickleWriter pickle;
    const auto lists = [&](const char* name, auto add) {
        pickle.text(name);
        pickle.list([&] {
            for (std::size_t i = 0; i < clips.size(); ++i) add(i);
        });
    };
    pickle.dict([&] {
        lists("poses", [&](std::size_t i) { pickle.array({clips[i].frames, 72}, clips[i].poses); });
        pickle.text("oldposes");
        pickle.list([] {});
        lists("joints3D", [&](std::size_t i) { pickle.array({clips[i].frames, 24, 3}, clips[i].joints); });
        lists("y", [&](std::size_t i) { pickle.integer(static_cast<std::int32_t>(i % classes().size())); });
    });
    const auto bytes = pickle.finish();
    write_file(options.folder / "HumanAct12Poses" / "humanact12poses.pkl", bytes);
    counting.add_bytes(bytes.size());
    return counting.summary();
}

}  // namespace actformer::ingest::synth
