// actformer bench ingest: clips a second from raw text to shards, beside the reference program on the same clips.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.hpp"
#include "base/files/scratch.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "base/process/usage.hpp"
#include "base/text/counted.hpp"
#include "cli/bench.hpp"
#include "cli/bench_babel.hpp"
#include "cli/common_options.hpp"
#include "cli/format.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/formats/motions/motions_format.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/formats/ntu/ntu_format.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "ingest/synth/ntu/ntu.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;

struct BenchIngestOptions {
    std::string format = "ntu";
    double gigabytes = 1, hours = 0.5, many_hours = 0;
    std::uint64_t clips = 4000, many = 0;
    std::string sample, peer;
    std::string python = "/usr/bin/python3", folder, device;
    int repeats = 3;
    unsigned threads = 0;
    bool json = false;
};

std::vector<int> one_person_actions() {
    std::vector<int> actions;
    for (int a = 1; a <= ingest::ntu::actions; ++a)
        if (!ingest::ntu::two_persons(a)) actions.push_back(a);
    return actions;
}

/// A name that no synthetic clip has: setups beyond 32.
std::string copy_name(std::uint64_t i) {
    return fmt::format("S{:03}C{:03}P{:03}R001A{:03}.skeleton", 100 + i / 49 / 3 / 900, 1 + i / 49 % 3,
                       i / 49 / 3 % 900, 1 + i % 49);
}

/// Half of the clips are copies of the real sample where one is given, the others synthetic; all of one person.
void make_raw(const BenchIngestOptions& options, const fs::path& raw) {
    std::optional<fs::path> real;
    if (!options.sample.empty())
        for (const auto& entry : fs::directory_iterator(options.sample))
            if (entry.path().extension() == ".skeleton") real = entry.path();
    const auto copies = real ? options.clips / 2 : 0;
    ingest::synth::NtuOptions synth;
    synth.folder = raw;
    synth.clips = options.clips - copies;
    synth.actions = one_person_actions();
    ingest::synth::synthesise_ntu(synth);  // which makes no clips among those of others
    for (std::uint64_t i = 0; i < copies; ++i) fs::copy_file(*real, raw / copy_name(i));
    if (!options.json)
        say("{} copies of {}, {} synthetic clips\n", grouped(copies),
            real ? real->filename().string() : "a real clip (none given)", grouped(options.clips - copies));
}

ingest::IngestSummary run_ours(const BenchIngestOptions& options, const fs::path& raw, const fs::path& out,
                               kernels::Device& device) {
    fs::remove_all(out);
    ingest::IngestRequest request;
    request.raw = {raw};
    request.out = out;
    request.threads = options.threads;
    ingest::NtuFormat format;
    return ingest::ingest(request, format, device);
}

/// A run and the processor time it took, of all threads together.
struct Measured {
    ingest::IngestSummary summary;
    double cpu = 0;
};

Measured best_of_ours(const BenchIngestOptions& options, const Scratch& scratch, kernels::Device& device) {
    Measured best;
    for (int i = 0; i <= options.repeats; ++i) {  // the first run warms the kernels and the page cache
        const auto before = processor_seconds();
        const auto summary = run_ours(options, scratch.path() / "raw", scratch.path() / "out", device);
        if (i > 0 && (best.cpu == 0 || summary.seconds.wall < best.summary.seconds.wall))
            best = {summary, processor_seconds() - before};
    }
    return best;
}

/// Clips a second of the reference program, by its own clock, which leaves out Python's start.
std::optional<double> run_peer(const BenchIngestOptions& options, const Scratch& scratch) {
    if (options.peer.empty()) return {};
    const std::vector<std::string> command{options.python, options.peer, (scratch.path() / "raw").string(),
                                           (scratch.path() / "peer.h5").string()};
    const auto said = output_of(command);
    double clips = 0, seconds = 0;
    if (!said || std::sscanf(said->c_str(), "%lf %lf", &clips, &seconds) != 2)
        throw Error("{} failed", command_line(command));
    return clips / seconds;
}

/// Links the clips over and over under new names, so that memory can be watched with more clips than a disk has room for.
ingest::IngestSummary run_many(const BenchIngestOptions& options, const Scratch& scratch,
                               kernels::Device& device) {
    const auto many = scratch.path() / "many";
    fs::create_directories(many);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(scratch.path() / "raw"))
        if (entry.path().extension() == ".skeleton") files.push_back(entry.path());
    for (std::uint64_t i = 0; i < options.many; ++i)
        fs::create_hard_link(files[i % files.size()], many / copy_name(i));
    return run_ours(options, many, scratch.path() / "out", device);
}

