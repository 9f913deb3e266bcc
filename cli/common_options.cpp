#include "cli/common_options.hpp"

#include "base/error.hpp"

namespace actformer::cli {

void add_device_option(CLI::App* command, std::string& device) {
    command->add_option("--device", device, "OpenCL device: a number, gpu, cpu, or part of a name");
}

void add_force_option(CLI::App* command, bool& force) {
    command->add_flag("--force", force, "Replace a file that this program did not write");
}

void refuse_given(const CLI::App& command, std::initializer_list<const char*> options,
                  const std::string& why) {
    for (const char* option : options)
        if (command.count(option) > 0) throw Error("{}: {}; leave it out", option, why);
}

}  // namespace actformer::cli
