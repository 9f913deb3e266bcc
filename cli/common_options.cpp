#include "cli/common_options.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/error.hpp"
#include "base/text/lower_case.hpp"
#include "base/text/printable.hpp"

namespace actformer::cli {

void add_device_option(CLI::App* command, std::string& device) {
    command->add_option("--device", device, "OpenCL device: a number, gpu, cpu, or part of a name");
}

void add_force_option(CLI::App* command, bool& force) {
    command->add_flag("--force", force, "Replace a file that this program did not write");
}

std::function<std::string(const std::string&)> ends_in(const std::string& ending) {
    return [ending](const std::string& path) -> std::string {
        static const std::vector<std::vector<std::string>> kinds{{".h5", ".hdf5"},  {".csv", ".tsv", ".txt"},
                                                                 {".html", ".htm"}, {".json"},
                                                                 {".tex"},          {".gif"},
                                                                 {".png"},          {".mp4"},
                                                                 {".npz"},          {".npy"},
                                                                 {".bvh"},          {".glb"},
                                                                 {".yaml", ".yml"}, {".pdf"}};
        const auto given = lower_case(std::filesystem::path(path).extension().string());
        const auto has = [](const auto& kind, const std::string& one) {
            return std::ranges::count(kind, one) > 0;
        };
        for (const auto& kind : kinds)
            if (has(kind, given) && !has(kind, ending))
                return fmt::format("{}: the file written is not a {}; let its name end in {}",
                                   printable(path), given, ending);
        return {};
    };
}

CLI::Validator number_in(double least, double most) {
    const auto refuse_nan = [](std::string& text) -> std::string {
        double number = 0;
        const bool is_nan = CLI::detail::lexical_cast(text, number) && std::isnan(number);
        return is_nan ? fmt::format("Value {} not in range of numbers", text) : "";
    };
    return CLI::Range(least, most) & CLI::Validator(refuse_nan, "");
}

CLI::Option* add_overrides(CLI::App* command, std::vector<std::string>& overrides, const std::string& help) {
    const auto take = [&overrides](const std::vector<std::string>& words) {
        std::set<std::string> seen;
        for (const auto& word : words)
            if (const auto key = word.substr(0, word.find('=')); !seen.insert(key).second)
                throw Error("'{}': {} is given twice", word, key);
        overrides = words;
    };
    return command->add_option_function<std::vector<std::string>>("overrides", take, help)
        ->type_name("KEY=VALUE");
}

void refuse_given(const CLI::App& command, std::initializer_list<const char*> options,
                  const std::string& why) {
    for (const char* option : options)
        if (command.count(option) > 0) throw Error("{}: {}; leave it out", option, why);
}

}  // namespace actformer::cli
