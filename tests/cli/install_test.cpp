// What `cmake --install` leaves, moved elsewhere and used in an empty folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <vector>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

/// Of Markdown pages; those to other machines aside.
void expect_links_lead_somewhere(const std::vector<fs::path>& pages) {
    const std::regex link(R"(\]\(([^)#:\s]+)(#[^)]*)?\))");
    for (const auto& page : pages) {
        const auto text = read_file(page);
        EXPECT_NE(text, "") << page;
        for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at)
            EXPECT_TRUE(fs::exists(page.parent_path() / at->str(1))) << page << ": " << at->str(1);
    }
}

}  // namespace

TEST(Install, WorksWhereverItIsMovedTo) {
    const TempDir dir;
    const auto build = fs::path(program()).parent_path().string();
    const auto made = run_command("cmake --install " + build + " --prefix " + (dir / "prefix").string());
    ASSERT_EQ(made.exit, 0) << made.output;
    fs::create_directories(dir / "some where");
    fs::rename(dir / "prefix", dir / "some where/else");
    fs::create_directory(dir / "empty");
    const auto root = dir / "some where/else";
    for (const auto* file :
         {"share/man/man1/actformer-ingest-ntu.1", "share/bash-completion/completions/actformer",
          "share/zsh/site-functions/_actformer", "share/fish/vendor_completions.d/actformer.fish",
          "share/doc/actformer/README.md", "share/actformer/model/configs/actformer-small.yaml",
          "share/actformer/reports/sweeps/mini.yaml"})
        EXPECT_TRUE(fs::is_regular_file(root / file)) << file;
    const auto here = [&](const std::string& words) {
        return run_command("cd " + (dir / "empty").string() + " && PATH='" + (root / "bin").string() +
                           "':$PATH && actformer " + words);
    };
    const auto docs = root / "share/doc/actformer";
    expect_links_lead_somewhere(
        {docs / "README.md", docs / "examples/cmu/README.md", docs / "weights/cmu/README.md"});
    const auto cmu = here("ingest bvh examples/cmu/cmu.tar.xz -o cmu --name '{part}/{action}/{*}'");
    EXPECT_EQ(cmu.exit, 0) << cmu.output;
    EXPECT_EQ(here("synth ntu -o raw --clips 6 --actions 9,10").exit, 0);
    EXPECT_EQ(here("ingest ntu raw -o ntu").exit, 0);
    const auto picture = here("render ntu/ntu-1p --count 1 -o sheet.png");
    EXPECT_EQ(picture.exit, 0) << picture.output;
    const auto plan = here("sweep mini -o mini --dry-run");
    EXPECT_EQ(plan.exit, 0) << plan.output;
    EXPECT_NE(plan.output.find((root / "share/actformer/model/configs/").string()), std::string::npos)
        << "its own configurations: " << plan.output;
    if (!fs::exists(program() + "-train")) return;
    const auto layers = here("model recogniser-small.yaml --data ntu/ntu-1p");
    EXPECT_EQ(layers.exit, 0) << layers.output;
    EXPECT_NE(here("train --help").output.find("generator"), std::string::npos);
}
