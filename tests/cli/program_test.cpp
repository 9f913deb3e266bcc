// Words that the program does not know.
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

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

TEST(Program, SaysWhatIsWrongWithOptionsThatItKnows) {
    const auto result = run_actformer("synth ntu --clips many");
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("--clips"), std::string::npos) << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1);
}
