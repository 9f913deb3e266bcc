// Words that the program does not know.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;

TEST(Program, SuggestsTheCommandThatWasMeant) {
    const struct {
        const char *typed, *answer;
    } cases[] = {
        {"sinth ntu -o x", "there is no command 'sinth'; did you mean synth? (see actformer --help)\n"},
        {"ingest nut raw -o x",
         "there is no command 'nut'; did you mean ntu? (see actformer ingest --help)\n"},
        {"bench feature",
         "there is no command 'feature'; did you mean features? (see actformer bench --help)\n"},
        {"qqqqqq", "there is no command 'qqqqqq' (see actformer --help)\n"},
        {"$'\\e[31m'", "there is no command '\\x1B[31m' (see actformer --help)\n"},
    };
    for (const auto& one : cases) {
        const auto result = run_command("bash -c " + std::string("\"") + program() + " " + one.typed + "\"");
        EXPECT_EQ(result.exit, 1) << one.typed;
        EXPECT_EQ(result.output, std::string("actformer: ") + one.answer);
    }
}

TEST(Program, SuggestsTheOptionThatWasMeant) {
    const auto result = run_actformer("synth ntu -o x --clps=3");
    EXPECT_EQ(result.exit, 1);
    EXPECT_EQ(
        result.output,
        "actformer: there is no option '--clps'; did you mean --clips? (see actformer synth ntu --help)\n");
}

TEST(Program, WithoutAWordSaysWhatToBeginWith) {
    const TempDir dir;
    const auto in = [&](const std::string& line) {
        return run_command("cd " + dir.path().string() + " && " + line);
    };
    const auto said = in(program());
    EXPECT_EQ(said.exit, 1) << "nothing was done";
    EXPECT_EQ(in(program() + " 2>/dev/null").output, "");
    EXPECT_NE(said.output.find("actformer --help"), std::string::npos) << said.output;
    std::istringstream lines(said.output);
    const std::string begins = "  actformer ";
    int commands = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(begins) || line.find(" -o ") == std::string::npos) continue;
        const auto result = in(program() + line.substr(begins.size() - 1));
        EXPECT_EQ(result.exit, 0) << line << ": " << result.output;
        ++commands;
    }
    EXPECT_EQ(commands, 1 + std::filesystem::exists(program() + "-render") +
                            std::filesystem::exists(program() + "-train"));
}

TEST(Program, MixesNoSyntheticClipsWithOthers) {
    const TempDir dir;
    const auto synth = [&](const std::string& options) {
        return run_actformer("synth ntu -o " + (dir / "raw").string() + options);
    };
    const std::string four = " --clips 4 --actions 9,10";
    ASSERT_EQ(synth(four).exit, 0);
    EXPECT_EQ(synth(four).exit, 0) << "the same call again";
    EXPECT_EQ(synth(" --clips 6 --actions 9,10").exit, 0) << "a set can grow";
    expect_refused(synth(four),
                   {"raw: holds 2 .skeleton files that these options do not make", "-o", "the --seed, the"});
    expect_refused(synth(" --clips 6 --actions 9"), {"A010.skeleton"});
    write_file(dir / "real/S001C001P001R001A009.skeleton", "1");
    expect_refused(run_actformer("synth ntu -o " + (dir / "real").string() + " --clips 6 --actions 9,10"),
                   {"real: holds 1 .skeleton file that these", "S001C001P001R001A009.skeleton"});
    EXPECT_FALSE(std::filesystem::exists(dir / "real/ORIGIN")) << "they are recorded still";
}

TEST(Program, SaysWhatIsWrongWithOptionsThatItKnows) {
    const auto result = run_actformer("synth ntu --clips many");
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("--clips"), std::string::npos) << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1);
}

TEST(Program, SaysWhichNumbersAnOptionTakes) {
    const struct {
        const char *typed, *answer;
    } cases[] = {
        {"synth ntu -o x --seed abc", "--seed: 'abc' is not a whole number from 0 (see actformer synth ntu"},
        {"synth ntu -o x --seed=-1", "--seed: '-1' is not a whole number from 0"},
        {"synth ntu -o x --clips -1", "--clips: '-1' is not a whole number from 0"},
        {"synth ntu -o x --clips 1.5", "--clips: '1.5' is not a whole number from 0"},
        {"synth ntu -o x --seed 99999999999999999999", "'99999999999999999999' is not a whole number"},
        {"synth babel -o x --clips -1", "--clips: '-1' is not a whole number from 1 to 1000000"},
        {"synth babel -o x --clips 0", "--clips: '0' is not a whole number from 1 to 1000000"},
        {"bench ingest --gigabytes 0", "--gigabytes: '0' is not a number from 0.001 to 1000"},
        {"report a --json --motion-megabytes x", "--motion-megabytes: 'x' is not a number from 0 to 1000"},
        {"report a --json --watch 0.5", "--watch: '0.5' is not a whole number from 1 to 86400"},
        {"features a --recogniser b -o c.h5 --initial-noise -1",
         "--initial-noise: '-1' is not a whole number"},
        {"ingest bvh a -o b --persons -1", "--persons: '-1' is not a whole number from 0"},
        {"ingest bvh a -o b --fps fast", "--fps: 'fast' is not a number"},
    };
    for (const auto& one : cases) expect_refused(run_actformer(one.typed), {one.answer});
}

