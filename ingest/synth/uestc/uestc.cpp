#include "ingest/synth/uestc/uestc.hpp"

#include <fmt/format.h>

#include <numeric>

#include "base/threads/parallel.hpp"
#include "ingest/synth/folder.hpp"
#include "ingest/synth/pickle_writer.hpp"
#include "ingest/synth/programmes/exercises.hpp"
#include "ingest/synth/vibe.hpp"

namespace actformer::ingest::synth {
namespace {

constexpr std::size_t subjects = 118, views = 8;
constexpr int going_round = 8;

struct Video {
    std::size_t action = 0;
    int view = 0, subject = 1, side = 1;
    VibeTrack track;

    std::string name() const {
        return fmt::format("a{}_d{}_p{:03}_c{}_color.avi", action, view, subject, side);
    }
};

Video video_at(std::size_t i, std::uint64_t seed) {
    Random random{seed, 0x0E57C, i};
    Video video;
    video.action = i % exercises().size();
    const auto turn = i / exercises().size();
    // Steps that share no divisor with the numbers of views and subjects lead through all of them.
    video.subject = 1 + static_cast<int>((turn * 5 + video.action * 7) % subjects);
    video.side = turn % 2 == 0 ? 1 : 2;
    video.view = video.side != 1 && random.chance(0.1) ? going_round
                                                       : static_cast<int>((turn * 3 + video.action) % views);
    auto motion = smpl_solo(exercises()[video.action].programme, {seed, 0x0E57D, i},
                            static_cast<std::uint64_t>(video.subject), of_video);
    // The camera of a view stands 45 degrees further round the person, who is seen turned the other way.
    double heading = 8 * random.normal();
    if (video.side != 1) heading -= 45.0 * video.view;
    place_before_camera(motion, heading, 0.2 * random.normal(), 4);
    video.track = vibe_track(in_axes(motion, below_camera));
    return video;
}

std::string pickle_of(const std::vector<Video>& videos) {
    PickleWriter p;
    const auto lists = [&](const char* name, auto add) {
        p.text(name);
        p.list([&] {
            for (const auto& video : videos) add(video.track);
        });
    };
    p.dict([&] {
        lists("pred_cam", [&](const VibeTrack& t) { p.array({t.frames, 3}, t.pred_cam); });
        lists("orig_cam", [&](const VibeTrack& t) { p.array({t.frames, 4}, t.orig_cam); });
        lists("pose", [&](const VibeTrack& t) { p.array({t.frames, 72}, t.pose); });
        lists("betas", [&](const VibeTrack& t) {
            p.array({t.frames, 10}, std::vector<float>(t.frames * 10, 0));
        });
        lists("joints3d", [&](const VibeTrack& t) { p.array({t.frames, 49, 3}, t.joints3d); });
        lists("bboxes", [&](const VibeTrack& t) { p.array({t.frames, 4}, t.bboxes); });
        lists("frame_ids", [&](const VibeTrack& t) {
            std::vector<std::int64_t> numbers(t.frames);
            std::iota(numbers.begin(), numbers.end(), 0);
            p.array({t.frames}, numbers);
        });
    });
    return p.finish();
}

}  // namespace

StandInSummary synthesise_uestc(const StandInOptions& options) {
    claim_folder(options.folder, "actformer synth uestc", options.seed);
    std::vector<Video> videos(options.clips);
    Counting counting(options);
    parallel_for(videos.size(), thread_count(options.threads), [&](std::size_t i, unsigned) {
        videos[i] = video_at(i, options.seed);
        counting.clip_done(videos[i].track.frames, 0);
    });
    std::string names, lengths, classes;
    for (const auto& video : videos) {
        names += video.name() + "\n";
        lengths += fmt::format("{}\n", video.track.frames);
    }
    for (const auto& exercise : exercises()) classes += fmt::format("{}\n", exercise.name);
    write_file(options.folder / "info" / "names.txt", names);
    write_file(options.folder / "info" / "num_frames_min.txt", lengths);
    write_file(options.folder / "info" / "action_classes.txt", classes);
    const auto bytes = pickle_of(videos);
    write_file(options.folder / "vibe_cache_refined.pkl", bytes);
    counting.add_bytes(bytes.size());
    return counting.summary();
}

}  // namespace actformer::ingest::synth
