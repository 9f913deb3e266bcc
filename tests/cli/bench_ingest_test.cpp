// `actformer bench ingest` beside a reference program. How fast it is stands in no test.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;

TEST(BenchIngest, TakesNoSizeThatIsNoNumber) {
    for (const std::string option : {"motions --gigabytes", "babel --hours", "babel --many-hours"})
        expect_refused(run_actformer("bench ingest --format " + option + " nan"),
                       {": 'nan' is not a number from 0"});
}

// No shell is between: whatever a path holds arrives whole.
TEST(BenchIngest, HandsPathsToThePeerAsTheyAre) {
    const TempDir dir;
    const auto folder = dir / "it's $HOME; `x`";
    write_file(folder / "peer's.py",
               "test $# = 2 && test -d \"$1\" && case \"$1\" in \"${0%/*}\"/*) echo 10 2;; esac\n");
    const auto quoted = [&](const std::string& name) {
        return "\"" + dir.path().string() + "/it's \\$HOME; \\`x\\`" + name + "\"";
    };
    const auto result =
        run_actformer("bench ingest --clips 2 --repeats 1 --threads 1 --json --python /bin/sh --folder " +
                      quoted("") + " --peer " + quoted("/peer's.py") + " 2>/dev/null");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(nlohmann::json::parse(result.output)["peer_clips_a_second"], 5);
}
