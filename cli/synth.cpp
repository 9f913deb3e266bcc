// actformer synth: stand-ins for data sets that need a licence, in their own raw formats.
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/format.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "ingest/synth/ntu/ntu.hpp"
#include "ingest/synth/stand_in.hpp"

namespace actformer::cli {
namespace {

using namespace ingest::synth;

int number(std::string_view text, std::string_view all) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
        throw Error("--actions {}: '{}' is no action; write numbers and ranges as in 1,2,50-60", all, text);
    return value;
}

/// "1,2,50-60"
std::vector<int> parse_actions(std::string_view all) {
    std::vector<int> out;
    for (auto rest = all; !rest.empty();) {
        const auto comma = std::min(rest.find(','), rest.size());
        const auto item = rest.substr(0, comma);
        rest.remove_prefix(std::min(comma + 1, rest.size()));
        const auto dash = item.find('-');
        const int from = number(item.substr(0, dash), all);
        const int to = dash == item.npos ? from : number(item.substr(dash + 1), all);
        if (from < 1 || to > 120 || from > to)
            throw Error("--actions {}: '{}' is outside 1 to 120 or runs backwards", all, item);
        for (int a = from; a <= to; ++a) out.push_back(a);
    }
    return out;
}

struct Arguments {
    NtuOptions options;
    bool json = false;
};

template <typename Summary, typename Options>
void print_summary(const Summary& s, const Options& options, bool json, double seconds) {
    if (json) {
        const nlohmann::ordered_json out = {{"folder", options.folder.string()},
                                            {"clips", s.clips},
                                            {"written", s.written},
                                            {"frames", s.frames},
                                            {"bytes", s.bytes},
                                            {"seed", options.seed},
                                            {"seconds", seconds}};
        say_json(out);
        return;
    }
    say("{}: {}", options.folder.string(), counted(s.clips, "clip"));
    if (s.written < s.clips) say(", {} of them there already", grouped(s.clips - s.written));
    say("; wrote {}, {} in {}\n", counted(s.frames, "frame"), bytes(s.bytes), duration(seconds));
}

/// Runs `make`, which is handed a callback for how many clips are done.
template <typename Options, typename Make>
void run(const Options& options, bool json, Make make) {
    ingest::refuse_other_folder(options.folder, ingest::own::raw);
    const auto start = std::chrono::steady_clock::now();
    const auto summary = [&] {
        Progress progress("synth", "clips", json);
        const auto total = static_cast<double>(options.clips);
        return make([&](std::uint64_t done) { progress.update(static_cast<double>(done) / total, done); });
    }();
    sync_all(options.folder);
    print_summary(summary, options, json,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void synth_ntu(Arguments& a) {
    run(a.options, a.json, [&](auto progress) { return synthesise_ntu(a.options, progress); });
}

void add_ntu(CLI::App* synth) {
    auto* command = synth->add_subcommand(
        "ntu", "Raw .skeleton files like those of NTU RGB+D: 120 actions, 1 or 2 persons");
    auto a = std::make_shared<Arguments>();
    command->add_option("-o,--out", a->options.folder, "Folder to write into")->required();
    command->add_option("--clips", a->options.clips, "How many, the actions taking turns")
        ->capture_default_str();
    command->add_option("--seed", a->options.seed, "Random seed: another one gives other performances")
        ->capture_default_str();
    command->add_option_function<std::string>(
        "--actions", [a](const std::string& all) { a->options.actions = parse_actions(all); },
        "Only these, as in 1,2,50-60 (default: all 120)");
    command
        ->add_option("--threads", a->options.threads,
                     "How many clips are made at once (default: one a processor)")
        ->check(CLI::Range(0U, most_threads));
    command->add_flag("--json", a->json, "Print JSON");
    examples(command,
             "  actformer synth ntu -o raw\n"
             "  actformer synth ntu -o raw --clips 24000 --seed 7\n"
             "  actformer synth ntu -o pairs --clips 2600 --actions 50-60,106-120\n");
    command->callback([a] { synth_ntu(*a); });
}

void add_stand_in(CLI::App* synth, const StandIn& stand_in) {
    struct Given {
        StandInOptions options;
        bool json = false;
    };
    auto* command = synth->add_subcommand(std::string(stand_in.name), std::string(stand_in.help));
    auto a = std::make_shared<Given>();
    a->options.clips = stand_in.clips;
    command->add_option("-o,--out", a->options.folder, "Folder to write into")->required();
    command->add_option("--clips", a->options.clips, "How many, " + std::string(stand_in.what_clips_do))
        ->capture_default_str()
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1000000}));
    command->add_option("--seed", a->options.seed, "Random seed: another one gives other performances")
        ->capture_default_str();
    command
        ->add_option("--threads", a->options.threads,
                     "How many clips are made at once (default: one a processor)")
        ->check(CLI::Range(0U, most_threads));
    command->add_flag("--json", a->json, "Print JSON");
    examples(command, std::string(stand_in.examples));
    command->callback([a, &stand_in] {
        run(a->options, a->json, [&](auto progress) {
            a->options.progress = progress;
            return stand_in.make(a->options);
        });
    });
}

}  // namespace

void add_synth(CLI::App& app) {
    auto* command = app.add_subcommand("synth", "Make licence-free stand-ins in the original raw formats");
    command->require_subcommand(1);
    add_ntu(command);
    for (const auto& stand_in : stand_ins()) add_stand_in(command, stand_in);
}

}  // namespace actformer::cli
