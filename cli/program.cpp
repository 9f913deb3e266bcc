#include "cli/program.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.hpp"
#include "base/files/memory_for.hpp"
#include "base/process/interruption.hpp"
#include "base/text/printable.hpp"
#include "base/text/suggestion.hpp"
#include "cli/built_with.hpp"
#include "cli/command_tree.hpp"

namespace actformer::cli {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
        if (!command->get_group().empty()) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const auto* option : app.get_options())
        for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// The deepest command that the words name, and how many words that takes, the program's own name first.
std::pair<const CLI::App*, int> command_named(const CLI::App& app, int argc, char** argv) {
    const CLI::App* command = &app;
    int words = 1;
    for (; words < argc; ++words) {
        const auto known = commands_of(*command);
        if (std::ranges::find(known, argv[words]) == known.end()) break;
        command = command->get_subcommand(argv[words]);
    }
    return {command, words};
}

/// What is wrong with the first word that is neither a command nor an option; empty where the words are known.
std::string unknown_word(const CLI::App& app, int argc, char** argv) {
    const auto [command, words] = command_named(app, argc, argv);
    const auto commands = commands_of(*command);
    if (words < argc && !commands.empty() && argv[words][0] != '-')
        return fmt::format("there is no command '{}'{}", printable(argv[words]),
                           suggestion(argv[words], commands));
    const auto options = options_of(*command);
    for (int i = words; i < argc && std::string_view(argv[i]) != "--"; ++i) {
        const std::string word(argv[i], std::strcspn(argv[i], "="));
        if (word.starts_with("--") && std::ranges::find(options, word) == options.end())
            return fmt::format("there is no option '{}'{}", printable(word), suggestion(word, options));
    }
    return {};
}

}  // namespace

void keep_freed_memory() {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_ARENA_MAX, 1);
}

namespace {

/// What is wrong with the words, and where help is.
std::string refusal(const CLI::App& app, int argc, char** argv, const CLI::ParseError& error) {
    const auto unknown = unknown_word(app, argc, argv);
    auto help = app.get_name();
    for (int i = 1; i < command_named(app, argc, argv).second; ++i) help += fmt::format(" {}", argv[i]);
    return fmt::format("{} (see {} --help)", unknown.empty() ? printable(error.what()) : unknown, help);
}

int parse(int argc, char** argv, const std::function<void(CLI::App&)>& add_commands) {
    CLI::App app{"From raw motion capture to a published table."};
    app.name("actformer");
    app.set_version_flag("--version", built_with);
    app.require_subcommand(1);
    app.add_subcommand("describe", "Print the commands of this program, as JSON")
        ->group("")
        ->callback([&app] { fmt::print("{}\n", to_json(help_of(app)).dump()); });
    app.get_formatter()->column_width(34);
    add_commands(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        fmt::print(stderr, "actformer: {}\n", refusal(app, argc, argv, e));
        return 1;
    }
    return 0;
}

/// So that parsing checks words and runs no command.
void forget_callbacks(CLI::App& app) {
    app.callback({});
    for (auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
        forget_callbacks(*command);
}

/// What was printed must have arrived. Nobody need read it all.
int closed_output() {
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return 0;
    if (errno == EPIPE) return 128 + SIGPIPE;
    fmt::print(stderr, "actformer: standard output cannot be written: {}\n", std::strerror(errno));
    return 1;
}

/// After what was printed before, also where both go into one file.
int failed(const std::string& why) {
    std::fflush(stdout);
    fmt::print(stderr, "actformer: {}\n", printable(why));
    return 1;
}

}  // namespace

std::string problem_of(std::vector<std::string> words,
                       const std::function<void(CLI::App&)>& add_commands) try {
    CLI::App app;
    app.name("actformer");
    app.require_subcommand(1);
    add_commands(app);
    forget_callbacks(app);
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    const int count = static_cast<int>(arguments.size());
    try {
        app.parse(count, arguments.data());
    } catch (const CLI::Success&) {
        return "help is asked for, and nothing done";
    } catch (const CLI::ParseError& e) {
        return refusal(app, count, arguments.data(), e);
    }
    return {};
} catch (const Error& e) {
    return e.what();
}

int run_program(int argc, char** argv, const std::function<void(CLI::App&)>& add_commands) try {
    end_in_order();
    const int code = parse(argc, argv, add_commands);
    const int output = closed_output();
    return code ? code : output;
} catch (const Interrupted& e) {
    failed(e.what());
    return e.exit_code();
} catch (const std::bad_alloc& e) {
    const auto* file = dynamic_cast<const NoMemoryFor*>(&e);
    return failed(std::string(file ? file->what() : "not enough memory") +
                  "; fewer --threads or a smaller --batch, where there is one, take less, and limits may be "
                  "raised (ulimit -v)");
} catch (const std::system_error& e) {  // of fmt::print, where standard output is a pipe that nobody reads
    return e.code() == std::errc::broken_pipe ? 128 + SIGPIPE : failed(e.what());
} catch (const std::exception& e) {
    return failed(e.what());
}

}  // namespace actformer::cli
