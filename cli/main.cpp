#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "cli/commands.hpp"

namespace {

int run(int argc, char** argv) {
    CLI::App app{"From raw motion capture to a published table."};
    app.name("actformer");
    app.set_version_flag("--version", ACTFORMER_VERSION);
    app.set_help_all_flag("--help-all", "Help of every command");
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);

    using namespace actformer::cli;
    add_devices(app);
    add_synth(app);
    add_ingest(app);
    add_inspect(app);
    add_export(app);
    add_render(app);
#ifdef ACTFORMER_WITH_TRAINING
    add_train(app);
    add_model(app);
#endif

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        fmt::print(stderr, "actformer: {} (see actformer --help)\n", e.what());
        return 1;
    }
    return 0;
}

}  // namespace

#ifdef ACTFORMER_WITH_TRAINING
/// OpenMP's threads spin while they wait, and on a machine with other work starve it and one another: training runs
/// two to four times slower. The library reads how to wait once, when it is loaded, so the program starts itself again.
/// Whoever sets OMP_WAIT_POLICY is left alone.
void train_without_spinning(int argc, char** argv) {
    if (argc < 2 || std::string_view(argv[1]) != "train" || std::getenv("OMP_WAIT_POLICY")) return;
    ::setenv("OMP_WAIT_POLICY", "passive", 1);
    ::execv("/proc/self/exe", argv);  // comes back only where it failed: training is slower then, not wrong
}
#endif

int main(int argc, char** argv) {
#ifdef ACTFORMER_WITH_TRAINING
    train_without_spinning(argc, argv);
#endif
    // Work goes batch by batch in buffers of the same sizes. Giving them back to the system in between would cost as much
    // in page faults as reading the data does.
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_ARENA_MAX, 1);
    try {
        return run(argc, argv);
    } catch (const std::exception& e) {
        fmt::print(stderr, "actformer: {}\n", e.what());
        return 1;
    }
}
