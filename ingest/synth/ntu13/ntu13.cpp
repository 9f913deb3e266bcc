#include "ingest/synth/ntu13/ntu13.hpp"

#include <algorithm>
#include <numeric>

#include "base/threads/parallel.hpp"
#include "ingest/synth/folder.hpp"
#include "ingest/synth/ntu/naming.hpp"
#include "ingest/synth/pickle_writer.hpp"
#include "ingest/synth/programmes/ntu.hpp"
#include "ingest/synth/vibe.hpp"

namespace actformer::ingest::synth {
namespace {

/// NTU's numbers of the 13 classes.
const std::vector<int> actions{6, 7, 8, 9, 22, 23, 24, 38, 80, 93, 99, 100, 102};

VibeTrack track_of(const ClipId& clip, std::size_t i, std::uint64_t seed) {
    auto motion = smpl_solo(programme_of(clip.action), {seed, 0x4713, i},
                            static_cast<std::uint64_t>(clip.performer), of_video);
    Random random{seed, 0x4714, i};
    const double heading = 17 * random.normal();
    place_before_camera(motion, heading, 0.3 * random.normal(), 3.5);
    return vibe_track(in_axes(motion, below_camera));
}

std::string pickle_of(const VibeTrack& track) {
    const auto frames = track.frames;
    const std::vector<float> betas(frames * 10, 0);
    std::vector<std::int64_t> numbers(frames);
    std::iota(numbers.begin(), numbers.end(), 0);
    PickleWriter p;
    p.dict([&] {
        p.integer(1);
        p.dict([&] {
            p.text("pred_cam");
            p.array({frames, 3}, track.pred_cam);
            p.text("orig_cam");
            p.array({frames, 4}, track.orig_cam);
            p.text("verts");
            p.none();
            p.text("pose");
            p.array({frames, 72}, track.pose);
            p.text("betas");
            p.array({frames, 10}, betas);
            p.text("joints3d");
            p.array({frames, 49, 3}, track.joints3d);
            p.text("joints2d");
            p.none();
            p.text("bboxes");
            p.array({frames, 4}, track.bboxes);
            p.text("frame_ids");
            p.array({frames}, numbers);
        });
    });
    return p.finish();
}

}  // namespace

StandInSummary synthesise_ntu13(const StandInOptions& options) {
    claim_folder(options.folder, "actformer synth ntu13", options.seed);
    std::vector<std::string> paths(options.clips);
    Counting counting(options);
    parallel_for(options.clips, thread_count(options.threads), [&](std::size_t i, unsigned) {
        const auto clip = clip_at(i, actions);
        paths[i] = "ntu_vibe/" + clip.name() + ".pkl";
        const auto file = options.folder / paths[i];
        if (std::filesystem::exists(file)) return counting.clip_done(0, 0, false);
        const auto track = track_of(clip, i, options.seed);
        const auto bytes = pickle_of(track);
        write_file(file, bytes);
        counting.clip_done(track.frames, bytes.size());
    });
    std::sort(paths.begin(), paths.end());
    std::string list;
    for (const auto& path : paths) list += path + "\n";
    write_file(options.folder / "ntu_vibe_list.txt", list);
    return counting.summary();
}

}  // namespace actformer::ingest::synth