double rate(const ingest::IngestSummary& s) {
    return static_cast<double>(s.files) / s.seconds.wall;
}

nlohmann::ordered_json to_json(const ingest::IngestSummary& s) {
    const auto& t = s.seconds;
    return {
        {"clips", s.files},
        {"text_bytes", s.text_bytes},
        {"wall_seconds", t.wall},
        {"clips_a_second", rate(s)},
        {"gigabytes_a_second", static_cast<double>(s.text_bytes) / t.wall / 1e9},
        {"stage_seconds",
         {{"walk", t.walk}, {"read", t.read}, {"parse", t.parse}, {"clean", t.clean}, {"write", t.write}}}};
}

void print_text(const Measured& ours, std::optional<double> peer) {
    const auto& s = ours.summary;
    const auto& t = s.seconds;
    say("actformer ingest   {:>8.0f} clips/s   {:.2f} GB/s of text   ({} clips, {} in {:.2f} s)\n", rate(s),
        static_cast<double>(s.text_bytes) / t.wall / 1e9, grouped(s.files), bytes(s.text_bytes), t.wall);
    if (peer)
        say("reference          {:>8.0f} clips/s\nratio              {:>8.1f}\n", *peer, rate(s) / *peer);
    else
        say("reference          not at hand; name it with --peer\n");
    say("processor time     {:>8.2f} s, {:.2f} cores busy, {:.0f} us a clip\n", ours.cpu, ours.cpu / t.wall,
        1e6 * ours.cpu / static_cast<double>(s.files));
    say("where the time goes, in seconds of a thread, waits included (stages overlap):\n");
    const std::pair<const char*, double> stages[]{{"list the source", t.walk},
                                                  {"read files", t.read},
                                                  {"parse text, checksum", t.parse},
                                                  {"clean on the device", t.clean},
                                                  {"write shards", t.write}};
    for (const auto& [name, seconds] : stages)
        say("  {:<22}{:>7.3f}  {}\n", name, seconds,
            std::string(static_cast<std::size_t>(40 * seconds / (t.wall * 2)), '#'));
}

/// A .npy file of clips of 60 frames and 25 joints, `bytes` of float32 or so.
void make_arrays(const fs::path& path, std::uint64_t size) {
    constexpr std::uint64_t clip = 60 * 25 * 3;
    const auto clips = std::max<std::uint64_t>(1, size / (clip * sizeof(float)));
    Aside file(path);
    auto header =
        fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, 60, 1, 25, 3), }}", clips);
    header.resize(117, ' ');
    file.write(std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + '\n');
    std::vector<float> motion(clip);
    for (std::uint64_t c = 0; c < clips; ++c) {
        for (std::size_t i = 0; i < clip; ++i)
            motion[i] =
                std::sin(0.37F * static_cast<float>(i % 75) + 0.001F * static_cast<float>(i + c % 1000));
        file.write({reinterpret_cast<const char*>(motion.data()), motion.size() * sizeof(float)});
    }
    file.commit();
}

void run_motions(const BenchIngestOptions& options) {
    kernels::Device device(options.device);
    const Scratch scratch("bench", options.folder);
    fs::create_directories(scratch.path() / "raw");
    make_arrays(scratch.path() / "raw/joints.npy", static_cast<std::uint64_t>(options.gigabytes * 1e9));
    ingest::IngestSummary best;
    for (int i = 0; i <= options.repeats; ++i) {  // the first run warms the kernels and the page cache
        fs::remove_all(scratch.path() / "out");
        ingest::MotionsOptions motions;
        motions.dataset = "bench";
        motions.topology = "ntu25";
        ingest::MotionsFormat format(motions);
        ingest::IngestRequest request;
        request.raw = {scratch.path() / "raw"};
        request.out = scratch.path() / "out";
        request.one_dataset = true;
        request.threads = options.threads;
        const auto summary = ingest::ingest(request, format, device);
        if (i > 0 && (best.files == 0 || summary.seconds.wall < best.seconds.wall)) best = summary;
    }
    auto json = to_json(best);
    json["peak_memory_mib"] = peak_memory_mib();
    if (options.json)
        say_json(json);
    else
        say("{} of .npy in {:.2f} s: {:.2f} GB/s, {:.0f} MiB of memory at most\n", bytes(best.text_bytes),
            best.seconds.wall, static_cast<double>(best.text_bytes) / best.seconds.wall / 1e9,
            peak_memory_mib());
}

