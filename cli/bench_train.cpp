// actformer bench train: seconds of a method's training step, or of its phases, and of motions, and the layers where they go. All
// beside eager PyTorch with the same networks, in the same run and on as many threads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "base/text/counted.hpp"
#include "base/text/printable.hpp"
#include "cli/bench.hpp"
#include "cli/common_options.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "model/generators/method_speed.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct BenchTrainOptions {
    model::MethodSpeedRequest request{.threads = 2};
    std::string peers, python = "/usr/bin/python3", method, program;
    int rounds = 3;
    bool json = false;

    bool by_phase() const { return method.empty(); }
};

/// Python, the program that does the same, the sizes it shall take, and how often; empty where none was named.
std::vector<std::string> peer_command(const BenchTrainOptions& options,
                                      const model::MethodSpeedRequest& sizes) {
    if (options.by_phase() ? options.peers.empty() : options.program.empty()) return {};
    std::vector<std::string> command{options.python};
    if (options.by_phase()) {
        const auto program = fs::path(options.peers) / "actformer_speed.py";
        if (!fs::exists(program))
            throw Error("{}: holds no actformer_speed.py; --peers names the folder of the reference programs",
                        options.peers);
        command.push_back(program.string());
    } else {
        command.insert(command.end(), {options.program, options.peers});
    }
    const std::pair<const char*, std::uint64_t> numbers[] = {
        {"--persons", sizes.persons},
        {"--classes", sizes.classes},
        {"--frames", sizes.frames},
        {"--batch", sizes.batch},
        {options.by_phase() ? "--repeats" : "--rounds", options.rounds}};
    for (const auto& [name, number] : numbers) command.insert(command.end(), {name, std::to_string(number)});
    return command;
}

/// The peer's seconds, its own best: the last line that it prints, `count` numbers above 0. Throws Error for any other line.
std::vector<double> ask_peer(const std::vector<std::string>& command, int threads, std::size_t count) {
    const auto said = output_of(command, {{"OMP_NUM_THREADS", std::to_string(threads)}});
    if (!said) throw Error("{} failed", command_line(command));
    const auto end = said->find_last_not_of('\n') + 1;
    const auto last = said->substr(0, end).substr(said->substr(0, end).rfind('\n') + 1);
    std::istringstream line(last);
    std::vector<double> seconds;
    for (double number = 0; line >> number && number > 0 && std::isfinite(number);) seconds.push_back(number);
    if (seconds.size() != count || !line.eof())
        throw Error("{}: its last line is {}, where {} numbers of seconds are wanted", command_line(command),
                    in_quotes(last), count);
    return seconds;
}

/// A line of the table: seconds of both.
struct Row {
    std::string name;
    double ours = 0;
    std::optional<double> peer;
    std::vector<model::LayerTime> layers = {};
};

/// What a peer prints a number for, in its order: of phases the time by the clock, of a whole step and its motions that of processors
/// too.
std::vector<Row> rows_of(const BenchTrainOptions& options, const std::vector<model::WorkTime>& times,
                         const std::vector<double>& peer) {
    std::vector<Row> rows;
    const auto add = [&](const std::string& name, double seconds, double times_shown) {
        rows.push_back({name, times_shown * seconds, {}});
        if (!peer.empty()) rows.back().peer = times_shown * peer.at(rows.size() - 1);
    };
    for (const auto& work : times) {
        const bool many = options.by_phase() && &work == &times.back();
        const double times_shown = many ? 94 : 1;
        add(many ? "9,400 motions" : work.name, work.wall, times_shown);
        rows.back().layers = work.layers;
        for (auto& layer : rows.back().layers) {
            layer.forward *= times_shown;
            layer.backward *= times_shown;
        }
        if (!options.by_phase()) add(work.name + ", processors", work.processors, 1);
    }
    return rows;
}

void print_layers(const model::WorkTime& work) {
    if (work.layers.empty()) return;
    double left = 1e3 * work.wall;
    say("\nmilliseconds, {}: {:.1f}\n  {:<32} {:>9} {:>9}\n", work.name, left, "layer", "forward",
        "backward");
    for (const auto& layer : work.layers) {
        say("  {:<32} {:>9.2f} {:>9.2f}\n", layer.layer, layer.forward, layer.backward);
        left -= layer.forward + layer.backward;
    }
    say("  {:<32} {:>9.2f}\n", "the rest", left);
}

