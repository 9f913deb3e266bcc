#include "cli/program.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>

namespace actformer::cli {
namespace {

bool knows(const CLI::App& app, const std::string& command) {
    const auto commands = app.get_subcommands([](const CLI::App*) { return true; });
    return std::any_of(commands.begin(), commands.end(),
                       [&](const CLI::App* c) { return c->get_name() == command; });
}

}  // namespace

void keep_freed_memory() {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_ARENA_MAX, 1);
}

int run_program(int argc, char** argv, const std::function<void(CLI::App&)>& add_commands) try {
    CLI::App app{"From raw motion capture to a published table."};
    app.name("actformer");
    app.set_version_flag("--version", ACTFORMER_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    add_commands(app);
    if (argc > 1 && argv[1][0] != '-' && !knows(app, argv[1])) {
        fmt::print(stderr, "actformer: there is no command '{}' (see actformer --help)\n", argv[1]);
        return 1;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        fmt::print(stderr, "actformer: {} (see actformer --help)\n", e.what());
        return 1;
    }
    return 0;
} catch (const std::exception& e) {
    fmt::print(stderr, "actformer: {}\n", e.what());
    return 1;
}

}  // namespace actformer::cli
