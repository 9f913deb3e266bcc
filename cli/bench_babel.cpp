#include "cli/bench_babel.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/scratch.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "base/process/usage.hpp"
#include "base/text/counted.hpp"
#include "base/threads/parallel.hpp"
#include "cli/format.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/export/npz/npz_writer.hpp"
#include "ingest/formats/babel/babel_format.hpp"
#include "ingest/pipeline/pipeline.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;

constexpr double seconds_a_file = 12;  // as BABEL's sequences have on average
constexpr std::uint64_t numbers = 156;
constexpr std::string_view categories = "walk\nrun\njump\nkick\n";

double rate_of(std::uint64_t file) {
    return file % 3 == 2 ? 100 : 120;  // about as in AMASS
}

std::string name_of(std::uint64_t file) {
    return fmt::format("{:03}/{:03}_{:05}_poses.npz", file / 100, file / 100, file);
}

/// Every joint swings at its own pace, and the body walks in a circle.
void make_recording(const fs::path& path, std::uint64_t file) {
    const double rate = rate_of(file);
    const auto frames = static_cast<std::uint64_t>(seconds_a_file * rate);
    std::vector<double> poses(frames * numbers), trans(frames * 3);
    for (std::uint64_t t = 0; t < frames; ++t) {
        const double now = static_cast<double>(t) / rate;
        for (std::uint64_t i = 0; i < numbers; ++i)
            poses[t * numbers + i] =
                0.6 * std::sin(now * (1 + 0.03 * static_cast<double>(i)) + static_cast<double>(i + file));
        trans[3 * t] = 2 * std::cos(now / 3);
        trans[3 * t + 1] = 2 * std::sin(now / 3);
        trans[3 * t + 2] = 0.9;
    }
    ingest::NpzWriter npz(path);
    npz.add("trans", {frames, 3}, trans);
    npz.add("gender", "neutral");
    npz.add("mocap_framerate", {}, std::vector<double>{rate});
    npz.add("betas", {16}, std::vector<double>(16));
    npz.add("dmpls", {frames, 8}, std::vector<double>(frames * 8));
    npz.add("poses", {frames, numbers}, poses);
    npz.finish();
}

/// Four labels a sequence, which overlap; one of them has two categories.
nlohmann::json annotation_of(std::uint64_t file) {
    auto labels = nlohmann::json::array();
    const std::vector<std::vector<std::string>> shown{{"walk"}, {"run", "jump"}, {"kick"}, {"transition"}};
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const double start = 2.9 * static_cast<double>(i);
        labels.push_back({{"raw_label", shown[i][0]},
                          {"proc_label", shown[i][0]},
                          {"seg_id", fmt::format("{}-{}", file, i)},
                          {"act_cat", shown[i]},
                          {"start_t", start},
                          {"end_t", start + 3.4}});
    }
    return {{"babel_sid", file},
            {"feat_p", "Bench/Bench/" + name_of(file)},
            {"dur", seconds_a_file},
            {"seq_ann", nullptr},
            {"frame_ann", {{"labels", labels}}}};
}

void make_annotations(const fs::path& path, std::uint64_t files) {
    auto all = nlohmann::json::object();
    for (std::uint64_t file = 0; file < files; ++file) all[std::to_string(file)] = annotation_of(file);
    write_whole(path, all.dump());
}

std::uint64_t files_of(double hours) {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::round(hours * 3600 / seconds_a_file)));
}

void make_recording_folders(const fs::path& folder, std::uint64_t files) {
    for (std::uint64_t file = 0; file < files; file += 100)
        fs::create_directories((folder / "Bench" / name_of(file)).parent_path());
}

void make_raw(const fs::path& folder, std::uint64_t files) {
    make_recording_folders(folder, files);
    parallel_for(files, thread_count(0),
                 [&](std::size_t file, unsigned) { make_recording(folder / "Bench" / name_of(file), file); });
    make_annotations(folder / "train.json", files);
}

/// Links the `made` recordings over and over under new names.
void link_raw(const fs::path& from, const fs::path& folder, std::uint64_t made, std::uint64_t files) {
    make_recording_folders(folder, files);
    for (std::uint64_t file = 0; file < files; ++file)
        fs::create_hard_link(from / "Bench" / name_of(file % made), folder / "Bench" / name_of(file));
    make_annotations(folder / "train.json", files);
}

