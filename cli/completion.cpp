#include "cli/completion.hpp"

#include <fmt/format.h>

#include "base/process/shipped.hpp"

namespace actformer::cli {
namespace {

/// A command and the words that lead to it, each after a space: " ingest ntu"; empty for the program itself.
struct Place {
    std::string at;
    const CommandHelp* command = nullptr;
};

void gather(const CommandHelp& command, const std::string& at, std::vector<Place>& places) {
    places.push_back({at, &command});
    for (const auto& one : command.commands) gather(one, at + " " + one.name, places);
}

std::string in_single_quotes(std::string_view text, std::string_view quote) {
    std::string out = "'";
    for (const char c : text) c == '\'' ? out += quote : out += c;
    return out + "'";
}

/// For bash and zsh.
std::string shell_quoted(std::string_view text) {
    return in_single_quotes(text, "'\\''");
}

/// The first sentence: what fits on a line of a list.
std::string brief(const std::string& text) {
    auto line = text.substr(0, text.find_first_of("\n;"));
    if (const auto end = line.find(". "); end != std::string::npos) line.resize(end);
    return line;
}

/// Values an option or a positional takes: all there are, or names that stand beside files.
std::vector<std::string> values_of(const OptionHelp& option) {
    return option.shipped.empty() ? option.choices : shipped_names(option.shipped);
}

std::vector<std::string> words_of(const std::vector<OptionHelp>& options) {
    std::vector<std::string> words;
    for (const auto& option : options) words.insert(words.end(), option.words.begin(), option.words.end());
    return words;
}

/// Names that a command's positionals take besides files.
std::vector<std::string> names_of(const CommandHelp& command) {
    std::vector<std::string> names;
    for (const auto& one : command.positionals)
        for (auto& name : values_of(one)) names.push_back(std::move(name));
    return names;
}

/// The patterns of a shell's `case` for all commands: what a word may add to the place it stands at.
std::string all_places(const std::vector<Place>& places, const char* between) {
    std::vector<std::string> patterns;
    for (const auto& place : places)
        if (!place.at.empty()) patterns.push_back(shell_quoted(place.at));
    return fmt::format("{}", fmt::join(patterns, between));
}

/// Calls add(place, option, value-taking word, values) for every option that takes some values only, or names besides files.
template <typename Add>
void for_each_value(const std::vector<Place>& places, const Add& add) {
    for (const auto& place : places)
        for (const auto& option : place.command->options)
            if (const auto values = values_of(option); option.takes_value && !values.empty())
                add(place, option, values);
}

/// The same for an option of a place, by any of its names.
std::string patterns_of(const Place& place, const OptionHelp& option, const char* between) {
    std::vector<std::string> patterns;
    for (const auto& word : option.words) patterns.push_back(shell_quoted(place.at + " " + word));
    return fmt::format("{}", fmt::join(patterns, between));
}

std::string bash_values(const std::vector<Place>& places) {
    std::string text;
    for_each_value(places, [&](const Place& place, const OptionHelp& option, const auto& values) {
        text += fmt::format("    {}) values={}{} ;;\n", patterns_of(place, option, " | "),
                            shell_quoted(fmt::format("{}", fmt::join(values, " "))),
                            option.shipped.empty() ? "" : " files=1");
    });
    return text;
}

std::string bash(const std::vector<Place>& places) {
    std::string lists;
    for (const auto& place : places) {
        std::vector<std::string> commands;
        for (const auto& one : place.command->commands) commands.push_back(one.name);
        lists +=
            fmt::format("    {}) commands={} options={} names={} ;;\n", shell_quoted(place.at),
                        shell_quoted(fmt::format("{}", fmt::join(commands, " "))),
                        shell_quoted(fmt::format("{}", fmt::join(words_of(place.command->options), " "))),
                        shell_quoted(fmt::format("{}", fmt::join(names_of(*place.command), " "))));
    }
    return fmt::format(R"(_actformer() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
    local at='' commands='' options='' names='' values='' files='' i
    for ((i = 1; i < COMP_CWORD; ++i)); do
        case "$at ${{COMP_WORDS[i]}}" in
        {}) at+=" ${{COMP_WORDS[i]}}" ;;
        esac
    done
    case "$at" in
{}    esac
    case "$at $previous" in
{}    *) files=1 ;;
    esac
    COMPREPLY=()
    if [[ -n $values ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
        return
    elif [[ -n $commands ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
        return
    else
        mapfile -t COMPREPLY < <(compgen -W "$names" -- "$current")
    fi
    if [[ -n $files ]]; then
        local file
        while IFS= read -r file; do COMPREPLY+=("$file"); done < <(compgen -f -- "$current")
        compopt -o filenames 2>/dev/null
    fi
}}
complete -F _actformer actformer
)",
                       all_places(places, " | "), lists, bash_values(places));
}

/// 'word:what it is', as zsh describes it.
std::string described(const std::string& word, const std::string& text) {
    std::string name;
    for (const char c : word) name += c == ':' ? std::string("\\:") : std::string(1, c);
    return shell_quoted(name + ":" + brief(text));
}

std::string zsh(const std::vector<Place>& places) {
    std::string lists;
    for (const auto& place : places) {
        std::vector<std::string> commands, options, names;
        for (const auto& one : place.command->commands) commands.push_back(described(one.name, one.text));
        for (const auto& option : place.command->options)
            for (const auto& word : option.words) options.push_back(described(word, option.text));
        for (const auto& name : names_of(*place.command)) names.push_back(shell_quoted(name));
        lists += fmt::format("    {}) commands=({}) options=({}) names=({}) ;;\n", shell_quoted(place.at),
                             fmt::join(commands, " "), fmt::join(options, " "), fmt::join(names, " "));
    }
    std::string values;
    for_each_value(places, [&](const Place& place, const OptionHelp& option, const auto& some) {
        std::vector<std::string> each;
        for (const auto& one : some) each.push_back(shell_quoted(one));
        values += fmt::format("    {}) values=({}){} ;;\n", patterns_of(place, option, "|"),
                              fmt::join(each, " "), option.shipped.empty() ? "" : " files=1");
    });
    return fmt::format(R"(#compdef actformer
_actformer() {{
    local at='' files='' i
    local -a commands options names values
    for ((i = 2; i < CURRENT; ++i)); do
        case "$at ${{words[i]}}" in
        {}) at+=" ${{words[i]}}" ;;
        esac
    done
    case "$at" in
{}    esac
    case "$at ${{words[CURRENT - 1]}}" in
{}    *) files=1 ;;
    esac
    if (( $#values )); then
        compadd -a values
    elif [[ ${{words[CURRENT]}} == -* ]]; then
        _describe option options
        return
    elif (( $#commands )); then
        _describe command commands
        return
    else
        (( $#names )) && compadd -a names
    fi
    [[ -n $files ]] && _files
}}
if [[ $funcstack[1] == _actformer ]]; then _actformer "$@"; else compdef _actformer actformer; fi
)",
                       all_places(places, "|"), lists, values);
}

std::string fish_quoted(const std::string& text) {
    std::string escaped;
    for (const char c : text) escaped += c == '\\' ? std::string("\\\\") : std::string(1, c);
    return in_single_quotes(escaped, "\\'");
}

std::string fish_option(const Place& place, const OptionHelp& option) {
    auto line = fmt::format("complete -c actformer -n {}", fish_quoted("__actformer_at" + place.at));
    for (const auto& word : option.words)
        line += word.starts_with("--") ? " -l " + word.substr(2) : " -s " + word.substr(1);
    const auto values = values_of(option);
    if (option.takes_value) line += option.shipped.empty() && !values.empty() ? " -x" : " -r";
    if (!values.empty()) line += " -a " + fish_quoted(fmt::format("{}", fmt::join(values, " ")));
    return line + " -d " + fish_quoted(brief(option.text)) + "\n";
}

std::string fish(const std::vector<Place>& places) {
    auto text = fmt::format(R"(function __actformer_at
    set -l at ''
    for word in (commandline -opc)[2..-1]
        switch "$at $word"
            case {}
                set at "$at $word"
        end
    end
    set -l wanted ''
    for word in $argv
        set wanted "$wanted $word"
    end
    test "$at" = "$wanted"
end
)",
                            all_places(places, " "));
    for (const auto& place : places) {
        const auto here = fish_quoted("__actformer_at" + place.at);
        for (const auto& one : place.command->commands)
            text += fmt::format("complete -c actformer -n {} -f -a {} -d {}\n", here, one.name,
                                fish_quoted(brief(one.text)));
        for (const auto& option : place.command->options) text += fish_option(place, option);
        if (const auto names = names_of(*place.command); !names.empty())
            text += fmt::format("complete -c actformer -n {} -a {}\n", here,
                                fish_quoted(fmt::format("{}", fmt::join(names, " "))));
    }
    return text;
}

}  // namespace

std::vector<std::string> shells() {
    return {"bash", "zsh", "fish"};
}

std::string completion(const CommandHelp& root, const std::string& shell) {
    std::vector<Place> places;
    gather(root, "", places);
    const auto script = shell == "bash" ? bash(places) : shell == "zsh" ? zsh(places) : fish(places);
    const auto note = fmt::format("# {} completion of actformer {}\n", shell, ACTFORMER_VERSION);
    if (shell != "zsh") return note + script;
    const auto first = script.find('\n') + 1;  // zsh looks at the first line
    return script.substr(0, first) + note + script.substr(first);
}

}  // namespace actformer::cli
