#include "cli/common_options.hpp"

#include <algorithm>
#include <filesystem>

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

void refuse_given(const CLI::App& command, std::initializer_list<const char*> options,
                  const std::string& why) {
    for (const char* option : options)
        if (command.count(option) > 0) throw Error("{}: {}; leave it out", option, why);
}

}  // namespace actformer::cli