ingest::IngestSummary run_ours(const BabelBench& bench, const fs::path& raw, const fs::path& out,
                               kernels::Device& device) {
    fs::remove_all(out);
    ingest::BabelOptions options;
    options.dataset = "bench";
    options.categories = "walk,run,jump,kick";
    ingest::BabelFormat format(std::move(options));
    ingest::IngestRequest request;
    request.raw = {raw};
    request.out = out;
    request.one_dataset = true;
    request.threads = bench.threads;
    return ingest::ingest(request, format, device);
}

/// How long a run took, and how long processors were busy with it, all threads together.
struct Took {
    double seconds = 0, busy = 0;
};

/// Of the peer, by its own clock, which leaves out Python's start.
std::optional<Took> run_peer(const BabelBench& bench, const fs::path& folder, std::uint64_t clips) {
    if (!fs::exists(bench.peer)) return {};
    write_whole(folder / "categories", categories);
    const std::vector<std::string> command{bench.python,
                                           bench.peer,
                                           (folder / "raw").string(),
                                           (folder / "raw/train.json").string(),
                                           (folder / "peer.h5").string(),
                                           (folder / "categories").string(),
                                           std::to_string(thread_count(bench.threads))};
    const auto said = output_of(command);
    double count = 0;
    Took took;
    if (!said || std::sscanf(said->c_str(), "%lf %lf %lf", &count, &took.seconds, &took.busy) != 3)
        throw Error("{} failed", command_line(command));
    if (count != static_cast<double>(clips))
        throw Error("{} made {} clips, not {}", bench.peer, count, clips);
    return took;
}

double motion_hours(std::uint64_t files) {
    return static_cast<double>(files) * seconds_a_file / 3600;
}

}  // namespace

void bench_babel(const BabelBench& bench) {
    kernels::Device device(bench.device);
    const Scratch scratch("bench", bench.folder);
    const auto made = files_of(bench.hours);
    make_raw(scratch.path() / "raw", made);
    ingest::IngestSummary best;
    Took ours;
    for (int i = 0; i <= bench.repeats; ++i) {  // the first run warms the page cache
        const double before = processor_seconds();
        const auto summary = run_ours(bench, scratch.path() / "raw", scratch.path() / "out", device);
        if (i == 0 || (best.files > 0 && summary.seconds.wall >= ours.seconds)) continue;
        best = summary;
        ours = {summary.seconds.wall, processor_seconds() - before};
    }
    const auto& made_clips = best.datasets.at(0);
    const auto peer = run_peer(bench, scratch.path(), made_clips.clips);
    const double gigabytes = static_cast<double>(best.text_bytes) / ours.seconds / 1e9;
    nlohmann::ordered_json json{{"hours", motion_hours(made)},    {"bytes", best.text_bytes},
                                {"clips", made_clips.clips},      {"frames", made_clips.frames},
                                {"wall_seconds", ours.seconds},   {"cpu_seconds", ours.busy},
                                {"gigabytes_a_second", gigabytes}};
    if (peer) {
        json["peer"] = {{"wall_seconds", peer->seconds}, {"cpu_seconds", peer->busy}};
        json["ratio"] = peer->seconds / ours.seconds;
        json["cpu_ratio"] = peer->busy / ours.busy;
    }
    if (!bench.json) {
        say("{:.2f} hours of motion ({}) -> {}, {}\n", motion_hours(made), bytes(best.text_bytes),
            counted(made_clips.clips, "clip"), counted(made_clips.frames, "frame"));
        say("actformer        {:>8.3f} s, {:>7.3f} s of processors, {:.2f} GB/s\n", ours.seconds, ours.busy,
            gigabytes);
        if (peer)
            say("NumPy and SciPy  {:>8.3f} s, {:>7.3f} s of processors, on as many threads\n"
                "ratio            {:>8.1f}    {:>7.1f}\n",
                peer->seconds, peer->busy, peer->seconds / ours.seconds, peer->busy / ours.busy);
        else
            say("peer not at hand; name it with --peer\n");
    }
    if (bench.many_hours > 0) {
        const auto many = files_of(bench.many_hours);
        link_raw(scratch.path() / "raw", scratch.path() / "many", made, many);
        const auto summary = run_ours(bench, scratch.path() / "many", scratch.path() / "out", device);
        json["many"] = {{"hours", motion_hours(many)},
                        {"wall_seconds", summary.seconds.wall},
                        {"peak_memory_mib", peak_memory_mib()}};
        if (!bench.json)
            say("{:.1f} hours of linked motion ({}) in {:.1f} s, {:.0f} MiB of memory at most\n",
                motion_hours(many), bytes(summary.text_bytes), summary.seconds.wall, peak_memory_mib());
    }
    if (bench.json) say_json(json);
}

}  // namespace actformer::cli
