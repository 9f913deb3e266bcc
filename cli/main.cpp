#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/process/process.hpp"
#include "base/process/signal_mask.hpp"
#include "cli/program.hpp"

namespace {

/// Commands over large libraries are programs of their own beside this one, so that the others start at once.
struct Subprogram {
    const char *command, *program, *description;
};
constexpr Subprogram subprograms[] = {
    {"render", "actformer-render", "Draw motions: a contact sheet (.png), a .gif or an .mp4"},
    {"train", "actformer-train", "Train a recogniser or a generator"},
    {"generate", "actformer-train", "Generate motions with a trained generator"},
    {"import", "actformer-train", "Turn released PyTorch weights into weights of ours"},
    {"model", "actformer-train", "Print a configuration's layers, shapes and parameter counts"}};

std::filesystem::path path_of(const Subprogram& sub) {
    return actformer::program_folder() / sub.program;
}

/// OpenMP's threads spin while they wait, and on a machine with other work starve it and one another: training runs two to
/// four times slower. The library reads how to wait when it is loaded. Whoever sets OMP_WAIT_POLICY is left alone.
void wait_without_spinning() {
    ::setenv("OMP_WAIT_POLICY", "passive", 0);
}

/// Becomes the program that a command lives in; comes back only where it cannot.
int become(const Subprogram& sub, char** argv) {
    wait_without_spinning();
    actformer::block_signals();
    ::execv(path_of(sub).c_str(), argv);
    std::fprintf(
        stderr,
        "actformer: this build has no '%s': %s is not beside it (train, generate, import, model and score "
        "--generator need "
        "libtorch; see README)\n",
        sub.command, sub.program);
    return 1;
}

/// `bench train` lives with what it measures; the other benchmarks are here.
constexpr Subprogram bench_train{"bench train", "actformer-train",
                                 "Training and generation, beside eager PyTorch"};

/// `score --generator` lives with the generators, whose motions never leave memory.
constexpr Subprogram score_generator{"score --generator", "actformer-train", ""};

bool asks_to_score_a_generator(int argc, char** argv) {
    if (argc < 3 || std::string_view(argv[1]) != "score") return false;
    return std::any_of(argv + 2, argv + argc, [](std::string_view word) {
        return word == "--generator" || word.starts_with("--generator=");
    });
}

bool asks_for_bench_train(int argc, char** argv) {
    return argc > 2 && std::string_view(argv[1]) == "bench" && std::string_view(argv[2]) == "train";
}

/// Headings of the help, in the order of a project's life.
void group_commands(CLI::App& app) {
    const std::pair<const char*, std::vector<std::string>> groups[] = {
        {"Data", {"synth", "ingest", "inspect", "export", "render"}},
        {"Networks", {"train", "model", "generate", "import", "features", "classify"}},
        {"Results", {"score", "sweep", "report"}},
        {"This machine", {"devices", "bench"}}};
    for (auto* command : app.get_subcommands([](CLI::App*) { return true; }))
        for (const auto& [heading, names] : groups)
            if (std::ranges::find(names, command->get_name()) != names.end()) command->group(heading);
}

}  // namespace

int main(int argc, char** argv) {
    if (asks_for_bench_train(argc, argv)) return become(bench_train, argv);
    if (asks_to_score_a_generator(argc, argv)) return become(score_generator, argv);
    for (const auto& sub : subprograms)
        if (argc > 1 && std::string_view(argv[1]) == sub.command) return become(sub, argv);

    using namespace actformer::cli;
    keep_freed_memory();
    return run_program(argc, argv, [](CLI::App& app) {
        add_synth(app);
        add_ingest(app);
        add_inspect(app);
        add_export(app);
        add_features(app);
        add_classify(app);
        add_score(app);
        add_sweep(app);
        add_report(app);
        for (const auto& sub : subprograms)
            if (std::filesystem::exists(path_of(sub))) app.add_subcommand(sub.command, sub.description);
        add_devices(app);
        add_bench(app);
        if (std::filesystem::exists(path_of(bench_train)))
            app.get_subcommand("bench")->add_subcommand("train", bench_train.description);
        group_commands(app);
    });
}
