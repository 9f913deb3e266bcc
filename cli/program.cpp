#include "cli/program.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
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
#include "cli/say.hpp"

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

/// The value behind an unknown option: "3" of --epochs 3 and of --epochs=3; "VALUE" where there is none.
std::string value_behind(int at, int argc, char** argv) {
    const std::string word = argv[at];
    if (const auto equals = word.find('='); equals != word.npos) return word.substr(equals + 1);
    const std::string next = at + 1 < argc ? argv[at + 1] : "-";
    return next.starts_with('-') || next.find('=') != next.npos ? "VALUE" : next;
}

/// How to write a key of the configuration that was written as an option; empty where the command takes no keys.
std::string key_in_place_of(const CLI::App& command, const std::string& word, const std::string& value) {
    const auto takes_keys = [](const CLI::Option* option) { return option->get_type_name() == "KEY=VALUE"; };
    if (command.get_options(takes_keys).empty()) return {};
    auto key = word.substr(2);
    std::ranges::replace(key, '-', '_');
    return fmt::format("keys of the configuration are written {}={}", printable(key), printable(value));
}

/// The words that the options and commands leave over.
std::vector<std::string> left_over(const CLI::App& app) {
    auto words = app.remaining(true);
    std::erase(words, "--");
    return words;
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
        if (!word.starts_with("--") || std::ranges::find(options, word) != options.end()) continue;
        const auto meant = suggestion(word, options);
        const auto key = key_in_place_of(*command, word, value_behind(i, argc, argv));
        return fmt::format("there is no option '{}'{}{}{}", printable(word), key.empty() ? "" : "; ", key,
                           meant);
    }
    for (const auto& word : left_over(app))
        if (word.size() > 1 && word[0] == '-' && (word[1] < '0' || word[1] > '9'))
            return fmt::format("there is no option '{}'", printable(word));
    return {};
}

bool is_unsigned(const CLI::Option& option) {
    const auto type = option.get_type_name();
    return type.starts_with("UINT") || type == "SEED";
}

/// The numbers that an option takes, by its type in --help: "a whole number from 1 to 9" of "UINT:INT in [1 - 9]".
std::string numbers_of(const CLI::Option& option) {
    const auto type = option.get_type_name();
    const bool whole = is_unsigned(option) || type.find("INT") != type.npos;
    const std::string out = whole ? "a whole number" : "a number";
    constexpr std::string_view in = " in [", to = " - ";
    const auto from = type.find(in);
    if (from == type.npos) return out + (is_unsigned(option) ? " from 0" : "");
    const auto bounds = type.substr(from + in.size(), type.find(']', from) - from - in.size());
    const auto dash = bounds.find(to, 1);
    return fmt::format("{} from {} to {}", out, bounds.substr(0, dash), bounds.substr(dash + to.size()));
}

