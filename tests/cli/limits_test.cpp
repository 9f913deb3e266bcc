// Too much of something: threads, descriptors, nesting, and names that would command a terminal.
#include <gtest/gtest.h>

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
    for (const std::string command :
         {"inspect ", "features --recogniser none.h5 -o x.h5 ", "render -o x.png ",
          "synth ntu --clips 0 -o /none/", "sweep -o out ", ""}) {
        const auto result = run_actformer(command + name);
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto* raw : {"\033", "\007", "\342\200\256"})
            EXPECT_EQ(result.output.find(raw), std::string::npos) << result.output;
    }
}
