// `actformer compare`: differences seed by seed, against plain sums over what `score` wrote.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/command.hpp"
#include "tests/support/odd_split.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer::test;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

/// A recogniser and two generators of the toy dataset, barely trained.
struct Compare : testing::Test {
    void SetUp() override {
        if (!fs::exists(program() + "-train")) GTEST_SKIP() << "built without libtorch";
        write_file(dir / "r.yaml",
                   "model: recogniser\nwidth: 0.1\nframes: 20\nbatch: 16\nepochs: 1\ntrain_split: s/train\n");
        write_file(dir / "g.yaml",
                   "model: actformer\nframes: 20\nwidth: 16\nheads: 2\ndepth: 1\nlatent: 8\nd_width: 4\n"
                   "batch: 16\nepochs: 1\ntrain_split: s/train\n");
        train("recogniser -c " + at("r.yaml") + " -o " + at("r"));
        train("generator -c " + at("g.yaml") + " -o " + at("one"));
        train("generator -c " + at("g.yaml") + " -o " + at("other") + " seed=1");
    }
    void train(const std::string& words) const {
        const auto result = run_actformer("train " + words + " --data " + toy().string());
        ASSERT_EQ(result.exit, 0) << result.output;
    }
    CommandResult compare(const std::string& a, const std::string& b, const std::string& out,
                          const std::string& more = "") const {
        return run_actformer("compare " + at(a) + " " + at(b) + " --recogniser " + at("r") + " --real " +
                             toy().string() + " --split s/train --window 20 --per-class 3 --repeats 3 -o " +
                             at(out) + more);
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }

    TempDir dir;
};

Json json_in(const std::string& text) {
    return Json::parse(text.substr(text.find("\n{") + 1));
}

}  // namespace

TEST_F(Compare, TakesDifferencesSeedBySeed) {
    const auto result = compare("one/weights-last.h5", "other/weights-last.h5", "out", " --json");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto rows = Json::parse(read_file(dir / "out/results.json"))["rows"];
    EXPECT_EQ(rows[0]["name"], "A, weights-last.h5 of one")
        << "files of one name are told apart by their folders";
    EXPECT_EQ(rows[1]["name"], "B, weights-last.h5 of other");
    const auto repeats = [&](std::size_t row) {
        const auto scores = rows[row]["runs"][0]["scores"].get<std::string>();
        return Json::parse(read_file(dir / "out" / scores))["fid_whole"]["repeats"]
            .get<std::vector<double>>();
    };
    const auto a = repeats(0), b = repeats(1);
    ASSERT_EQ(a.size(), 3U);
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < 3; ++i) mean += (b[i] - a[i]) / 3;
    for (std::size_t i = 0; i < 3; ++i) squares += std::pow(b[i] - a[i] - mean, 2) / 2;
    const auto json = json_in(result.output);
    EXPECT_EQ(json["a"], at("one/weights-last.h5"));
    EXPECT_EQ(json["b"], at("other/weights-last.h5"));
    EXPECT_EQ(json["recogniser"], at("r"));
    EXPECT_EQ(json["real"], toy().string());
    EXPECT_EQ(json["split"], "s/train");
    EXPECT_EQ(json["repeats"], 3);
    const auto found = json["metrics"]["fid_whole"];
    // Student's quantile for two degrees of freedom is 4.30265; scores keep all digits.
    const double half = 4.30265 * std::sqrt(squares / 3);
    EXPECT_NEAR(found["difference"]["mean"], mean, 1e-9 * std::abs(mean));
    EXPECT_NEAR(found["difference"]["ci95"], half, 1e-5 * half);
    EXPECT_EQ(found["better"], std::abs(mean) <= half ? Json() : Json(mean < 0 ? "b" : "a"));

    const auto report = run_actformer("report " + at("out") + " --json");
    const auto first = Json::parse(report.output.substr(report.output.find('{')))["tables"][0];
    EXPECT_EQ(first["title"], "Comparison in out");
    EXPECT_EQ(first["rows"][1]["name"], "B, weights-last.h5 of other");
    EXPECT_NE(read_file(dir / "out/report.html").find("B, weights-last.h5 of other"), std::string::npos);
}

