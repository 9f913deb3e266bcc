#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/process/brief_waits.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "base/process/signal_mask.hpp"
#include "cli/command_tree.hpp"
#include "cli/completion.hpp"
#include "cli/least_processor.hpp"
#include "cli/man_pages.hpp"
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
    {"import", "actformer-train", "Convert released PyTorch weights for this program"},
    {"model", "actformer-train", "Print a configuration's layers, shapes and parameter counts"}};

/// Beside this program where it was built, in libexec where it is installed.
std::filesystem::path path_of(const Subprogram& sub) {
    const auto folder = actformer::program_folder();
    auto beside = folder / sub.program;
    return std::filesystem::exists(beside) ? beside
                                           : folder.parent_path() / "libexec/actformer" / sub.program;
}

/// Becomes the program that a command lives in; comes back only where it cannot.
int become(const Subprogram& sub, char** argv) {
    actformer::wait_briefly();
    actformer::block_signals();
    ::execv(path_of(sub).c_str(), argv);
    const bool draws = std::string_view(sub.program) == "actformer-render";
    std::fprintf(stderr, "actformer: '%s' is done by %s, which is not here: %s\n", sub.command, sub.program,
                 draws ? "build it where OpenCV is installed (see docs/house.md)"
                       : "install the package actformer-train, or build with libtorch (see docs/house.md)");
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

/// All commands, also those of the programs beside this one.
actformer::cli::CommandHelp all_commands(const CLI::App& app) {
    auto all = actformer::cli::help_of(app);
    for (const char* program : {"actformer-render", "actformer-train"}) {
        const auto path = path_of({"", program, ""});
        if (!std::filesystem::exists(path)) continue;
        const auto said = actformer::output_of({path.string(), "describe"});
        if (!said) throw actformer::Error("{}: does not tell its commands; install it anew", path.string());
        join(all, actformer::cli::command_from_json(nlohmann::ordered_json::parse(*said)));
    }
    return all;
}

/// Man pages and completions, made of what --help says.
void add_documentation(CLI::App& app) {
    using namespace actformer::cli;
    auto* completions = app.add_subcommand("completion", "Print what a shell needs to complete commands");
    const auto shell = std::make_shared<std::string>();
    completions->add_option("shell", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember(shells()));
    examples(completions,
             "  source <(actformer completion bash)\n"
             "  source <(actformer completion zsh)\n"
             "  actformer completion fish | source\n"
             "An installed program needs none of this: shells find the scripts by themselves.\n");
    completions->callback([&app, shell] { fmt::print("{}", completion(all_commands(app), *shell)); });

    auto* man = app.add_subcommand("man", "Write a man page of every command")->group("");
    const auto folder = std::make_shared<std::filesystem::path>();
    man->add_option("-o,--out", *folder, "Folder to write them in")->required()->type_name("DIR");
    man->callback([&app, folder] {
        say("{}: {} pages\n", folder->string(), write_man_pages(all_commands(app), *folder));
    });
}

/// What the program without a word says: commands that a newcomer can begin with, in any folder. Exit code 1, as nothing was done.
int first_words() {
    const auto here = [](std::string_view command) {
        return std::ranges::any_of(subprograms, [&](const Subprogram& sub) {
            return sub.command == command && std::filesystem::exists(path_of(sub));
        });
    };
    std::string lines =
        "actformer: from raw motion capture to a published table.\n\n"
        "To begin with, on motion and weights that come with the program:\n\n"
        "  # recordings become a dataset\n"
        "  actformer ingest bvh examples/cmu/cmu.tar.xz -o cmu --name '{part}/{action}/{*}'\n";
    if (here("render"))
        lines +=
            "  # four of them, drawn\n"
            "  actformer render cmu --class walking --count 4 -o walking.gif\n";
    if (here("generate"))
        lines +=
            "  # others of the same actions, made by a trained generator\n"
            "  actformer generate --generator weights/cmu/actformer.h5 -o generated.h5\n";
    lines +=
        "\nactformer --help lists all commands; actformer COMMAND --help shows "
        "one of them,\nwith examples.\n";
    std::fputs(lines.c_str(), stderr);
    return 1;
}

/// Headings of the help, in the order of a project's life.
void group_commands(CLI::App& app) {
    const std::pair<const char*, std::vector<std::string>> groups[] = {
        {"Data", {"synth", "ingest", "inspect", "export", "render"}},
        {"Networks", {"train", "model", "generate", "import", "features", "classify"}},
        {"Results", {"score", "compare", "sweep", "report"}},
        {"This machine", {"devices", "bench", "completion"}}};
    for (auto* command : app.get_subcommands([](CLI::App*) { return true; }))
        for (const auto& [heading, names] : groups)
            if (std::ranges::find(names, command->get_name()) != names.end()) command->group(heading);
}

}  // namespace

int main(int argc, char** argv) {
    actformer::cli::expect_least_processor();
    if (argc < 2) return first_words();
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
        add_compare(app);
        add_report(app);
        for (const auto& sub : subprograms)
            if (std::filesystem::exists(path_of(sub))) app.add_subcommand(sub.command, sub.description);
        add_devices(app);
        add_bench(app);
        add_documentation(app);
        if (std::filesystem::exists(path_of(bench_train)))
            app.get_subcommand("bench")->add_subcommand("train", bench_train.description);
        group_commands(app);
    });
}
