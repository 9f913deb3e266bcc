#include "cli/command_tree.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace actformer::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The values in a type such as "AXIS:{y,z,-y}".
std::vector<std::string> choices_in(const std::string& type) {
    std::vector<std::string> choices;
    const auto open = type.find('{'), close = type.find('}');
    if (open == std::string::npos || close == std::string::npos) return choices;
    for (auto at = open + 1; at <= close;) {
        const auto end = std::min(type.find(',', at), close);
        choices.push_back(type.substr(at, end - at));
        at = end + 1;
    }
    return choices;
}

OptionHelp help_of(const CLI::Option& option) {
    const CLI::Formatter formatter;
    OptionHelp help;
    const bool positional = option.get_snames().empty() && option.get_lnames().empty();
    help.name = formatter.make_option_name(&option, positional);
    help.value = formatter.make_option_opts(&option);
    help.text = option.get_description();
    for (const auto& name : option.get_snames()) help.words.push_back("-" + name);
    for (const auto& name : option.get_lnames()) help.words.push_back("--" + name);
    help.choices = choices_in(option.get_type_name());
    const auto type = option.get_type_name();
    if (type.starts_with("CONFIG.yaml")) help.shipped = "model/configs";
    if (type.starts_with("SWEEP.yaml")) help.shipped = "reports/sweeps";
    help.takes_value = option.get_type_size_max() > 0;
    return help;
}

Json to_json(const OptionHelp& option) {
    return {{"name", option.name},        {"value", option.value},     {"text", option.text},
            {"words", option.words},      {"choices", option.choices}, {"shipped", option.shipped},
            {"takes", option.takes_value}};
}

OptionHelp option_from_json(const Json& json) {
    return {json.at("name"),    json.at("value"),   json.at("text"), json.at("words"),
            json.at("choices"), json.at("shipped"), json.at("takes")};
}

}  // namespace

CommandHelp help_of(const CLI::App& app) {
    CommandHelp help;
    help.name = app.get_name();
    help.text = app.get_description();
    help.footer = app.get_footer();
    for (const auto* option : app.get_options()) {
        if (option->get_group().empty()) continue;
        auto one = help_of(*option);
        (one.words.empty() ? help.positionals : help.options).push_back(std::move(one));
    }
    for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
        if (!command->get_group().empty()) help.commands.push_back(help_of(*command));
    return help;
}

Json to_json(const CommandHelp& command) {
    Json json{{"name", command.name}, {"text", command.text}, {"footer", command.footer}};
    for (const auto* key : {"positionals", "options", "commands"}) json[key] = Json::array();
    for (const auto& option : command.positionals) json["positionals"].push_back(to_json(option));
    for (const auto& option : command.options) json["options"].push_back(to_json(option));
    for (const auto& one : command.commands) json["commands"].push_back(to_json(one));
    return json;
}

CommandHelp command_from_json(const Json& json) {
    CommandHelp command{json.at("name"), json.at("text"), json.at("footer"), {}, {}, {}};
    for (const auto& option : json.at("positionals")) command.positionals.push_back(option_from_json(option));
    for (const auto& option : json.at("options")) command.options.push_back(option_from_json(option));
    for (const auto& one : json.at("commands")) command.commands.push_back(command_from_json(one));
    return command;
}

void join(CommandHelp& command, const CommandHelp& more) {
    for (const auto& other : more.commands) {
        const auto same = std::ranges::find(command.commands, other.name, &CommandHelp::name);
        if (same == command.commands.end()) {
            command.commands.push_back(other);
            continue;
        }
        join(*same, other);
        if (same->options.size() + same->positionals.size() >=
            other.options.size() + other.positionals.size())
            continue;
        same->positionals = other.positionals;
        same->options = other.options;
        same->footer = other.footer;
    }
}

}  // namespace actformer::cli
