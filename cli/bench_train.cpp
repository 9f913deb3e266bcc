// actformer bench train: seconds a step of the discriminator and of the generator, and where they go; seconds for motions. All
// beside eager PyTorch with the same networks, in the same run and on as many threads.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "cli/bench.hpp"
#include "cli/say.hpp"
#include "model/generators/actformer/speed.hpp"
#include "model/generators/method_speed.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct BenchTrainOptions {
    model::SpeedRequest request{2, 26, 60, 64, 2};
    std::string peers, python = "/usr/bin/python3", method, program;
    std::vector<std::string> overrides;
    int rounds = 3;
    bool json = false;
};

/// Seconds: a discriminator's step, a generator's, 100 motions.
using Times = std::array<double, 3>;
constexpr std::array<const char*, 3> names{"discriminator step", "generator step", "9,400 motions"};
constexpr std::array<double, 3> shown_times{1, 1, 94};

/// The peer's command line: Python, its program, the networks' sizes, and what more it takes.
std::vector<std::string> peer_command(const BenchTrainOptions& options,
                                      const std::vector<std::string>& program,
                                      const std::vector<std::string>& more) {
    const auto& r = options.request;
    std::vector<std::string> command{options.python};
    command.insert(command.end(), program.begin(), program.end());
    const std::pair<const char*, std::uint64_t> sizes[] = {
        {"--persons", r.persons}, {"--classes", r.classes}, {"--frames", r.frames}, {"--batch", r.batch}};
    for (const auto& [name, size] : sizes) command.insert(command.end(), {name, std::to_string(size)});
    command.insert(command.end(), more.begin(), more.end());
    return command;
}

std::map<std::string, std::string> on_threads(std::uint64_t threads) {
    return {{"OMP_NUM_THREADS", std::to_string(threads)}};
}

/// The peer's three times, its own best of three; none where it cannot run.
std::optional<Times> ask_peer(const BenchTrainOptions& options) {
    const auto program = fs::path(options.peers) / "actformer_speed.py";
    if (!fs::exists(program))
        throw Error("{}: holds no actformer_speed.py; --peers names the folder of the reference programs",
                    options.peers);
    const auto said = output_of(peer_command(options, {program.string()}, {"--repeats", "3"}),
                                on_threads(options.request.threads))
                          .value_or("");
    const auto last = said.substr(said.substr(0, said.find_last_not_of('\n') + 1).rfind('\n') + 1);
    Times times{};
    if (std::sscanf(last.c_str(), "%lf %lf %lf", &times[0], &times[1], &times[2]) != 3) return {};
    return times;
}

struct Result {
    std::array<const model::StepTime*, 3> ours{};
    std::optional<Times> peer;
    std::string machine;
};

void print_layers(const model::StepTime& step, const char* name) {
    say("\nmilliseconds a {}: {:.1f}\n  {:<32} {:>9} {:>9}\n", name, 1e3 * step.seconds, "layer", "forward",
        "backward");
    double left = 1e3 * step.seconds;
    for (const auto& layer : step.layers) {
        say("  {:<32} {:>9.2f} {:>9.2f}\n", layer.layer, layer.forward, layer.backward);
        left -= layer.forward + layer.backward;
    }
    say("  {:<32} {:>9.2f}\n", "the rest", left);
}

void print_text(const Result& result, const BenchTrainOptions& options) {
    const auto& r = options.request;
    say("{}\n{} persons, {} classes, {} frames, batches of {}\n", result.machine, r.persons, r.classes,
        r.frames, r.batch);
    say("{:<20} {:>10} {:>15} {:>7}\n", "seconds", "actformer", "PyTorch, eager", "ratio");
    for (std::size_t i = 0; i < names.size(); ++i) {
        const double ours = shown_times[i] * result.ours[i]->seconds;
        if (result.peer)
            say("{:<20} {:>10.3f} {:>15.3f} {:>7.2f}\n", names[i], ours, shown_times[i] * (*result.peer)[i],
                shown_times[i] * (*result.peer)[i] / ours);
        else
            say("{:<20} {:>10.3f} {:>15}\n", names[i], ours, "not measured");
    }
    if (!result.peer)
        say("name the folder of the reference programs with --peers; they need python3-torch\n");
    print_layers(*result.ours[0], "discriminator step");
    print_layers(*result.ours[1], "generator step");
    print_layers(*result.ours[2], "hundred motions");
}

void print_json(const Result& result, const BenchTrainOptions& options) {
    const auto& r = options.request;
    Json out{{"machine", result.machine}, {"persons", r.persons}, {"classes", r.classes},
             {"frames", r.frames},        {"batch", r.batch},     {"threads", r.threads}};
    for (std::size_t i = 0; i < names.size(); ++i) {
        auto& line = out[names[i]];
        line["seconds"] = shown_times[i] * result.ours[i]->seconds;
        if (result.peer) {
            line["pytorch"] = shown_times[i] * (*result.peer)[i];
            line["ratio"] = (*result.peer)[i] / result.ours[i]->seconds;
        }
        for (const auto& layer : result.ours[i]->layers)
            line["milliseconds"][layer.layer] = {{"forward", layer.forward}, {"backward", layer.backward}};
    }
    fmt::print("{}\n", out.dump(2));
}

