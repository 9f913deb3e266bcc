// Too much of something: threads, descriptors, nesting, and names that would command a terminal.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;

namespace {

struct Limits : testing::Test {
    std::string at(const std::string& name) const { return (dir / name).string(); }
    TempDir dir;
};

const std::string deep(200'000, '[');

}  // namespace

TEST_F(Limits, NumbersOfThreadsAreBounded) {
    for (const std::string command :
         {"ingest ntu raw -o out", "synth ntu -o raw", "synth uestc -o raw", "bench ingest"})
        expect_refused(run_actformer(command + " --threads 4294967295"), {"--threads", "1024"});
}

TEST_F(Limits, DescriptorsThatCannotBeHadAreALine) {
    const auto raw = at("raw");
    ASSERT_EQ(run_actformer("synth ntu --clips 1 -o " + raw).exit, 0);
    expect_refused(
        run_command("exec 3>&-; ulimit -n 4; " + program() + " ingest ntu " + raw + " -o " + at("out")),
        {"no OpenCL device", "ulimit -n"});
}

// OpenBLAS asks for a buffer again without end where it gets none, and waits for its threads that do at the program's end; libtorch's
// libraries throw while they are loaded. OpenBLAS is loaded last where it is told what the processor is.
TEST_F(Limits, GeneratingInLittleMemoryIsRightOrALine) {
    if (!std::filesystem::exists(program() + "-train")) GTEST_SKIP() << "there is no libtorch";
    const auto generate = [&](const std::string& limit, const std::string& out) {
        return run_command(limit + "OMP_NUM_THREADS=2 timeout -s KILL 100 " + program() +
                           " generate --generator " + source("weights/cmu/actformer.h5") +
                           " --per-class 1 --classes 1 --seed 3 -o " + at(out));
    };
    const auto whole = generate("", "whole.h5");
    ASSERT_EQ(whole.exit, 0) << whole.output;
    const auto check = [&](int mebibytes, const std::string& setting) {
        const auto limit = fmt::format("ulimit -v {}; {} ", mebibytes * 1024, setting);
        const auto limited = generate(limit, "limited.h5");
        SCOPED_TRACE(limit + limited.output);
        EXPECT_EQ(lines_in(limited.output), 1);
        const bool made = std::filesystem::exists(dir / "limited.h5");
        EXPECT_EQ(made, limited.exit == 0);
        if (!made) {
            EXPECT_EQ(limited.exit, 1);
            EXPECT_TRUE(limited.output.starts_with("actformer: "));
        } else if (setting.empty()) {
            EXPECT_TRUE(read_file(dir / "limited.h5") == read_file(dir / "whole.h5"));
        }
        std::filesystem::remove(dir / "limited.h5");
    };
    for (const int mebibytes : {100, 600, 690, 720, 800, 880, 920, 1200}) check(mebibytes, "");
    for (const int mebibytes : {600, 660}) check(mebibytes, "OPENBLAS_CORETYPE=Nehalem");
    EXPECT_EQ(generate("ulimit -v 4194304; ", "limited.h5").exit, 0);
}

TEST_F(Limits, NestingIsBounded) {
    write_file(dir / "sweep/results.json", "{\"format\": 1,\n\"rows\": [{\"settings\": {\"a\": " + deep);
    expect_refused(run_actformer("report " + at("sweep") + " -o " + at("report.html")),
                   {"sweep/results.json", "line 2", "64 deep"});
    write_file(dir / "data/dataset.json", "\n\n" + deep);
    expect_refused(run_actformer("inspect " + at("data")), {"data/dataset.json", "line 3", "64 deep"});
    write_file(dir / "sweep.yaml", "rows:\n  - {name: a, set: {a: " + deep);
    expect_refused(run_actformer("sweep " + at("sweep.yaml") + " -o " + at("out")),
                   {"sweep.yaml", "line 2", "deep"});
}

TEST_F(Limits, NamesDoNotCommandTheTerminal) {
    const auto name = "\"$(printf 'a\\033]0;title\\007\\nactformer: done\\342\\200\\256')\"";
    const auto file = at("file");  // below which nothing can be made
    write_file(file, "");
    for (const auto& command :
         std::vector<std::string>{"inspect ", "features -o x.h5 motions.h5 --recogniser ", "render -o x.png ",
                                  "synth ntu --clips 1 -o " + file + "/", "sweep -o out ", ""}) {
        const auto result = run_actformer(command + name);
        EXPECT_NE(result.output.find("a\\x1B]0;title\\x07\\x0Aactformer: done\\xE2\\x80\\xAE"),
                  std::string::npos)
            << command << result.output;
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto* raw : {"\033", "\007", "\342\200\256"})
            EXPECT_EQ(result.output.find(raw), std::string::npos) << result.output;
    }
}

TEST_F(Limits, NamesOfAnyBytesAreAsciiInJson) {
    const auto name = "\"$(printf 'a\\377\\233\\342\\200\\256')\"";
    const auto result = run_actformer("synth ntu --clips 1 --json -o " + (dir / "").string() + name);
    EXPECT_EQ(result.exit, 0) << result.output;
    EXPECT_TRUE(nlohmann::json::accept(result.output)) << result.output;
    EXPECT_TRUE(std::ranges::all_of(result.output, [](char c) { return c > 0; })) << result.output;
}
