// Configurations and sweeps that come with the program, by name.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;

namespace {

struct Shipped : testing::Test {
    TempDir dir;
    CommandResult here(const std::string& words) const {
        return run_command("cd " + dir.path().string() + " && " + program() + " " + words);
    }
};

bool can_train() {
    return std::filesystem::exists(program() + "-train");
}

}  // namespace

TEST_F(Shipped, AConfigurationIsAFileOrAName) {
    if (!can_train()) GTEST_SKIP() << "built without libtorch";
    const auto full = run_actformer("model " + source("model/configs/actformer-ntu-2p.yaml")).output;
    ASSERT_NE(full.find("generator"), std::string::npos) << full;
    for (const auto* name :
         {"actformer-ntu-2p", "actformer-ntu-2p.yaml", "model/configs/actformer-ntu-2p.yaml"})
        EXPECT_EQ(here(std::string("model ") + name).output, full) << name;
    std::filesystem::create_directory(dir / "actformer-ntu-2p");
    EXPECT_EQ(here("model actformer-ntu-2p").output, full) << "a folder is no configuration";
}

TEST_F(Shipped, AFileOfTheUsersComesFirst) {
    if (!can_train()) GTEST_SKIP() << "built without libtorch";
    write_file(dir / "actformer.yaml", "model: actformer\nwidht: 3\n");
    expect_refused(here("model actformer.yaml"), {"actformer.yaml:", "'widht'", "width"});
}

TEST_F(Shipped, WhatThereIsIsListed) {
    const auto sweeps = here("sweep");
    EXPECT_EQ(sweeps.exit, 0);
    EXPECT_NE(sweeps.output.find("\nmini "), std::string::npos) << sweeps.output;
    if (!can_train()) return;
    const auto configurations = here("model");
    EXPECT_EQ(configurations.exit, 0);
    EXPECT_NE(configurations.output.find("\nrecogniser-gru "), std::string::npos) << configurations.output;
}

TEST_F(Shipped, ASweepFindsTheConfigurationsThatItNames) {
    const auto plan = here("sweep table3 -o out --dry-run");
    EXPECT_EQ(plan.exit, 1) << "its datasets are not here: " << plan.output;
    EXPECT_NE(plan.output.find("jobs cannot be done"), std::string::npos) << plan.output;
    EXPECT_EQ(plan.output.find("none of that name"), std::string::npos) << plan.output;
    write_file(dir / "mine.yaml",
               "datasets: {d: {format: ntu, clips: 4, use: ntu-1p}}\n"
               "recognisers: {r: {data: d, config: recogniser-small}}\n"
               "rows: {a: {data: d, recogniser: r, config: actformer-smal}}\n");
    const auto own = here("sweep mine.yaml -o out --dry-run");
    EXPECT_NE(own.output.find("actformer-smal: no such file, and none of that name in model/configs, which "
                              "come with the program; did you mean actformer-small?"),
              std::string::npos)
        << own.output;
}

TEST_F(Shipped, MistypedNamesGetASuggestion) {
    const auto classify = "classify m.h5 --recogniser ";
    expect_refused(here(classify + std::string("weights/cmu/recognisr.h5")),
                   {"weights/cmu/recognisr.h5: no such file", "weights/cmu/recogniser.h5?"});
    write_file(dir / "walks.h5", "");
    expect_refused(here("render wlaks.h5 -o x.png"), {"wlaks.h5: no such file", "did you mean walks.h5?"});
    expect_refused(here("export wlaks.h5 -o x.npz"), {"did you mean walks.h5?"});
    expect_refused(here(classify + std::string("wlaks.h5")), {"did you mean walks.h5?"});
    expect_refused(here("sweep mni -o out"), {"mni: no such file", "did you mean mini?"});
    write_file(dir / "my-sweep.yaml", "");
    expect_refused(here("sweep my-sweeep.yaml -o out"), {"did you mean my-sweep.yaml?"});
    std::filesystem::create_directory(dir / "folder");
    expect_refused(here("sweep folder -o out"), {"folder: not a file"});
}
