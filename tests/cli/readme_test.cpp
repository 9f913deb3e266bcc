// What the README prints works as it stands.
#include <gtest/gtest.h>

#include "tests/support/command.hpp"
#include "tests/support/skeleton_text.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;

namespace {

/// The first block of the README fenced as `language`.
std::string block(const std::string& language) {
    const auto text = read_file(source("README.md"));
    const auto begin = text.find("```" + language + "\n") + 4 + language.size();
    return text.substr(begin, text.find("```", begin) - begin);
}

}  // namespace

TEST(Readme, ItsPythonReadsAShard) {
    if (!python_has("h5py")) GTEST_SKIP() << "no h5py in /usr/bin/python3";
    const TempDir dir;
    write_file(dir / "raw/S001C001P001R001A007.skeleton", plain_clip(42));
    const auto in_dir = "cd " + dir.path().string() + " && ";
    ASSERT_EQ(run_command(in_dir + program() + " ingest ntu raw -o ntu").exit, 0);
    write_file(dir / "snippet.py", block("python"));
    EXPECT_EQ(run_command(in_dir + "/usr/bin/python3 snippet.py").output,
              "S001C001P001R001A007 6 (42, 1, 25, 3)\n");
}

TEST(Readme, ItsPipelineRuns) {
    const TempDir dir;
    // The pipeline block, with fewer clips so that a test stays quick.
    auto script = read_file(source("README.md"));
    const auto begin = script.find("actformer devices");
    script = script.substr(begin, script.find("```", begin) - begin);
    script.replace(script.find("--clips 600"), 11, "--clips 240");
    write_file(dir / "pipeline.sh", "set -e\nactformer() { " + program() + " \"$@\"; }\n" + script);
    const auto result = run_command("cd " + dir.path().string() + " && bash pipeline.sh");
    EXPECT_EQ(result.exit, 0) << result.output;
    EXPECT_GT(std::filesystem::file_size(dir / "hands.gif"), 10000U);
    EXPECT_TRUE(std::filesystem::exists(dir / "xsub-train.h5"));
}