/// Options of another format, which change nothing in this one.
void refuse_without_effect(const CLI::App& command, const std::string& format) {
    const auto refuse = [&](const char* of, std::initializer_list<const char*> options) {
        refuse_given(command, options, fmt::format("is for {}, not for --format {}", of, format));
    };
    if (format != "motions") refuse("--format motions", {"--gigabytes"});
    if (format != "babel") refuse("--format babel", {"--hours", "--many-hours"});
    if (format != "ntu") refuse("--format ntu", {"--clips", "--many", "--sample"});
    if (format == "motions") refuse("--format ntu and babel", {"--peer", "--python"});
}

void run(const BenchIngestOptions& options) {
    if (options.format == "motions") return run_motions(options);
    if (options.format == "babel")
        return bench_babel({options.hours, options.many_hours,
                            options.peer.empty() ? "tests/bench/babel_numpy.py" : options.peer,
                            options.python, options.folder, options.device, options.repeats, options.threads,
                            options.json});
    kernels::Device device(options.device);
    const Scratch scratch("bench", options.folder);
    make_raw(options, scratch.path() / "raw");
    const auto ours = best_of_ours(options, scratch, device);
    const auto peer = run_peer(options, scratch);
    auto json = to_json(ours.summary);
    json["cpu_seconds"] = ours.cpu;
    if (peer) json["peer_clips_a_second"] = *peer, json["ratio"] = rate(ours.summary) / *peer;
    if (!options.json) print_text(ours, peer);
    if (options.many) {
        const auto many = run_many(options, scratch, device);
        json["many"] = to_json(many);
        json["many"]["peak_memory_mib"] = peak_memory_mib();
        if (!options.json)
            say("{} clips in {}: {:.0f} clips/s, {:.0f} MiB of memory at most\n", grouped(many.files),
                duration(many.seconds.wall), rate(many), peak_memory_mib());
    }
    if (options.json) say_json(json);
}

}  // namespace

void add_bench_ingest(CLI::App& bench) {
    auto options = std::make_shared<BenchIngestOptions>();
    auto* command = bench.add_subcommand("ingest", "From raw data to shards, beside a reference program");
    command
        ->add_option("--format", options->format,
                     "What to ingest: ntu; motions, an array of joints; babel, recordings in AMASS's layout")
        ->check(CLI::IsMember({"ntu", "motions", "babel"}))
        ->capture_default_str();
    command->add_option("--gigabytes", options->gigabytes, "Size of the array")
        ->check(number_in(0.001, 1000))
        ->capture_default_str();
    command->add_option("--hours", options->hours, "Hours of recordings in AMASS's layout")
        ->check(number_in(0.01, 100))
        ->capture_default_str();
    command
        ->add_option("--many-hours", options->many_hours,
                     "Also ingest so many hours of linked recordings, to watch the memory")
        ->check(number_in(0, 100000));
    command->add_option("--clips", options->clips, "Clips, half of them copies of the sample")
        ->capture_default_str();
    command->add_option("--many", options->many, "Also ingest so many linked clips, to watch the memory");
    command->add_option("--sample", options->sample, "Folder with a real .skeleton file")
        ->check(CLI::ExistingDirectory);
    command
        ->add_option("--peer", options->peer,
                     "A reference program that prints its clips and seconds (default for babel: "
                     "tests/bench/babel_numpy.py)")
        ->check(CLI::ExistingFile);
    command->add_option("--python", options->python, "Python for the reference program")
        ->capture_default_str();
    command->add_option("--folder", options->folder,
                        "Where the clips are put meanwhile (default: the system's)");
    command->add_option("--repeats", options->repeats, "Runs, of which the best counts")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    add_device_option(command, options->device);
    command->add_option("--threads", options->threads, "Threads that read and parse (default: all cores)")
        ->check(CLI::Range(0U, most_threads));
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer bench ingest\n"
             "  actformer bench ingest --many 100000 --sample FOLDER --peer preprocess.py\n"
             "  actformer bench ingest --format motions --gigabytes 4\n"
             "  actformer bench ingest --format babel --many-hours 40\n");
    command->callback([options, command] {
        refuse_without_effect(*command, options->format);
        run(*options);
    });
}

}  // namespace actformer::cli
