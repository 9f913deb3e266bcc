// actformer bench features: sequences a second through the recogniser, the share of what the device can do, and where the
// time goes; beside PyTorch and ONNX Runtime on the same network in the same run.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.hpp"
#include "base/files/scratch.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "base/text/printable.hpp"
#include "cli/bench.hpp"
#include "cli/common_options.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "eval/stgcn/operations.hpp"
#include "eval/stgcn/recogniser.hpp"
#include "eval/stgcn/tuning.hpp"
#include "kernels/buffer.hpp"
#include "kernels/peak.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct BenchFeaturesOptions {
    std::string recogniser, peers, node_modules, python = "/usr/bin/python3", device;
    std::uint32_t frames = 64, batch = 64;
    int rounds = 5;
    bool tune = false, json = false;
};

constexpr std::array<const char*, 8> step_names{"enter",    "gather",  "graph",    "transform",
                                                "temporal", "inverse", "residual", "pool"};

/// Milliseconds a batch, by layer and step. Waiting for every step costs a little on its own.
using Breakdown = std::array<std::array<double, step_names.size()>, eval::stgcn_layers>;

Breakdown time_steps(kernels::Device& device, const eval::StgcnWeights& weights, const kernels::Tiles& tiles,
                     const BenchFeaturesOptions& options) {
    using Clock = std::chrono::steady_clock;
    Breakdown best{};
    eval::StgcnRecogniser recogniser(device, weights, tiles);
    const std::vector<float> motions(
        std::size_t{options.batch} * weights.channels * options.frames * weights.joints(), 0.5F);
    const kernels::Buffer<float> on_device(device, motions);
    recogniser.recognise(on_device.memory(), options.batch, options.frames);
    for (int round = 0; round < options.rounds; ++round) {
        Breakdown now{};
        auto last = Clock::now();
        recogniser.watch([&](std::size_t layer, eval::Step step) {
            device.queue().finish();
            const auto time = Clock::now();
            now[layer][static_cast<std::size_t>(step)] +=
                std::chrono::duration<double, std::milli>(time - last).count();
            last = time;
        });
        recogniser.recognise(on_device.memory(), options.batch, options.frames);
        for (std::size_t l = 0; l < best.size(); ++l)
            for (std::size_t s = 0; s < best[l].size(); ++s)
                best[l][s] = round == 0 ? now[l][s] : std::min(best[l][s], now[l][s]);
    }
    return best;
}

/// Of every peer: stgcn_ort.js takes no other number.
constexpr int peer_threads = 2;

/// The sequences a second that a command prints. Throws Error where it fails or prints none.
double ask(const std::vector<std::string>& command, const std::map<std::string, std::string>& more) {
    const auto said = output_of(command, more);
    if (!said) throw Error("{} failed", command_line(command));
    double value = 0;
    if (std::sscanf(said->c_str(), "%lf", &value) != 1 || !(value > 0))
        throw Error("{}: prints {}, where sequences a second are wanted", command_line(command),
                    in_quotes(*said));
    return value;
}

struct Peers {
    std::optional<double> torch, onnx;
};

/// The peers, and a folder with the weights and the exported network for them.
class PeerRunner {
  public:
    PeerRunner(const BenchFeaturesOptions& options, const eval::StgcnWeights& weights)
        : options_(options), weights_(weights) {
        if (options.peers.empty()) return;
        if (!fs::exists(fs::path(options.peers) / "stgcn.py"))
            throw Error("{}: holds no stgcn.py; --peers names the folder of the reference programs",
                        options.peers);
        folder_.emplace("bench");
        eval::write_stgcn_weights(folder_->path() / "weights.h5", weights);
    }