TEST(Program, ReadsWholeNumbersInTens) {
    const TempDir dir;
    const auto result =
        run_actformer("synth ntu --clips 1 --actions 9 --seed 010 --json -o " + (dir / "raw").string());
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("\"seed\": 10"), std::string::npos) << result.output;
}

TEST(Program, SaysWhichWordIsMissingOrOneTooMany) {
    const struct {
        const char *typed, *answer;
    } cases[] = {
        {"-v", "there is no option '-v' (see actformer --help)"},
        {"synth ntu -v", "there is no option '-v' (see actformer synth ntu --help)"},
        {"synth", "no command is given; there are ntu, babel, "},
        {"synth ntu", "--out is required (see actformer synth ntu --help)"},
        {"ingest bvh", "raw, --out are required"},
        {"synth ntu -o x more", "there is no place for 'more' (see actformer synth ntu --help)"},
        {"synth ntu more", "there is no place for 'more'; --out is required"},
        {"synth ntu -o x -- -3", "there is no place for '-3'"},
        {"synth ntu -o", "--out: a value is missing (see"},
        {"synth ntu --seed", "--seed: a value is missing (a whole number from 0)"},
        {"ingest bvh -o", "--out: a value is missing (DIR)"},
        {"synth ntu -o x --seed 1 --seed 2", "--seed: given 2 times; give it once"},
        {"bench score --peer nowhere.py", "--peer: File does not exist: nowhere.py"},
    };
    for (const auto& one : cases) expect_refused(run_actformer(one.typed), {one.answer});
}

TEST(Program, RefusesEmptyValues) {
    const struct {
        const char *typed, *answer;
    } cases[] = {
        {"score -o ''",
         "--out: is empty; give a value (SCORES.json) or leave it out (see actformer score --help)"},
        {"score --out= --json", "--out: is empty; give a value (SCORES.json) or leave it out"},
        {"score --keep-features ''", "--keep-features: is empty; give a value (DIR) or leave it out"},
        {"ingest bvh a -o ''", "--out: is empty; give a value (DIR) (see actformer ingest bvh --help)"},
        {"synth ntu -o ''", "--out: is empty; give a value (see"},
        {"synth ntu -o x --actions ''", "--actions: is empty; give a value or leave it out"},
        {"synth ntu -o x --seed ''", "--seed: '' is not a whole number from 0"},
        {"inspect ''", "dataset: is empty; give a value (DATASET|MOTIONS.h5)"},
    };
    for (const auto& one : cases) expect_refused(run_actformer(one.typed), {one.answer});
}

TEST(Program, SaysWhatTheSystemSaysOfAPath) {
    const TempDir dir;
    const auto loop = (dir / "loop").string();
    std::filesystem::create_symlink("loop", loop);
    const auto result = run_actformer("inspect " + loop);
    EXPECT_EQ(result.exit, 1);
    EXPECT_EQ(result.output, "actformer: " + loop + ": Too many levels of symbolic links\n");
    expect_refused(run_command("TMPDIR=/nonexistent " + program() +
                               " score --real-features a.h5 --generated-features b.h5"),
                   {"actformer: /nonexistent: no folder for temporary files", "let TMPDIR name one"});
}

TEST(Program, RefusesAKeyOfTheConfigurationThatIsGivenTwice) {
    if (!std::filesystem::exists(program() + "-train")) GTEST_SKIP() << "built without libtorch";
    for (const auto* command : {"model recogniser-small", "train recogniser -c recogniser-small -o x",
                                "bench train --method actor"})
        expect_refused(run_actformer(std::string(command) + " width=0.3 batch=2 width=0.4"),
                       {"actformer: 'width=0.4': width is given twice\n"});
}

TEST(Program, SaysHowAKeyOfTheConfigurationIsWritten) {
    if (!std::filesystem::exists(program() + "-train")) GTEST_SKIP() << "built without libtorch";
    const std::string train = "train generator -c actformer-small -o x ";
    expect_refused(run_actformer(train + "--epochs 3"),
                   {"there is no option '--epochs'; keys of the configuration are written epochs=3 (see "
                    "actformer train generator --help)"});
    expect_refused(run_actformer(train + "--rate-drops=5"), {"are written rate_drops=5"});
    expect_refused(run_actformer(train + "--epochs batch=3"), {"are written epochs=VALUE"});
    expect_refused(run_actformer(train + "--dta toy"), {"'--dta'; keys", "did you mean --data?"});
}
