#include "ingest/synth/nturecon/nturecon.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/synth/folder.hpp"
#include "ingest/synth/pickle_writer.hpp"
#include "ingest/synth/programmes/ntu.hpp"
#include "ingest/synth/smpl/smpl_motion.hpp"

namespace actformer::ingest::synth {
namespace {

std::vector<int> one_person_actions() {
    std::vector<int> out;
    for (int a = 1; a <= ntu::actions; ++a)
        if (!ntu::two_persons(a)) out.push_back(a);
    return out;
}

}  // namespace

std::string nturecon_pickle(const ClipId& clip, std::uint64_t seed, std::uint64_t& frames) {
    const std::vector<std::uint64_t> key{seed,
                                         0x4EC0,
                                         static_cast<std::uint64_t>(clip.setup),
                                         static_cast<std::uint64_t>(clip.camera),
                                         static_cast<std::uint64_t>(clip.performer),
                                         static_cast<std::uint64_t>(clip.replication),
                                         static_cast<std::uint64_t>(clip.action)};
    auto motion =
        smpl_solo(programme_of(clip.action), key, static_cast<std::uint64_t>(clip.performer), of_video);
    Random random{seed, 0x4EC1, key[2], key[3], key[4], key[5], key[6]};
    const double heading = 17 * random.normal();
    place_before_camera(motion, heading, 0.2 * random.normal(), 3);
    const double scaling = random.uniform(88, 102);
    std::vector<double> poses, ways;
    for (const auto& pose : in_axes(motion, below_camera)) {
        const auto vectors = rotation_vectors(pose);
        poses.insert(poses.end(), vectors.begin(), vectors.end());
        const Vec way = pose.pelvis * scaling;
        ways.insert(ways.end(), {way.x, way.y, way.z});
    }
    frames = motion.size();
    PickleWriter pickle;
    pickle.dict([&] {
        pickle.text("smpl_poses");
        pickle.array({frames, 72}, poses);
        pickle.text("smpl_trans");
        pickle.array({frames, 3}, ways);
        pickle.text("smpl_scaling");
        pickle.array({1}, std::span(&scaling, 1));
        pickle.text("smpl_loss");
        pickle.number(random.uniform(0.5, 3));
    });
    return pickle.finish();
}

StandInSummary synthesise_nturecon(const StandInOptions& options) {
    const auto actions = one_person_actions();
    claim_folder(options.folder, "actformer synth nturecon", options.seed);
    Counting counting(options);
    parallel_for(options.clips, thread_count(options.threads), [&](std::size_t i, unsigned) {
        const auto clip = clip_at(i, actions);
        const auto file =
            options.folder / "motions" / fmt::format("S{:03}", clip.setup) / (clip.name() + "_body0.pkl");
        if (std::filesystem::exists(file)) return counting.clip_done(0, 0, false);
        std::uint64_t frames = 0;
        const auto bytes = nturecon_pickle(clip, options.seed, frames);
        write_file(file, bytes);
        counting.clip_done(frames, bytes.size());
    });
    return counting.summary();
}

}  // namespace actformer::ingest::synth
