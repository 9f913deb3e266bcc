#include "ingest/synth/ntu/ntu.hpp"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <set>

#include "base/error.hpp"
#include "base/text/counted.hpp"
#include "base/threads/parallel.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/synth/folder.hpp"
#include "ingest/synth/ntu/kinect.hpp"
#include "ingest/synth/ntu/skeleton_writer.hpp"

namespace actformer::ingest::synth {
namespace {

namespace fs = std::filesystem;

/// Returns how many frames the clip has.
std::size_t make_text(const ClipId& clip, std::uint64_t seed, std::string& text) {
    const NtuCasting casting{seed, clip.setup, clip.performer, clip.replication, clip.action};
    const auto recording = record(perform(casting), casting, clip.camera);
    write_skeleton(recording, text);
    return recording.size();
}

std::vector<int> checked_actions(const NtuOptions& options) {
    auto actions = options.actions;
    if (actions.empty()) {
        actions.resize(ntu::actions);
        std::iota(actions.begin(), actions.end(), 1);
    }
    std::sort(actions.begin(), actions.end());
    actions.erase(std::unique(actions.begin(), actions.end()), actions.end());
    for (const int a : actions) ntu::action_name(a);  // refuses what is no action
    if (const auto most = actions.size() * clips_per_action; options.clips > most)
        throw Error(
            "{} clips: of {} there are at most {} clips with names of their own ({} each); ask for fewer",
            options.clips, counted(actions.size(), "action"), most, clips_per_action);
    if (options.clips == 0) throw Error("0 clips: ask for at least one");
    return actions;
}

/// Whoever ingests the folder would take them together. Before synth.json is there, no file is of this program.
void refuse_other_clips(const NtuOptions& options, const std::vector<int>& actions) {
    std::set<std::string> there;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(options.folder, ignored))
        if (entry.path().extension() == ".skeleton") there.insert(entry.path().stem().string());
    if (there.empty()) return;
    if (fs::exists(options.folder / "synth.json"))
        for (std::uint64_t i = 0; i < options.clips; ++i) there.erase(synth::clip_at(i, actions).name());
    if (!there.empty())
        throw Error(
            "{}: holds {} that these options do not make, as {}.skeleton; choose another folder with -o, or "
            "give the --seed, the --actions and at least the --clips that they were made with",
            options.folder.string(), counted(there.size(), ".skeleton file"), *there.begin());
}

}  // namespace

NtuSummary synthesise_ntu(const NtuOptions& options, const std::function<void(std::uint64_t)>& progress) {
    const auto actions = checked_actions(options);
    refuse_other_clips(options, actions);
    claim_folder(options.folder, "actformer synth ntu", options.seed);
    const auto threads = thread_count(options.threads);
    std::vector<std::string> texts(threads);
    NtuSummary summary;
    std::mutex counting;
    parallel_for(options.clips, threads, [&](std::size_t i, unsigned thread) {
        const auto clip = clip_at(i, actions);
        const auto file = options.folder / (clip.name() + ".skeleton");
        const bool there = fs::exists(file);
        auto& text = texts[thread];
        const std::size_t frames = there ? 0 : make_text(clip, options.seed, text);
        if (!there) write_file(file, text);

        const std::lock_guard lock(counting);
        summary.written += there ? 0 : 1;
        summary.frames += frames;
        summary.bytes += there ? 0 : text.size();
        ++summary.clips;
        if (progress) progress(summary.clips);
    });
    return summary;
}

std::string skeleton_text(const ClipId& clip, std::uint64_t seed) {
    std::string text;
    make_text(clip, seed, text);
    return text;
}

}  // namespace actformer::ingest::synth