    /// Sequences a second of each peer at hand, each the best of five by its own clock.
    void run(Peers& best) {
        if (!folder_) return;
        const auto onnx = folder_->path() / "network.onnx";
        const bool runs_onnx = !options_.node_modules.empty();
        std::vector<std::string> torch{options_.python, options_.peers + "/stgcn.py",
                                       "speed",         (folder_->path() / "weights.h5").string(),
                                       "--frames",      std::to_string(options_.frames),
                                       "--batch",       std::to_string(options_.batch)};
        if (runs_onnx && !fs::exists(onnx)) torch.insert(torch.end(), {"--onnx", onnx.string()});
        keep(best.torch, ask(torch, {{"OMP_NUM_THREADS", std::to_string(peer_threads)}}));
        if (!runs_onnx) return;
        keep(best.onnx, ask({"node", options_.peers + "/stgcn_ort.js", onnx.string(),
                             std::to_string(weights_.channels), std::to_string(options_.frames),
                             std::to_string(weights_.joints()), std::to_string(options_.batch)},
                            {{"NODE_PATH", options_.node_modules}}));
    }

  private:
    static void keep(std::optional<double>& best, double now) { best = std::max(best.value_or(now), now); }

    const BenchFeaturesOptions& options_;
    const eval::StgcnWeights& weights_;
    std::optional<Scratch> folder_;
};

struct FeatureTimes {
    double rate = 0, peak = 0, direct = 0, multiplied = 0;  ///< a second; operations in GFLOP a sequence
    Peers peers;
    Breakdown steps{};
};

void print_breakdown(const Breakdown& steps) {
    say("milliseconds a batch by layer and step, each step waited for:\n  layer");
    for (const auto* name : step_names) say("{:>10}", name);
    say("{:>10}\n", "all");
    std::array<double, step_names.size() + 1> sums{};
    for (std::size_t l = 0; l < steps.size(); ++l) {
        double all = 0;
        say("  {:>5}", l);
        for (std::size_t s = 0; s < step_names.size(); ++s) {
            say("{:>10.2f}", steps[l][s]);
            all += steps[l][s];
            sums[s] += steps[l][s];
        }
        say("{:>10.2f}\n", all);
        sums.back() += all;
    }
    say("    all");
    for (const auto sum : sums) say("{:>10.2f}", sum);
    say("\n");
}

void print_text(const FeatureTimes& r, const BenchFeaturesOptions& options, const kernels::Device& device,
                const kernels::Tiles& tiles) {
    say("{}: {}\n", device.info().name, describe(tiles));
    say("actformer          {:>8.1f} sequences/s of {} frames, batches of {}\n", r.rate, options.frames,
        options.batch);
    const auto peer = [&](const char* name, std::optional<double> rate, const char* how) {
        if (rate)
            say("{:<18} {:>8.1f} sequences/s by {} threads, ratio {:.2f}\n", name, *rate, peer_threads,
                r.rate / *rate);
        else
            say("{:<18} not measured: {}\n", name, how);
    };
    peer("PyTorch, eager", r.peers.torch,
         "name the reference programs with --peers; they need python3-torch");
    peer("ONNX Runtime", r.peers.onnx, "name the folder of onnxruntime-node with --node-modules");
    say("peak multiply-add  {:>8.1f} GFLOP/s\n", r.peak);
    say("multiplied         {:>8.1f} GFLOP/s, {:.0f} % of the peak ({:.2f} GFLOP a sequence)\n",
        r.rate * r.multiplied, 100 * r.rate * r.multiplied / r.peak, r.multiplied);
    say("by direct sums     {:>8.1f} GFLOP/s, {:.0f} % of the peak ({:.2f} GFLOP a sequence)\n",
        r.rate * r.direct, 100 * r.rate * r.direct / r.peak, r.direct);
    print_breakdown(r.steps);
}