void print_text(const model::MethodSpeed& test, const std::vector<Row>& rows) {
    const auto& r = test.request();
    say("{}\n{} on {}: {}, {}, {}, batches of {}\n", test.machine(), r.method, test.device(),
        counted(r.persons, "person"), counted(r.classes, "class"), counted(r.frames, "frame"), r.batch);
    say("{:<24} {:>10} {:>15} {:>7}\n", "seconds", "actformer", "PyTorch, eager", "ratio");
    for (const auto& row : rows)
        if (row.peer)
            say("{:<24} {:>10.3f} {:>15.3f} {:>7.2f}\n", row.name, row.ours, *row.peer, *row.peer / row.ours);
        else
            say("{:<24} {:>10.3f} {:>15}\n", row.name, row.ours, "not measured");
    if (!rows.front().peer)
        say("name the folder of the reference programs with --peers, and with --method its --peer; they need "
            "python3-torch\n");
    for (const auto& work : test.times()) print_layers(work);
}

void print_json(const model::MethodSpeed& test, const std::vector<Row>& rows) {
    const auto& r = test.request();
    Json out{{"machine", test.machine()}, {"device", test.device()}, {"method", r.method},
             {"persons", r.persons},      {"classes", r.classes},    {"frames", r.frames},
             {"batch", r.batch},          {"threads", r.threads}};
    for (const auto& row : rows) {
        auto& line = out[row.name];
        line["seconds"] = row.ours;
        if (row.peer) line.update({{"pytorch", *row.peer}, {"ratio", *row.peer / row.ours}});
        for (const auto& layer : row.layers)
            line["milliseconds"][layer.layer] = {{"forward", layer.forward}, {"backward", layer.backward}};
    }
    say_json(out);
}

/// Keys that would have no effect here.
void refuse_override(const std::string& assignment) {
    const auto key = assignment.substr(0, assignment.find('='));
    if (key == "threads") throw Error("{}: --threads says how many, the peer's too", assignment);
    if (key == "data") throw Error("{}: invented motions are timed; leave it out", assignment);
}

/// The program and its peer take turns, so that a busy machine disturbs them alike; each keeps its best.
void run(const BenchTrainOptions& options) {
    auto request = options.request;
    for (const auto& assignment : request.overrides) refuse_override(assignment);
    request.by_phase = options.by_phase();
    if (!options.method.empty()) request.method = options.method;
    model::MethodSpeed test(request);
    const auto command = peer_command(options, test.request());
    const auto count = rows_of(options, test.times(), {}).size();
    std::vector<double> peer;
    for (int turn = 0; turn < (command.empty() ? 1 : 2); ++turn) {
        if (!command.empty()) {  // first, as it may have nothing to say
            const auto now = ask_peer(command, request.threads, count);
            if (peer.empty()) peer = now;
            for (std::size_t i = 0; i < count; ++i) peer[i] = std::min(peer[i], now[i]);
        }
        test.run(options.rounds);
    }
    const auto rows = rows_of(options, test.times(), peer);
    options.json ? print_json(test, rows) : print_text(test, rows);
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
    command
        ->add_option("--rounds", options->rounds,
                     "Runs in each turn, of which the best counts; for the peer too")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--peers", options->peers, "Folder of the reference program actformer_speed.py");
    command->add_option("--python", options->python, "Python that has torch")->capture_default_str();
    command->add_option("--method", options->method,
                        "A method's whole step and generation; without, ActFormer's step phase by phase");
    command
        ->add_option("--peer", options->program,
                     "Program that times the method in eager PyTorch, given --peers")
        ->needs("--method")
        ->needs("--peers")
        ->check(CLI::ExistingFile);
    add_overrides(command, options->request.overrides, "The method's settings, as in batch=32")
        ->needs("--method");
    command->add_flag("--json", options->json, "Print JSON");
    examples(
        command,
        "  actformer bench train\n"
        "  actformer bench train --peers FOLDER --threads 2\n"
        "  actformer bench train --method actor --persons 1 --classes 94 --batch 20 dropout=0 --peers FOLDER "
        "--peer tests/bench/actor_speed.py\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