TEST_F(Compare, StaysOutOfOtherFolders) {
    const auto before = read_file(dir / "one/config.yaml");
    expect_refused(compare("one", "other", "one"), {"/one: holds a training", "another -o"});
    write_file(dir / "data/dataset.json", "{}");
    expect_refused(compare("one", "other", "data"), {"/data: holds a dataset", "another -o"});
    write_file(dir / "swept/results.json", "{\"format\": 1, \"sweep\": \"mini\", \"rows\": []}");
    expect_refused(compare("one", "other", "swept"), {"/swept: holds the sweep 'mini'", "another -o"});
    write_file(dir / "mine/report.html", "mine");
    expect_refused(compare("one", "other", "mine"), {"/mine: holds a report.html", "another -o"});
    for (const auto* name : {"mine/jobs", "one/jobs", "one/results.json", "data/results.json", "swept/jobs"})
        EXPECT_FALSE(fs::exists(dir / name)) << name;
}

TEST_F(Compare, TwoOfThemStandInOneReport) {
    for (const auto* out : {"first", "second"}) ASSERT_EQ(compare("one", "other", out).exit, 0);
    const auto report =
        run_actformer("report " + at("first") + " " + at("second") + " -o " + at("both.html") + " --json");
    ASSERT_EQ(report.exit, 0) << report.output;
    const auto tables = Json::parse(report.output.substr(report.output.find('{')))["tables"];
    EXPECT_EQ(tables[0]["title"], "Comparison in first");
    EXPECT_EQ(tables[1]["title"], "Comparison in second");
}

TEST_F(Compare, ADeviceThatIsNotThereComesWithTheOptionToGive) {
    expect_refused(
        run_actformer("generate --generator " + at("one") + " -o " + at("m.h5") + " --device cuda:99"),
        {"device cuda:99: ", "--device cpu always works"});
    const auto training = run_actformer("train generator -c " + at("g.yaml") + " --data " + toy().string() +
                                        " -o " + at("none") + " device=cuda:99");
    EXPECT_EQ(training.exit, 1);
    EXPECT_NE(training.output.find("device=cpu always works"), std::string::npos) << training.output;
}

TEST_F(Compare, AGeneratorIsNoBetterThanItself) {
    const auto result = compare("one", "one/weights-last.h5", "out");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("no difference shown"), std::string::npos) << result.output;
    EXPECT_EQ(result.output.find(" is better"), std::string::npos) << result.output;
    const auto before_a_score = result.output.substr(0, result.output.find("[3/"));
    EXPECT_EQ(before_a_score.find(" left\n"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("warning: fewer than 50 samples on a side"), std::string::npos)
        << result.output;
}

TEST_F(Compare, TakesMotionsAndSaysThatOneRepeatTellsNothingOfChance) {
    for (const auto* name : {"one", "other"})
        ASSERT_EQ(
            run_actformer("generate --generator " + at(name) + " --per-class 3 -o " + at(name) + ".h5").exit,
            0);
    expect_refused(compare("one.h5", "other.h5", "out"), {"--repeats", "motions files", "leave it out"});
    const auto result =
        run_actformer("compare " + at("one.h5") + " " + at("other.h5") + " --recogniser " + at("r") +
                      " --real " + toy().string() + " --split s/train --window 20 -o " + at("out"));
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("one repeat: chance is not told"), std::string::npos) << result.output;
    EXPECT_EQ(result.output.find(" is better"), std::string::npos) << result.output;

    copy_with_odd_split(toy(), dir / "odd");
    const auto odd = run_actformer("compare " + at("one.h5") + " " + at("other.h5") + " --recogniser " +
                                   at("r") + " --real " + at("odd") + " --split '" + odd_split +
                                   "' --window 20 --json -o " + at("of-odd"));
    ASSERT_EQ(odd.exit, 0) << odd.output;
    EXPECT_EQ(json_in(odd.output)["repeats"], 1);
    EXPECT_EQ(Json::parse(read_file(dir / "of-odd/results.json"))["rows"][0]["split"], odd_split_in_json);

    const auto mixed = compare("one", "other.h5", "mixed");
    expect_refused(mixed, {at("one") + " is a generator and " + at("other.h5") + " a motions file",
                           "two generators (trainings or weights) or two motions files"});
    EXPECT_FALSE(fs::exists(dir / "mixed"));
    const auto missing = compare("onne", "other", "missing");
    EXPECT_EQ(missing.exit, 1);
    EXPECT_EQ(lines_in(missing.output), 1) << missing.output;
    EXPECT_NE(missing.output.find("no such file or folder"), std::string::npos) << missing.output;
    EXPECT_FALSE(fs::exists(dir / "missing"));
}