/// The program and its peer take turns, so that a busy machine disturbs them alike; each keeps its best.
void run(const BenchTrainOptions& options) {
    model::SpeedTest test(options.request);
    Result result;
    for (int turn = 0; turn < (options.peers.empty() ? 1 : 2); ++turn) {
        test.run(options.rounds);
        if (options.peers.empty()) break;
        const auto now = ask_peer(options);
        if (!now) break;
        if (!result.peer) result.peer = now;
        for (std::size_t i = 0; i < now->size(); ++i)
            (*result.peer)[i] = std::min((*result.peer)[i], (*now)[i]);
    }
    result.ours = {&test.discriminator_step(), &test.generator_step(), &test.generation()};
    result.machine = test.machine();
    options.json ? print_json(result, options) : print_text(result, options);
}

/// Seconds of a step by the clock and of processors, and both of 100 motions.
using MethodTimes = std::array<double, 4>;

std::optional<MethodTimes> ask_method_peer(const BenchTrainOptions& options) {
    if (options.program.empty()) return {};
    const auto command =
        peer_command(options, {options.program, options.peers}, {"--rounds", std::to_string(options.rounds)});
    const auto said = output_of(command, on_threads(options.request.threads));
    MethodTimes times{};
    if (!said ||
        std::sscanf(said->c_str(), "%lf %lf %lf %lf", &times[0], &times[1], &times[2], &times[3]) != 4)
        throw Error("{} failed", command_line(command));
    return times;
}

void print_method(const BenchTrainOptions& options, const MethodTimes& ours,
                  const std::optional<MethodTimes>& peer, const model::MethodSpeed& test) {
    constexpr std::array<const char*, 4> rows{"step", "step, processors", "100 motions",
                                              "100 motions, processors"};
    if (options.json) {
        Json out{{"machine", test.machine()},
                 {"device", test.device()},
                 {"method", options.method},
                 {"threads", options.request.threads}};
        for (std::size_t i = 0; i < rows.size(); ++i) {
            out[rows[i]] = {{"seconds", ours[i]}};
            if (peer) out[rows[i]].update({{"pytorch", (*peer)[i]}, {"ratio", (*peer)[i] / ours[i]}});
        }
        return fmt::print("{}\n", out.dump(2));
    }
    say("{}, on {}\n{:<24} {:>10} {:>15} {:>7}\n", test.machine(), test.device(),
        "seconds, " + options.method, "actformer", "PyTorch, eager", "ratio");
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (peer)
            say("{:<24} {:>10.3f} {:>15.3f} {:>7.2f}\n", rows[i], ours[i], (*peer)[i], (*peer)[i] / ours[i]);
        else
            say("{:<24} {:>10.3f} {:>15}\n", rows[i], ours[i], "not measured");
}

/// Any method, through what all of them have: a step of training, and motions.
void run_method(const BenchTrainOptions& options) {
    const auto& r = options.request;
    model::MethodSpeed test(
        {options.method, options.overrides, r.persons, r.classes, r.frames, r.batch, r.threads});
    std::optional<MethodTimes> peer;
    for (int turn = 0; turn < (options.program.empty() ? 1 : 2); ++turn) {
        test.run(options.rounds);
        const auto now = ask_method_peer(options);
        if (!peer) peer = now;
        for (std::size_t i = 0; now && i < now->size(); ++i) (*peer)[i] = std::min((*peer)[i], (*now)[i]);
    }
    const auto &step = test.step(), &generation = test.generation();
    print_method(options, {step.wall, step.processors, generation.wall, generation.processors}, peer, test);
}

}  // namespace

void add_bench_train(CLI::App& bench) {
    auto options = std::make_shared<BenchTrainOptions>();
    auto* command = bench.add_subcommand("train", "Training and generation, beside eager PyTorch");
    const auto number = [&](const char* name, std::uint32_t& to, const char* what, std::uint32_t least,
                            std::uint32_t most) {
        command->add_option(name, to, what)->check(CLI::Range(least, most))->capture_default_str();
    };
    number("--persons", options->request.persons, "Persons of a motion", 1, 16);
    number("--classes", options->request.classes, "Classes", 1, 100'000);
    number("--frames", options->request.frames, "Frames of a motion", 16, 4096);
    number("--batch", options->request.batch, "Motions of a step", 1, 65536);
    command->add_option("--threads", options->request.threads, "Processor threads, the peer's too")
        ->check(CLI::Range(1U, most_threads))
        ->capture_default_str();
    command->add_option("--rounds", options->rounds, "Runs a turn of which the best counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--peers", options->peers, "Folder of the reference program actformer_speed.py");
    command->add_option("--python", options->python, "Python that has torch")->capture_default_str();
    command->add_option("--method", options->method,
                        "A method's whole step and generation; without, ActFormer's networks layer by layer");
    command
        ->add_option("--peer", options->program,
                     "Program that times the method in eager PyTorch, given --peers")
        ->needs("--method")
        ->check(CLI::ExistingFile);
    command->add_option("overrides", options->overrides, "The method's settings, as in batch=32")
        ->type_name("KEY=VALUE")
        ->needs("--method");
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer bench train\n"
             "  actformer bench train --peers ../shared/reference --threads 2\n"
             "  actformer bench train --method actor --persons 1 --classes 94 --batch 20 dropout=0 --peers "
             "../shared/reference --peer tests/bench/actor_speed.py\n");
    command->callback([options] { options->method.empty() ? run(*options) : run_method(*options); });
}

}  // namespace actformer::cli
