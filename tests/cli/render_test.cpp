// `actformer render` as its users meet it: which motions it takes.
#include <gtest/gtest.h>

#include "cli/format.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/turning_motion.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

struct Render : testing::Test {
    TempDir dir;
    CommandResult render(const std::string& arguments) const { return drawn("--columns 1 " + arguments); }
    CommandResult drawn(const std::string& arguments, const std::string& picture = "sheet.png") const {
        return run_actformer("render " + toy().string() + " --size 40 -o " + (dir / picture).string() + " " +
                             arguments);
    }
};

}  // namespace

// Split s/two has classes 1 (c0) and 2 (c1), and not 3 (c2).
TEST_F(Render, CountsClassesFromOneOrTakesTheirNames) {
    for (const auto* said : {"1", "2", "A002", "c0", "C1", "' C1 '"})
        EXPECT_EQ(render("--count 1 --split s/two --class " + std::string(said)).exit, 0) << said;
    expect_refused(render("--split s/two --class 3"), {"no motion of class '3'"});
    expect_refused(render("--class 0"), {toy().string(), "no class 0", "from 1 to 3 ('c0' .. 'c2')"});
    expect_refused(render("--class 4"), {"no class 4", "from 1 to 3"});
    expect_refused(render("--class c"), {"no class 'c'"});
    expect_refused(render("--class \" c0l\""), {"no class 'c0l'; did you mean 'c0'?"});
}

TEST_F(Render, TakesClassesOfAMotionsFileFromTheDatasetBesideIt) {
    const auto motions = (dir / "motions.h5").string();
    ASSERT_EQ(run_actformer("export " + toy().string() + " --split s/two -o " + motions).exit, 0);
    const auto of_file = [&](const std::string& said) {
        return run_actformer("render " + motions + " --bones " + toy().string() + " --size 40 --count 1 -o " +
                             (dir / "m.png").string() + " --class " + said);
    };
    EXPECT_EQ(of_file("c1").exit, 0) << of_file("c1").output;
    EXPECT_EQ(of_file("2").exit, 0);
    expect_refused(of_file("3"), {"no motion of class '3'"});
    expect_refused(of_file("cl1"), {motions, "did you mean 'c1'?"});
}

TEST_F(Render, SaysOfHowManyMotionsItDrewSome) {
    const auto says = [](const CommandResult& result, const std::string& words) {
        EXPECT_EQ(result.exit, 0) << result.output;
        EXPECT_NE(result.output.find("sheet.png: " + words), std::string::npos) << result.output;
    };
    says(render("--split s/test --count 1"), "1 of 12 motions (--count, --per-class), ");
    says(render("--split s/test --class c0 --per-class 3"), "3 of 4 motions (--count, --per-class), ");
    says(render("--clip c0_a_1"), "1 motion, ");
}

TEST_F(Render, RefusesOptionsWithoutEffect) {
    expect_refused(drawn("--fps 10"), {"--fps: is for a .gif or .mp4", "leave it out"});
    expect_refused(drawn("--columns 3", "a.gif"), {"--columns: is for a contact sheet (.png); leave it out"});
    expect_refused(drawn("--count 5 --per-class 2"), {"--count: --per-class says how many", "leave it out"});
    for (const std::string option : {"--count 3", "--per-class 2", "--class c0", "--split s/test"})
        expect_refused(drawn("--clip c0_a_1 " + option),
                       {option.substr(0, option.find(' ')) + ": --clip names the motions; leave it out"});
    expect_refused(drawn("--clip c0_a_1 --clip c0_a_1"), {"--clip: c0_a_1 is given twice"});
    expect_refused(drawn("--fps nan", "a.gif"), {"--fps: 'nan' is not a number from 0.1 to 1000"});
    EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
    EXPECT_EQ(drawn("--clip c0_a_1 --fps 10", "a.gif").exit, 0);
}

TEST_F(Render, TellsSizesAsOtherCommandsDo) {
    const auto sheet = drawn("--count 2");
    ASSERT_EQ(sheet.exit, 0) << sheet.output;
    EXPECT_NE(sheet.output.find(", " + cli::bytes(std::filesystem::file_size(dir / "sheet.png")) + "\n"),
              std::string::npos)
        << sheet.output;
}

TEST_F(Render, ABodyIsDrawnOnRotations) {
    write_body(dir / "body.npz", made_body());
    write_turning_motion(dir / "walk.h5");
    const auto with = [&](const std::string& body, const std::string& picture) {
        return run_actformer("render " + (dir / "walk.h5").string() + body + " --size 60 --columns 2 -o " +
                             (dir / picture).string());
    };
    ASSERT_EQ(with("", "limbs.png").exit, 0);
    const auto drawn = with(" --body " + (dir / "body.npz").string(), "body.png");
    ASSERT_EQ(drawn.exit, 0) << drawn.output;
    EXPECT_NE(read_file(dir / "limbs.png"), read_file(dir / "body.png"));
    expect_refused(with(" --body " + (dir / "walk.h5").string(), "none.png"), {"walk.h5", "not a pickle"});
    EXPECT_FALSE(std::filesystem::exists(dir / "none.png"));
    expect_refused(render("--body " + (dir / "body.npz").string()),
                   {"where a body model takes rot6d of SMPL's 24"});
}
