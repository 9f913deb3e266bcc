// --version, man pages and completions.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

bool there_is(const std::string& tool) {
    return run_command("command -v " + tool).exit == 0;
}

/// What bash offers for the line before the cursor.
std::string completed(const std::string& line) {
    return run_command("bash -c 'source <(" + program() + " completion bash); COMP_WORDS=(" + line +
                       "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _actformer; echo \"${COMPREPLY[@]}\"'")
        .output;
}

struct Man : testing::Test {
    static void SetUpTestSuite() {
        dir = new TempDir;
        made = run_actformer("man -o " + (*dir / "man1").string());
    }
    static void TearDownTestSuite() { delete dir; }
    static inline TempDir* dir = nullptr;
    static inline CommandResult made;
};

}  // namespace

TEST(Version, TellsCommitCompilerAndLibraries) {
    const auto said = run_actformer("--version");
    EXPECT_EQ(said.exit, 0);
    EXPECT_TRUE(std::regex_search(
        said.output,
        std::regex(
            "^[0-9]+\\.[0-9]+\\.[0-9]+( \\(commit [0-9a-f]{7,}\\+?\\))?\nbuilt by (GCC|Clang) "
            ".+, for .+\nwith OpenCL .+, HDF5 1.+, (without libtorch|libtorch [0-9.]+ with(out)? CUDA), "
            "(without OpenCV|OpenCV [0-9.]+)\n$")))
        << said.output;
    if (fs::exists(program() + "-train")) {
        EXPECT_NE(said.output.find(", libtorch "), std::string::npos);
    }
}

TEST_F(Man, HasAPageOfEveryCommand) {
    ASSERT_EQ(made.exit, 0) << made.output;
    std::size_t pages = 0;
    for (const auto& page : fs::directory_iterator(*dir / "man1")) {
        ++pages;
        const auto text = read_file(page);
        EXPECT_EQ(text.rfind(".TH ", 0), 0U) << page;
        for (const auto* section : {"\n.SH NAME\n", "\n.SH SYNOPSIS\n", "\n.SH OPTIONS\n"})
            EXPECT_NE(text.find(section), std::string::npos) << page << section;
    }
    EXPECT_GT(pages, 25U);
    for (const auto* name :
         {"actformer", "actformer-synth-ntu", "actformer-ingest-bvh", "actformer-render", "actformer-bench"})
        EXPECT_TRUE(fs::exists(*dir / "man1" / (std::string(name) + ".1"))) << name;
    EXPECT_FALSE(fs::exists(*dir / "man1/actformer-man.1")) << "hidden";
    if (!fs::exists(program() + "-train")) return;
    for (const auto* name : {"actformer-train-generator", "actformer-model", "actformer-bench-train"})
        EXPECT_TRUE(fs::exists(*dir / "man1" / (std::string(name) + ".1"))) << name;
}

// `ingest bvh walks/ -o walks` says that walks is there already.
TEST_F(Man, NoExampleOfIngestWritesWhereItReads) {
    const std::regex onto_itself(
        R"(actformer ingest [a-z0-9]+ (?:[^&\n]* )?([^ &\n]+?)/? (?:[^&\n]* )?-o \1[ \n])");
    std::size_t examples = 0;
    for (const auto& page : fs::directory_iterator(*dir / "man1")) {
        const auto text = std::regex_replace(read_file(page), std::regex(R"(\\)"), "");
        examples += text.find("actformer ingest ") != std::string::npos;
        std::smatch found;
        EXPECT_FALSE(std::regex_search(text, found, onto_itself)) << page << ": " << found.str();
    }
    EXPECT_GT(examples, 8U);
}

TEST_F(Man, GroffFindsNothingWrong) {
    if (!there_is("groff")) GTEST_SKIP() << "no groff";
    const auto warnings =
        run_command("cd " + (*dir / "man1").string() + " && groff -Kutf8 -man -ww -z -Tutf8 *.1");
    EXPECT_EQ(warnings.output, "");
}

