// A small sweep, and a shell script in place of the program that it runs.
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::test {

/// Notes its call (calls), OpenMP's threads (threads) and when it begins and ends (order), makes what it was asked for, and fails where the file "broken" holds a word of the call.
inline constexpr const char* stand_in =
    "#!/bin/sh\n"
    "here=$(dirname \"$0\")\n"
    "call=$*\n"
    "echo \"$call\" >> \"$here/calls\"\n"
    "echo \"${OMP_NUM_THREADS:-all}\" >> \"$here/threads\"\n"
    "echo \"begins: $call\" >> \"$here/order\"\n"
    "sleep \"$(cat \"$here/pause\" 2>/dev/null || echo 0)\"\n"
    "if [ -e \"$here/broken\" ] && echo \"$@\" | grep -q \"$(cat \"$here/broken\")\"; then\n"
    "    echo \"loading\" >&2; echo \"actformer: out of luck\" >&2; exit 1\n"
    "fi\n"
    "kind=$1\n"
    "while [ $# -gt 0 ]; do [ \"$1\" = -o ] && out=$2; shift; done\n"
    "case $kind in\n"
    "    generate) echo motions > \"$out\" ;;\n"
    "    score) echo '{\"accuracy\": {\"mean\": 0.5}}' > \"$out\" ;;\n"
    "    ingest) mkdir -p \"$out/ntu-1p\" \"$out/ntu-2p\" ;;\n"
    "    *) mkdir -p \"$out\" ;;\n"
    "esac\n"
    "echo \"ends: $call\" >> \"$here/order\"\n";

struct SweepFixture : testing::Test {
    void SetUp() override {
        write_file(dir / "actformer", stand_in);
        ::chmod((dir / "actformer").c_str(), 0755);
        write_file(dir / "r.yaml", "model: recogniser\n");
        write_file(dir / "g.yaml", "model: generator\n");
    }
    void sweep_file(const std::string& rows, const std::string& more = "") {
        write_file(
            dir / "sweep.yaml",
            "name: test\n"
            "datasets:\n"
            "  one: {clips: 60, actions: 1-4, use: ntu-1p}\n"
            "  two: {like: one, use: ntu-2p}\n"
            "recognisers:\n"
            "  one: {data: one, config: r.yaml, set: {epochs: 2}}\n"
            "base: {data: one, recogniser: one, config: g.yaml, seeds: [0], repeats: 3, set: {epochs: 5}}\n" +
                more + "rows:\n" + rows);
    }
    std::string command(const std::string& more = "") const {
        return program() + " sweep " + at("sweep.yaml") + " -o " + at("out") + " --program " +
               at("actformer") + " " + more;
    }
    CommandResult sweep(const std::string& more = "") const { return run_command(command(more)); }
    /// Scripts in place of Slurm's two programs. The first notes its calls in bin/calls, then does `submit`, and answers with their number.
    void slurm_stand_in(const std::string& submit, const std::string& queue) const {
        write_file(dir / "bin/sbatch", "#!/bin/sh\nhere=$(dirname \"$0\")\necho \"$@\" >> $here/calls\n" +
                                           submit + "\nwc -l < $here/calls\n");
        write_file(dir / "bin/squeue", "#!/bin/sh\nhere=$(dirname \"$0\")\n" + queue + "\n");
        for (const auto* name : {"sbatch", "squeue"}) ::chmod((dir / "bin" / name).c_str(), 0755);
    }
    CommandResult with_slurm(const std::string& more) const {
        return run_command("PATH=" + at("bin") + ":$PATH " + command(more));
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }
    std::vector<std::string> calls() const { return lines_of("calls"); }
    std::vector<std::string> lines_of(const std::string& name) const {
        std::vector<std::string> out;
        std::istringstream lines(read_file(dir / name));
        for (std::string line; std::getline(lines, line);) out.push_back(line);
        return out;
    }
    long calls_of(const std::string& word) const {
        const auto all = calls();
        return std::count_if(all.begin(), all.end(),
                             [&](const std::string& c) { return c.find(word) != std::string::npos; });
    }
    nlohmann::json results() const {
        return nlohmann::json::parse(read_file(dir / "out/results.json"), nullptr, false);
    }
    TempDir dir;
};

inline constexpr const char* two_rows =
    "  full: {fills: [table1/ActFormer/NTU-1P, table3/full/NTU-1P]}\n"
    "  gaussian: {like: full, set: {prior: gaussian}, fills: [table3/Gaussian prior/NTU-1P]}\n";

}  // namespace actformer::test
