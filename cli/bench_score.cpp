// actformer bench score: FIDs of many classes, beside SciPy's matrix square root in the same run.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "base/error.hpp"
#include "base/files/scratch.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "cli/bench.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "eval/metrics/fid.hpp"
#include "eval/scoring/features_file.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;

struct BenchScoreOptions {
    std::size_t classes = 94, dimensions = 256, real = 500, generated = 100;
    std::string peer = "tests/bench/frechet_sqrtm.py", python = "/usr/bin/python3";
    int repeats = 5;
    bool json = false;
};

/// Features as a recogniser's are: positive, correlated, most of the spread in few directions.
eval::Samples made_samples(const BenchScoreOptions& options, std::size_t per_class, unsigned seed) {
    constexpr std::size_t directions = 40;
    std::mt19937 random(seed), shape(7);
    std::normal_distribution<double> normal;
    const auto d = options.dimensions;
    eval::Samples out;
    out.dimensions = d;
    out.classes = options.classes;
    for (std::size_t c = 0; c < options.classes; ++c) {
        std::vector<double> mixing(directions * d);
        for (auto& v : mixing) v = normal(shape);
        for (std::size_t i = 0; i < per_class; ++i) {
            std::vector<double> x(d, 1);
            for (std::size_t k = 0; k < directions; ++k) {
                const double along = normal(random) / static_cast<double>(k + 1);
                for (std::size_t j = 0; j < d; ++j) x[j] += along * mixing[k * d + j];
            }
            for (const double v : x)
                out.features.push_back(static_cast<float>(std::max(v, 0.0) + 0.01 * normal(random)));
            out.labels.push_back(static_cast<std::uint32_t>(c));
        }
    }
    return out;
}

void write(const fs::path& path, const eval::Samples& samples) {
    eval::FeaturesFile file(path, samples.size(), samples.dimensions, 0);
    const std::vector<float> features(samples.features.begin(), samples.features.end());
    file.add(0, features, {});
    file.labels(samples.labels);
    file.finish();
}

struct Peer {
    double mean_seconds = 0, whole_seconds = 0, whole = 0;
    std::vector<double> distances;
};

std::optional<Peer> run_peer(const BenchScoreOptions& options, const eval::Samples& real,
                             const eval::Samples& made) {
    if (!fs::exists(options.peer)) return {};
    const Scratch scratch("bench");
    const auto real_file = scratch.path() / "real.h5", made_file = scratch.path() / "made.h5";
    write(real_file, real);
    write(made_file, made);
    const std::vector<std::string> command{options.python, options.peer, real_file.string(),
                                           made_file.string()};
    const auto json = nlohmann::json::parse(output_of(command).value_or(""), nullptr, false);
    if (!json.is_object())
        throw Error("{} failed; it takes python3 with scipy and h5py", command_line(command));
    return Peer{json["mean_seconds"], json["whole_seconds"], json["whole"], json["distances"]};
}

struct ScoreTimes {
    double mean_seconds = 0, whole_seconds = 0, fid_mean = 0, fid_whole = 0;
    std::optional<Peer> peer;
    double difference = 0;  ///< the largest, relative
};

/// Seconds of the quickest of several runs.
template <typename Work>
double best_of(int repeats, Work work) {
    using Clock = std::chrono::steady_clock;
    double best = 0;
    for (int i = 0; i < repeats; ++i) {
        const auto start = Clock::now();
        work();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        if (i == 0 || seconds < best) best = seconds;
    }
    return best;
}

ScoreTimes measure(const BenchScoreOptions& options) {
    const auto real = made_samples(options, options.real, 1),
               made = made_samples(options, options.generated, 2);
    ScoreTimes out;
    std::vector<std::optional<double>> each;
    out.mean_seconds = best_of(options.repeats, [&] {
        each = eval::distances_by_class(moments_by_class(real), moments_by_class(made));
    });
    out.whole_seconds = best_of(options.repeats, [&] {
        out.fid_whole = frechet_distance(eval::fit(real.features, real.dimensions, 0),
                                         eval::fit(made.features, made.dimensions, 0));
    });
    for (const auto& distance : each) out.fid_mean += *distance / static_cast<double>(each.size());
    out.peer = run_peer(options, real, made);
    if (!out.peer) return out;
    const auto compare = [&](double ours, double theirs) {
        out.difference = std::max(out.difference, std::abs(ours - theirs) / std::abs(theirs));
    };
    for (std::size_t c = 0; c < each.size(); ++c) compare(*each[c], out.peer->distances.at(c));
    compare(out.fid_whole, out.peer->whole);
    return out;
}

void print_json(const ScoreTimes& r, const BenchScoreOptions& options) {
    nlohmann::ordered_json out{{"classes", options.classes},
                               {"dimensions", options.dimensions},
                               {"real", options.real},
                               {"generated", options.generated},
                               {"fid_mean", {{"value", r.fid_mean}, {"seconds", r.mean_seconds}}},
                               {"fid_whole", {{"value", r.fid_whole}, {"seconds", r.whole_seconds}}}};
    if (r.peer) {
        out["fid_mean"]["peer_seconds"] = r.peer->mean_seconds;
        out["fid_mean"]["ratio"] = r.peer->mean_seconds / r.mean_seconds;
        out["fid_whole"]["peer_seconds"] = r.peer->whole_seconds;
        out["fid_whole"]["ratio"] = r.peer->whole_seconds / r.whole_seconds;
        out["largest_relative_difference"] = r.difference;
    }
    say_json(out);
}

void run(const BenchScoreOptions& options) {
    const auto r = measure(options);
    if (options.json) return print_json(r, options);
    say("{} classes of {} real and {} generated samples in {} dimensions\n", options.classes, options.real,
        options.generated, options.dimensions);
    const auto line = [&](const char* name, double ours, std::optional<double> theirs) {
        say("{}  actformer {:>7.3f} s", name, ours);
        if (theirs) say("   SciPy's sqrtm {:>7.3f} s   ratio {:.1f}", *theirs, *theirs / ours);
        say("\n");
    };
    line("FIDm", r.mean_seconds, r.peer ? std::optional(r.peer->mean_seconds) : std::nullopt);
    line("FIDw", r.whole_seconds, r.peer ? std::optional(r.peer->whole_seconds) : std::nullopt);
    if (r.peer)
        say("the largest difference of a distance is {:.1e} of it\n", r.difference);
    else
        say("SciPy's sqrtm is not measured; name {} with --peer\n",
            fs::path(options.peer).filename().string());
}

}  // namespace

void add_bench_score(CLI::App& bench) {
    auto options = std::make_shared<BenchScoreOptions>();
    auto* command = bench.add_subcommand("score", "FIDs of many classes, beside SciPy's matrix square root");
    const auto count = [&](const char* name, std::size_t& value, const char* text) {
        command->add_option(name, value, text)->check(CLI::Range(2, 1'000'000))->capture_default_str();
    };
    count("--classes", options->classes, "Classes");
    count("--dimensions", options->dimensions, "Features of a sample");
    count("--real", options->real, "Real samples a class");
    count("--generated", options->generated, "Generated samples a class");
    command->add_option("--peer", options->peer, "The peer's program")
        ->check(CLI::ExistingFile)
        ->capture_default_str();
    command->add_option("--python", options->python, "Python that has scipy and h5py")->capture_default_str();
    command->add_option("--repeats", options->repeats, "Runs, of which the best counts")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_flag("--json", options->json, "Print JSON");
    examples(command, "  actformer bench score\n  actformer bench score --real 2000\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