bool is_number(std::string_view text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

std::string is_not(std::string_view value, const std::string& wanted) {
    return fmt::format("{} is not {}", in_quotes(value), wanted);
}

std::string refused_number(const CLI::Option& option, std::string_view value) {
    auto wanted = numbers_of(option);
    // The type may be a placeholder such as N. A number that is none for CLI11 was to be a whole one then.
    if (wanted == "a number" && is_number(value)) wanted = "a whole number from 0";
    return fmt::format("{}: {}", option.get_name(), is_not(value, wanted));
}

/// What an option takes, as in " (DIR)"; empty where its type does not tell.
std::string taken_by(const CLI::Option& option) {
    auto type = option.get_type_name();
    if (is_unsigned(option) || type.starts_with("INT") || type.starts_with("FLOAT"))
        type = numbers_of(option);
    else if (type.starts_with("TEXT"))
        type.erase(0, std::string_view("TEXT:").size());
    return type.empty() ? "" : fmt::format(" ({})", type);
}

std::string missing_value(const CLI::Option& option) {
    return fmt::format("{}: a value is missing{}", option.get_name(), taken_by(option));
}

/// CLI11's sentence on an option, in words of ours; one that has none stays.
std::string in_words(const CLI::App& command, const CLI::ParseError& error) {
    constexpr std::string_view unread = "Could not convert: ", value = ": Value ", range = " not in range ";
    std::string_view said = error.what();
    if (said.starts_with(unread)) said.remove_prefix(unread.size());
    for (const auto* option : command.get_options()) {
        const auto name = option->get_name();
        if (!said.starts_with(name)) continue;
        const auto rest = said.substr(name.size());
        if (rest.starts_with(" = ")) return refused_number(*option, rest.substr(3));
        if (const auto end = rest.find(range); rest.starts_with(value) && end != rest.npos)
            return refused_number(*option, rest.substr(value.size(), end - value.size()));
        if (rest.starts_with(": 1 required ")) return missing_value(*option);
        if (rest.starts_with(": At Most 1 required "))
            return fmt::format("{}: given {} times; give it once", name, option->count());
    }
    return printable(error.what());
}

/// "--generator, --out are required", of those that were not given; empty where none was left out.
std::string required_yet(const CLI::App& command) {
    std::vector<std::string> names;
    for (const auto* option : command.get_options())
        if (option->get_required() && option->count() == 0) names.push_back(option->get_name());
    if (names.empty()) return {};
    return fmt::format("{} {} required", fmt::join(names, ", "), names.size() == 1 ? "is" : "are");
}

/// What is wrong where all options and commands are known.
std::string known_problem(const CLI::App& app, const CLI::App& command, const CLI::ParseError& error) {
    const bool lacks = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (!lacks && dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return in_words(command, error);
    const auto required = required_yet(command);
    if (const auto words = left_over(app); !words.empty())
        return fmt::format("there is no place for {}{}{}", in_quotes(words[0]), required.empty() ? "" : "; ",
                           required);
    if (!required.empty()) return required;
    const auto commands = commands_of(command);
    if (commands.empty()) return in_words(command, error);
    return fmt::format("no command is given; there are {}", fmt::join(commands, ", "));
}

/// CLI11 takes -1, and what is too large, for the largest number of all, and 010 for 8: here the first two are refused, and the third
/// is 10.
CLI::Validator whole_number(const CLI::Option& option) {
    const auto read = [&option](std::string& text) -> std::string {
        const auto digits = std::string_view(text).substr(text.starts_with('+') ? 1 : 0);
        std::uint64_t number = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        if (error != std::errc() || end != digits.data() + digits.size())
            return is_not(text, numbers_of(option));
        text = std::to_string(number);
        return {};
    };
    return {read, ""};
}

/// An empty value comes of a shell's variable that is not set.
CLI::Validator not_empty(const CLI::Option& option) {
    const auto check = [&option](const std::string& text) -> std::string {
        if (!text.empty()) return {};
        return fmt::format("is empty; give a value{}{}", taken_by(option),
                           option.get_required() ? "" : " or leave it out");
    };
    return {check, ""};
}

/// Before the checks that the options of every command have.
void check_values(CLI::App& app) {
    for (auto* option : app.get_options())
        if (option->get_type_size_max() > 0)
            option->transform(is_unsigned(*option) ? whole_number(*option) : not_empty(*option));
    for (auto* command : app.get_subcommands([](const CLI::App*) { return true; })) check_values(*command);
}

/// The last one first, as CLI11 reads them. It takes the next word for the value of "--out=", which is empty here.
std::vector<std::string> reversed_words(int argc, char** argv) {
    std::vector<std::string> words;
    bool options = true;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        options = options && word != "--";
        const bool is_bare =
            options && word.size() > 3 && word.starts_with("--") && word.find('=') == word.size() - 1;
        words.push_back(is_bare ? word.substr(0, word.size() - 1) : word);
        if (is_bare) words.emplace_back();
    }
    std::ranges::reverse(words);
    return words;
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
    const auto [command, words] = command_named(app, argc, argv);
    auto why = unknown_word(app, argc, argv);
    if (why.empty()) why = known_problem(app, *command, error);
    auto help = app.get_name();
    for (int i = 1; i < words; ++i) help += fmt::format(" {}", argv[i]);
    return fmt::format("{} (see {} --help)", why, help);
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
    check_values(app);
    try {
        app.parse(reversed_words(argc, argv));
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        write_to_stderr(fmt::format("actformer: {}\n", refusal(app, argc, argv, e)));
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
    write_to_stderr(fmt::format("actformer: standard output cannot be written: {}\n", std::strerror(errno)));
    return 1;
}

/// Without the library's words around it.
std::string told(const std::filesystem::filesystem_error& error) {
    const auto path = error.path1().string(), reason = error.code().message();
    return path.empty() ? reason : fmt::format("{}: {}", path, reason);
}

/// After what was printed before, also where both go into one file.
int failed(const std::string& why) {
    std::fflush(stdout);
    write_to_stderr(fmt::format("actformer: {}\n", printable(why)));
    return 1;
}

}  // namespace

std::string problem_of(std::vector<std::string> words,
                       const std::function<void(CLI::App&)>& add_commands) try {
    CLI::App app;
    app.name("actformer");
    app.require_subcommand(1);
    add_commands(app);
    check_values(app);
    forget_callbacks(app);
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    const int count = static_cast<int>(arguments.size());
    try {
        app.parse(reversed_words(count, arguments.data()));
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
} catch (const std::filesystem::filesystem_error& e) {
    return failed(told(e));
} catch (const std::system_error& e) {  // of fmt::print, where standard output is a pipe that nobody reads
    return e.code() == std::errc::broken_pipe ? 128 + SIGPIPE : failed(e.what());
} catch (const std::exception& e) {
    return failed(e.what());
}

}  // namespace actformer::cli
