// actformer train check: whether configurations take the settings that a sweep has for them. Hidden: `sweep --dry-run` asks it.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "cli/commands.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/generators/method.hpp"
#include "model/recognisers/recogniser_settings.hpp"

namespace actformer::cli {
namespace {

model::Config configuration_of(const std::string& network, const std::string& file) {
    if (network == "generator") return model::read_generator_config(file);
    auto config = model::recogniser_config(model::recogniser_kind_in(file));
    config.load(file);
    return config;
}

/// Empty where all is well.
std::string problem_of(const nlohmann::json& training) try {
    const auto network = training.at("network").get<std::string>();
    auto config = configuration_of(network, training.at("config").get<std::string>());
    for (const auto& [key, value] : training.at("set").items())
        config.override_with(key + "=" + value.get<std::string>());
    config.override_with("data=.");  // the sweep's own
    if (network == "generator")
        model::generator_trainer_settings(config);
    else
        model::recogniser_settings(config);
    return {};
} catch (const Error& e) {
    return e.what();
}

void run(const std::filesystem::path& file) {
    std::vector<char> scratch;
    auto problems = nlohmann::json::array();
    for (const auto& training : nlohmann::json::parse(read_text(file, scratch, std::uint64_t{64} << 20)))
        problems.push_back(problem_of(training));
    fmt::print("{}\n", problems.dump());
}

}  // namespace

void add_check_trainings(CLI::App& train) {
    const auto file = std::make_shared<std::filesystem::path>();
    auto* command = train.add_subcommand("check", "Check a sweep's trainings")->group("");
    command->add_option("file", *file, "JSON: network, config and set of each")->required();
    command->callback([file] { run(*file); });
}

}  // namespace actformer::cli
