// What --help says of every command, as data: man pages and completions are made of it. Commands live in several programs; each
// describes its own in JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cli/commands.hpp"

namespace actformer::cli {

struct OptionHelp {
    std::string name;                  ///< as in "-o,--out", or a positional's
    std::string value;                 ///< what follows it, as in " DIR REQUIRED"
    std::string text;                  ///< what it is for
    std::vector<std::string> words;    ///< "-o", "--out"; none of a positional
    std::vector<std::string> choices;  ///< values, where only these are taken
    std::string shipped;  ///< folder of the files that come with the program whose names it takes
    bool takes_value = false;

    bool operator==(const OptionHelp&) const = default;
};

struct CommandHelp {
    std::string name, text, footer;
    std::vector<OptionHelp> positionals, options;
    std::vector<CommandHelp> commands;

    bool operator==(const CommandHelp&) const = default;
};

/// Hidden commands and options are left out.
CommandHelp help_of(const CLI::App& app);

nlohmann::ordered_json to_json(const CommandHelp& command);
CommandHelp command_from_json(const nlohmann::ordered_json& json);

/// Adds the commands of `more` to `command`. Of one that both have, the one with more options tells them: a program knows only the name
/// of what lives in another.
void join(CommandHelp& command, const CommandHelp& more);

}  // namespace actformer::cli