TEST_F(Man, SaysWhatHelpSays) {
    if (!there_is("groff")) GTEST_SKIP() << "no groff";
    const auto page = run_command("groff -Kutf8 -man -Tascii -P-cbou -rLL=1000n " +
                                  (*dir / "man1/actformer-ingest-bvh.1").string())
                          .output;
    const auto help = run_actformer("ingest bvh --help").output;
    // A line of an option that holds quotes, braces and dots, and an example with a backslash.
    for (const std::string line :
         {"What file names say: {action}, other {field}s, {*} for the rest; folders too: {action}/{index}",
          "actformer ingest bvh bnr2.tar.xz -o bnr-10 --name 'dataset-2_{action}_{style}_{index}' \\"}) {
        EXPECT_NE(help.find(line), std::string::npos) << help;
        EXPECT_NE(page.find(line), std::string::npos) << page;
    }
    EXPECT_NE(page.find("-o, --out DIR REQUIRED"), std::string::npos) << page;
}

TEST(Completion, OfBashIsWellFormed) {
    const auto check = run_command("bash -c 'bash -n <(" + program() + " completion bash)'");
    EXPECT_EQ(check.exit, 0) << check.output;
    EXPECT_EQ(check.output, "");
}

TEST(Completion, OfBashCompletesCommandsOptionsAndValues) {
    EXPECT_EQ(completed("actformer ing"), "ingest\n");
    EXPECT_EQ(completed("actformer ingest human"), "humanact12\n");
    EXPECT_EQ(completed("actformer synth ntu --cl"), "--clips\n");
    EXPECT_EQ(completed("actformer ingest bvh raw --positions i"), "ignore\n");
    EXPECT_EQ(completed("actformer completion z"), "zsh\n");
    EXPECT_EQ(completed("actformer export m.h5 -o walks --format g"), "glb\n");
    if (fs::exists(program() + "-train")) {
        EXPECT_EQ(completed("actformer train gen"), "generator\n");
        EXPECT_EQ(completed("actformer train generator -c actformer-b"), "actformer-bnr10\n");
        EXPECT_EQ(completed("actformer bench tr"), "train\n");
    }
}

TEST(Completion, OfBashOffersFilesElsewhere) {
    const TempDir dir;
    write_file(dir / "a file.h5", "");
    EXPECT_EQ(completed("actformer render " + dir.path().string() + "/a"), (dir / "a file.h5\n").string());
}

TEST(Completion, OfZshIsWellFormedAndKnowsCommands) {
    if (!there_is("zsh")) GTEST_SKIP() << "no zsh";
    const TempDir dir;
    write_file(dir / "_actformer", run_actformer("completion zsh").output);
    EXPECT_EQ(read_file(dir / "_actformer").rfind("#compdef actformer\n", 0), 0U);
    EXPECT_EQ(run_command("zsh -n " + (dir / "_actformer").string()).output, "");
    // _describe and compadd, which only work at a prompt, print what they are given.
    const auto offered =
        run_command("zsh -fc 'compdef() { }; _describe() { print -l -- ${(P)2} }; source " +
                    (dir / "_actformer").string() + "; words=(actformer ingest hu); CURRENT=3; _actformer'");
    EXPECT_NE(offered.output.find("humanact12:"), std::string::npos) << offered.output;
}

TEST(Completion, OfFishIsWellFormedAndCompletes) {
    if (!there_is("fish")) GTEST_SKIP() << "no fish";
    const TempDir dir;
    write_file(dir / "actformer.fish", run_actformer("completion fish").output);
    const auto in_fish = [&](const std::string& words) {
        return run_command("HOME=" + dir.path().string() + " fish --no-config -c 'source " +
                           (dir / "actformer.fish").string() + "; complete -C \"" + words + "\"'")
            .output;
    };
    EXPECT_EQ(run_command("fish --no-execute " + (dir / "actformer.fish").string()).output, "");
    EXPECT_EQ(in_fish("actformer ing").rfind("ingest\t", 0), 0U) << in_fish("actformer ing");
    EXPECT_EQ(in_fish("actformer ingest human").rfind("humanact12\t", 0), 0U);
    EXPECT_EQ(in_fish("actformer ingest bvh --positions ig").rfind("ignore", 0), 0U);
}

TEST(Completion, KnowsItsShells) {
    expect_refused(run_actformer("completion tcsh"), {"tcsh", "bash"});
}
