// actformer devices: the OpenCL devices and what matters of them.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "kernels/device.hpp"

namespace actformer::cli {
namespace {

void print_table(const std::vector<kernels::DeviceInfo>& devices, std::size_t chosen) {
    for (const auto& d : devices) {
        say("{} {}  {}\n", d.index == chosen ? "*" : " ", d.index, d.name);
        say("     {}, {} compute units at {} MHz, {:.1f} GiB memory{}, largest buffer {:.1f} GiB\n", d.type,
            d.compute_units, d.clock_mhz, static_cast<double>(d.memory) / (1 << 30),
            d.shares_memory ? " shared with the host" : "",
            static_cast<double>(d.max_allocation) / (1 << 30));
        say("     {} ({}, driver {})\n", d.version, d.platform, d.driver);
    }
    say("* is used unless --device or ACTFORMER_DEVICE says otherwise (a number, gpu, cpu, or part of a "
        "name)\n");
}

void print_json(const std::vector<kernels::DeviceInfo>& devices, std::size_t chosen) {
    auto out = nlohmann::ordered_json::array();
    for (const auto& d : devices)
        out.push_back({{"index", d.index},
                       {"name", d.name},
                       {"type", d.type},
                       {"platform", d.platform},
                       {"version", d.version},
                       {"driver", d.driver},
                       {"compute_units", d.compute_units},
                       {"clock_mhz", d.clock_mhz},
                       {"memory_bytes", d.memory},
                       {"max_allocation_bytes", d.max_allocation},
                       {"shares_memory", d.shares_memory},
                       {"default", d.index == chosen}});
    say_json(out);
}

}  // namespace

void add_devices(CLI::App& app) {
    auto* command = app.add_subcommand("devices", "List the OpenCL devices and which one is used");
    auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "Print JSON");
    examples(command, "  actformer devices\n  ACTFORMER_DEVICE=gpu actformer devices\n");
    command->callback([json] {
        const auto devices = kernels::list_devices();
        const auto chosen = kernels::choose_device(devices, {});
        *json ? print_json(devices, chosen) : print_table(devices, chosen);
    });
}

}  // namespace actformer::cli
