#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "cli/program.hpp"

namespace {

/// Commands over large libraries are programs of their own, so that the others start at once.
struct Subprogram {
    const char *command, *program, *description;
};
constexpr Subprogram subprograms[] = {
    {"render", "actformer-render", "Draw motions: a contact sheet (.png), a .gif or an .mp4"}};

/// Becomes the program beside this one that a command lives in; returns where there is none.
void become(const char* program, char** argv) {
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    execv((self.parent_path() / program).c_str(), argv);
    std::fprintf(stderr, "actformer: %s is missing beside %s; build it again\n", program, self.c_str());
}

}  // namespace

int main(int argc, char** argv) {
    for (const auto& sub : subprograms)
        if (argc > 1 && std::string_view(argv[1]) == sub.command) {
            become(sub.program, argv);
            return 1;
        }
    // Work goes batch by batch in buffers of the same sizes. Giving them back to the system in between would cost as much
    // in page faults as reading the data does.
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_ARENA_MAX, 1);

    using namespace actformer::cli;
    return run_program(argc, argv, [](CLI::App& app) {
        add_devices(app);
        add_synth(app);
        add_ingest(app);
        add_inspect(app);
        add_export(app);
        for (const auto& sub : subprograms) app.add_subcommand(sub.command, sub.description);
        add_features(app);
        add_bench(app);
    });
}