void print_json(const FeatureTimes& r, const BenchFeaturesOptions& options, const kernels::Device& device,
                const kernels::Tiles& tiles) {
    Json steps = Json::array();
    for (const auto& layer : r.steps) {
        Json row;
        for (std::size_t s = 0; s < step_names.size(); ++s) row[step_names[s]] = layer[s];
        steps.push_back(row);
    }
    Json out = {{"device", device.info().name},
                {"tiles", describe(tiles)},
                {"frames", options.frames},
                {"batch", options.batch},
                {"sequences_a_second", r.rate},
                {"peak_gflops", r.peak},
                {"multiplied_gflops", r.rate * r.multiplied},
                {"direct_gflops", r.rate * r.direct},
                {"share_of_peak", r.rate * r.multiplied / r.peak}};
    const auto peer = [&](const char* name, std::optional<double> rate) {
        if (rate)
            out["peers"][name] = {
                {"sequences_a_second", *rate}, {"threads", peer_threads}, {"ratio", r.rate / *rate}};
    };
    peer("pytorch", r.peers.torch);
    peer("onnxruntime", r.peers.onnx);
    out["milliseconds_a_batch"] = steps;
    say_json(out);
}

/// Peers and program take turns, so that a busy machine disturbs them alike; each keeps its best.
FeatureTimes measure(kernels::Device& device, const eval::StgcnWeights& weights, const kernels::Tiles& tiles,
                     const BenchFeaturesOptions& options) {
    FeatureTimes result;
    result.direct = eval::direct_operations(weights, options.frames) * 1e-9;
    result.multiplied = eval::multiplied_operations(weights, options.frames) * 1e-9;
    PeerRunner peers(options, weights);
    for (int turn = 0; turn < (options.peers.empty() ? 1 : 2); ++turn) {
        peers.run(result.peers);  // first, as they may have nothing to say
        result.rate = std::max(result.rate, eval::measure_rate(device, weights, tiles, options.batch,
                                                               options.frames, options.rounds));
        result.peak = std::max(result.peak, kernels::measure_peak(device, tiles.vec, options.rounds) * 1e-9);
    }
    result.steps = time_steps(device, weights, tiles, options);
    return result;
}

void run(const BenchFeaturesOptions& options) {
    kernels::Device device(options.device);
    const auto weights = options.recogniser.empty()
                             ? eval::random_stgcn_weights(3, 94, eval::ntu_graph(), 1, 0)
                             : eval::read_stgcn_weights(options.recogniser);
    if (options.tune) {
        const auto tiles = eval::tune(device, weights, options.batch, options.frames,
                                      [&](const kernels::Tiles& t, double rate) {
                                          remark("{:>8.1f} sequences/s  {}\n", rate, describe(t));
                                      });
        eval::save_tiles(device.info(), tiles);
        remark("kept in {}: {}\n", eval::tiles_file().string(), describe(tiles));
    }
    const auto tiles = eval::load_tiles(device.info());
    const auto result = measure(device, weights, tiles, options);
    options.json ? print_json(result, options, device, tiles) : print_text(result, options, device, tiles);
}

}  // namespace

void add_bench_features(CLI::App& bench) {
    auto options = std::make_shared<BenchFeaturesOptions>();
    auto* command = bench.add_subcommand(
        "features", "The recogniser on an OpenCL device, beside PyTorch and ONNX Runtime");
    command->add_option("--recogniser", options->recogniser,
                        "Weights to run (default: random ones of full width)");
    command->add_option("--frames", options->frames, "Frames of a sequence")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    command->add_option("--batch", options->batch, "Sequences of a batch")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    command->add_option("--rounds", options->rounds, "Runs of which the best counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_flag("--tune", options->tune,
                      "Find the best tile sizes of this device first, and keep them");
    command->add_option(
        "--peers", options->peers,
        "Folder of the reference programs stgcn.py and stgcn_ort.js, which take two threads each "
        "whatever the device has");
    command->add_option("--node-modules", options->node_modules, "Folder that holds onnxruntime-node")
        ->needs("--peers");
    command->add_option("--python", options->python, "Python that has torch and h5py")->capture_default_str();
    add_device_option(command, options->device);
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer bench features\n"
             "  actformer bench features --tune --peers FOLDER --node-modules "
             "/tmp/ort/node_modules\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
