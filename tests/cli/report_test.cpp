// `actformer report` on a sweep of ready motions, and the page in a real browser.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/checksum/checked_json.hpp"
#include "base/files/lock.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

/// A sweep of one dataset of two-person clips and one of single ones, whose "generated" motions are clips of other splits; made
/// once. One row fails, one has a name that means harm.
struct Swept {
    static constexpr const char* other_motions =
        " as another generator might have made it, with a name that is long.h5";
    TempDir dir;

    Swept() {
        run_actformer("synth ntu -o " + at("raw") + " --clips 80 --actions 1-4,50-52");
        run_actformer("ingest ntu " + at("raw") + " -o " + at("data"));
        for (const auto* name : {"ntu-1p", "ntu-2p"}) {
            const ingest::Dataset dataset(dir / "data" / name);
            const auto classes = static_cast<std::uint32_t>(dataset.header().classes.size());
            eval::write_stgcn_weights(dir / (std::string(name) + "-recogniser.h5"),
                                      eval::random_stgcn_weights(3 * dataset.header().persons, classes,
                                                                 eval::ntu_graph(), 0.125, 1));
            write_motions(dataset, std::string(name) + ".h5");
            write_motions(dataset, std::string(name) + other_motions, 1);
        }
        write_file(dir / "sweep.yaml", sweep_yaml());
        run_actformer("sweep " + at("sweep.yaml") + " -o " + at("out"));
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }

  private:
    /// Every clip as a motion of its class, in the public layout with the body that it belongs to; or the motion of the clip `ahead`
    /// of it.
    void write_motions(const ingest::Dataset& dataset, const std::string& file, std::size_t ahead = 0) const {
        const auto& clips = dataset.clips();
        ingest::MotionsWriter writer(dir / file);
        writer.describe(ingest::subjects_of(dataset));
        for (std::size_t i = 0; i < clips.size(); ++i)
            writer.add(fmt::format("A{:03}_{}", clips[i].label + 1, i),
                       dataset.motion((i + ahead) % clips.size()));
        writer.finish();
    }
    std::string sweep_yaml() const {
        return fmt::format(
            "name: \"<b>mini</b>\"\n"
            "datasets:\n"
            "  one: {{path: {0}/ntu-1p}}\n"
            "  two: {{path: {0}/ntu-2p}}\n"
            "recognisers:\n"
            "  one person: {{weights: {1}}}\n"
            "  two persons: {{weights: {2}}}\n"
            "base: {{data: one, recogniser: one person, motions: [{3}], split: all}}\n"
            "rows:\n"
            "  full: {{fills: [table1/ActFormer/NTU-1P, table3/full/NTU-1P]}}\n"
            "  \"</script><script>window.hostile = 1</script>\": {{fills: [table3/fixed PE/NTU-1P]}}\n"
            "  pairs: {{data: two, recogniser: two persons, single_recogniser: one person, motions: [{4}], "
            "fills: "
            "[table2/ActFormer/NTU-2P]}}\n"
            "  lost: {{motions: [nowhere.h5], fills: [table3/Gaussian prior/NTU-1P]}}\n",
            at("data"), at("ntu-1p-recogniser.h5"), at("ntu-2p-recogniser.h5"), at("ntu-1p.h5"),
            at("ntu-2p.h5"));
    }
};

const Swept& swept() {
    static const Swept once;
    return once;
}

struct ReportPage : testing::Test {
    TempDir dir;
    std::string at(const std::string& name) const { return (dir / name).string(); }
    CommandResult report(const std::string& arguments) const {
        return run_actformer("report " + swept().at("out") + " " + arguments);
    }
    CommandResult in_browser(const std::string& page, const std::string& options = "") const {
        return run_command("/usr/bin/python3 " + source("tests/reports/page/report_test.py") + " " +
                           at(page) + options);
    }
    /// What the page's scripts draw.
    nlohmann::json data_in(const std::string& page) const {
        const auto html = read_file(dir / page);
        const std::string begin = "id=\"data\">";
        const auto from = html.find(begin) + begin.size();
        return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
    }
};

}  // namespace

TEST_F(ReportPage, SameInputsGiveTheSameBytes) {
    const auto result = report("-o " + at("a.html"));
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("14 figures measured in 4 rows"), std::string::npos)
        << "6 and 3 and 5 cells: " << result.output;
    ASSERT_EQ(report("-o " + at("b.html")).exit, 0);
    EXPECT_EQ(read_file(dir / "a.html"), read_file(dir / "b.html"));
}

TEST_F(ReportPage, TablesComeInEveryForm) {
    const auto result = report("--json --csv " + at("t.csv") + " --latex " + at("t.tex") + " 2>/dev/null");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output);
    const auto& full = json["tables"][2]["rows"][3]["groups"][0];
    EXPECT_EQ(full["state"], "measured");
    EXPECT_GE(full["metrics"]["fid_mean"]["mean"].get<double>(), 0);
    EXPECT_NE(read_file(dir / "t.csv").find("table3,full,NTU-1P,accuracy,measured,"), std::string::npos);
    EXPECT_NE(read_file(dir / "t.csv").find("table3,Gaussian prior,NTU-1P,accuracy,failed,,,,0,"),
              std::string::npos);
    EXPECT_NE(read_file(dir / "t.tex").find("\nfull & "), std::string::npos);
}

TEST_F(ReportPage, NamesEveryFileThatItWrote) {
    const auto result = report("--csv " + at("t.csv") + " --latex " + at("t.tex"));
    ASSERT_EQ(result.exit, 0) << result.output;
    for (const auto* name : {"t.csv", "t.tex"})
        EXPECT_NE(result.output.find(at(name) + ": 14 figures measured in 4 rows, "), std::string::npos)
            << result.output;
}

TEST_F(ReportPage, SaysOfAnUntrainedRecogniserThatItIsNearChance) {
    const auto result = report("-o " + at("r.html") + " --json --csv " + at("t.csv") + " --latex " +
                               at("t.tex") + " 2>/dev/null");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output);
    const std::string said = json["tables"][2]["rows"][3]["groups"][0]["near_chance"];
    ASSERT_TRUE(said.starts_with("the recogniser is right on ")) << said;
    EXPECT_EQ(json["tables"][2]["rows"][0]["groups"][0]["near_chance"], "") << "this row failed";
    EXPECT_NE(read_file(dir / "r.html").find(": " + said + "</p>"), std::string::npos);
    EXPECT_NE(read_file(dir / "t.csv").find(",\"" + said + "\"\n"), std::string::npos);
    EXPECT_NE(read_file(dir / "t.tex").find("full): the recogniser is right on "), std::string::npos);
}

TEST_F(ReportPage, WhatIsMissingIsToldAndTheRestIsShown) {
    fs::copy(swept().at("out"), dir / "out", fs::copy_options::recursive);
    for (const auto& entry : fs::recursive_directory_iterator(dir / "out"))
        if (entry.path().filename() == "generated.h5")
            fs::resize_file(entry.path(), fs::file_size(entry.path()) / 2);
    const auto result = run_actformer("report " + at("out") + " -o " + at("r.html"));
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("notice: full: no features to show"), std::string::npos) << result.output;
    EXPECT_NE(read_file(dir / "r.html").find("no features to show"), std::string::npos);
}

TEST_F(ReportPage, IsWrittenAnewUntilTheSweepIsDone) {
    fs::copy(swept().at("out"), dir / "out", fs::copy_options::recursive);
    const auto results = dir / "out/results.json";
    fs::copy(results, dir / "done.json");
    auto json = nlohmann::ordered_json::parse(read_file(results));
    json["rows"][0]["status"] = json["rows"][0]["runs"][0]["status"] = "waiting";
    write_file(results, with_checksum(json).dump());
    // The first page is there before the sweep ends.
    const auto result = run_command("cd " + at("") + "; " + program() +
                                    " report out -o r.html --watch 1 & until [ -e r.html ] || ! kill -0 $!; "
                                    "do sleep 0.1; done; cp r.html first.html; "
                                    "mv done.json out/results.json; wait $!");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("8 figures measured"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("14 figures measured"), std::string::npos) << result.output;
    EXPECT_NE(read_file(dir / "first.html"), read_file(dir / "r.html"));
}

TEST_F(ReportPage, IsWrittenAnewWhileOtherSeedsOfAFailedRowRun) {
    fs::copy(swept().at("out"), dir / "out", fs::copy_options::recursive);
    const auto results = dir / "out/results.json";
    fs::copy(results, dir / "done.json");
    auto json = nlohmann::ordered_json::parse(read_file(results));
    auto& row = json["rows"][3];
    ASSERT_EQ(row["status"], "failed");
    auto other = row["runs"][0];
    other["status"] = "running";
    row["runs"].push_back(other);
    write_file(results, with_checksum(json).dump());
    const auto result = run_command("cd " + at("") + "; " + program() +
                                    " report out -o r.html --watch 1 & until [ -e r.html ] || ! kill -0 $!; "
                                    "do sleep 0.1; done; mv done.json out/results.json; wait $!");
    ASSERT_EQ(result.exit, 0) << result.output;
    const std::string written = "r.html: 14 figures measured";
    const auto first = result.output.find(written);
    ASSERT_NE(first, std::string::npos) << result.output;
    EXPECT_NE(result.output.find(written, first + 1), std::string::npos) << result.output;
}

TEST_F(ReportPage, StaysSmallHoweverManyMotions) {
    ASSERT_EQ(report("-o " + at("all.html")).exit, 0);
    ASSERT_EQ(report("-o " + at("few.html") + " --motion-megabytes 0.2").exit, 0);
    EXPECT_LT(fs::file_size(dir / "few.html") + 300'000, fs::file_size(dir / "all.html"));
}

TEST_F(ReportPage, ShowsTheCurvesOfATrainingThatGoesOn) {
    const auto training = dir / "mine";
    write_file(training / "config.yaml", "model: actor\nframes: 60  # frames a window\n");
    write_file(training / "log.jsonl",
               "{\"epoch\":1,\"loss\":2.5}\n{\"epoch\":2,\"loss\":1.25}\n{\"epoch\":2,\"accuracy\":0.5}\n");
    const auto page = [&] {
        const auto result = run_actformer("report " + at("mine") + "/ -o " + at("r.html"));
        EXPECT_EQ(result.exit, 0) << result.output;
        EXPECT_EQ(read_file(dir / "r.html").find("Table 1"), std::string::npos)
            << "no table of the paper was asked for";
        return data_in("r.html");
    };
    {
        const auto held = FileLock::if_free(training / "lock");
        EXPECT_EQ(page()["rows"][0]["status"], "waiting");
    }
    const auto row = page()["rows"][0];
    EXPECT_EQ(row["name"], "mine");
    EXPECT_EQ(row["status"], "done");
    const auto& curves = row["curves"]["generator"];
    EXPECT_EQ(curves["points"],
              nlohmann::json::parse(R"([{"epoch":1,"loss":2.5},{"epoch":2,"loss":1.25,"accuracy":50.0}])"));
    EXPECT_EQ(curves["charts"].size(), 2);
    EXPECT_TRUE(row["curves"]["recogniser"]["charts"].empty());
    write_file(training / "config.yaml", "model: gru\nepochs: 5  # of as many windows as there are clips\n");
    const auto stopped = page()["rows"][0];
    EXPECT_EQ(stopped["curves"]["recogniser"]["charts"].size(), 2);
    EXPECT_EQ(stopped["status"], "stopped");
    EXPECT_NE(stopped["why"].get<std::string>().find("epoch 2 of 5"), std::string::npos) << stopped["why"];
}

TEST_F(ReportPage, KnowsATrainingBeforeItsFirstEpochAndWhateverItIsCalled) {
    for (const auto* name : {"a/run", "b/run"}) write_file(dir / name / "config.yaml", "model: csgn\n");
    expect_refused(run_actformer("report " + at("a/run") + " -o " + at("r.html")), {"a/run", "a training"});
    const auto held = FileLock::if_free(dir / "a/run/lock"), other = FileLock::if_free(dir / "b/run/lock");
    const auto report_of = [&](const std::string& folders) {
        return run_command("cd " + at("a/run") + " && " + program() + " report " + folders + " -o " +
                           at("r.html"));
    };
    expect_refused(report_of(". ../../b/run ../run"), {"../run: given twice; name each folder once"});
    const auto result = report_of(". ../../b/run");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("r.html: curves of 2 trainings, "), std::string::npos) << result.output;
    const auto html = read_file(dir / "r.html");
    EXPECT_NE(html.find("\"name\":\"run\""), std::string::npos);
    EXPECT_NE(html.find("b/run\""), std::string::npos) << "a name that is taken becomes the path";
}

TEST_F(ReportPage, CurvesAreOfTheTrainingAndNotOfTheFolderThatOneIsIn) {
    write_file(dir / "here/log.jsonl", "{\"epoch\":1,\"loss\":123.25}\n");
    const auto result = run_command("cd " + at("here") + " && " + program() + " report " + swept().at("out") +
                                    " -o " + at("r.html"));
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(read_file(dir / "r.html").find("123.25"), std::string::npos);
}

TEST_F(ReportPage, HoldsNoEmptyTablesOfPapersThatNothingWasRunFor) {
    fs::copy(swept().at("out"), dir / "out", fs::copy_options::recursive);
    auto json = nlohmann::ordered_json::parse(read_file(dir / "out/results.json"));
    for (auto& row : json["rows"]) row["fills"] = nlohmann::json::array();
    json["tables"] = "mine: {columns: [{dataset: CMU, metrics: [FIDm]}], rows: {Mine: {}}}";
    const auto written = [&] {
        write_file(dir / "out/results.json", with_checksum(json).dump());
        return run_actformer("report " + at("out") + " -o " + at("r.html") + " --csv " + at("t.csv") +
                             " --latex " + at("t.tex"));
    };
    const auto none = written();
    ASSERT_EQ(none.exit, 0) << none.output;
    EXPECT_EQ(none.output.find(" 0 figures"), std::string::npos) << "those of all rows: " << none.output;
    EXPECT_NE(none.output.find("measured in 4 rows"), std::string::npos) << none.output;
    EXPECT_EQ(read_file(dir / "t.csv").find("table1"), std::string::npos);
    json["rows"][0]["fills"] = {"mine/Mine/CMU"};
    const auto own = written();
    EXPECT_NE(own.output.find("1 figure measured in 4 rows"), std::string::npos) << own.output;
    const auto csv = read_file(dir / "t.csv");
    EXPECT_NE(csv.find("mine,Mine,CMU,fid_mean,measured,"), std::string::npos)
        << "a heading names a metric too: " << csv;
    EXPECT_EQ(csv.find("table1"), std::string::npos);
    EXPECT_EQ(read_file(dir / "t.tex").find("ACTOR"), std::string::npos);
}

TEST_F(ReportPage, RefusesWhatIsNoSweepAndSaysWhy) {
    const auto to = " -o " + at("r.html");
    fs::create_directory(dir / "empty");
    expect_refused(run_actformer("report " + at("empty") + to),
                   {"empty", "no results.json", "actformer sweep"});
    expect_refused(run_actformer("report " + at("emtpy") + to),
                   {"emtpy: no such file or folder; did you mean " + at("empty") + "?"});
    write_file(dir / "motions.h5", "x");
    expect_refused(run_actformer("report " + at("motions.h5") + to),
                   {"motions.h5: a file; the folder of a sweep, a training or a comparison is expected"});
    write_file(dir / "cut/results.json", "{\"rows\": [");
    expect_refused(run_actformer("report " + at("cut") + " -o " + at("r.html")), {"results.json", "damaged"});
    expect_refused(report(""), {"nothing to write"});
    expect_refused(report(swept().at("out") + to), {"out: given twice; name each folder once"});
    expect_refused(report("--json --motion-megabytes nan"),
                   {"--motion-megabytes: 'nan' is not a number from 0 to 1000"});
    expect_refused(report("-o " + at("no/such/folder/r.html")), {"no/such/folder"});
    EXPECT_FALSE(fs::exists(dir / "r.html"));
}

TEST_F(ReportPage, ReplacesReportsAndNoFilesOfOthers) {
    write_file(dir / "mine", "<!doctype html> table,row,dataset,metric, Written by `actformer report`");
    fs::copy_file(swept().at("ntu-1p.h5"), dir / "motions");
    for (const auto* option : {"-o ", "--csv ", "--latex "}) {
        expect_refused(report(option + at("mine")), {"mine: is there, and holds no ", "--force"});
        expect_refused(report(option + at("motions")), {"motions: is there"});
        fs::copy_file(dir / "mine", dir / "other");
        EXPECT_EQ(report(option + at("other") + " --force").exit, 0);
        const auto made = read_file(dir / "other");
        EXPECT_EQ(report(option + at("other")).exit, 0) << "its own, now";
        EXPECT_EQ(read_file(dir / "other"), made);
        fs::remove(dir / "other");
    }
}

TEST_F(ReportPage, WorksInABrowser) {
    ASSERT_EQ(report("-o " + at("r.html")).exit, 0);
    const auto result = in_browser("r.html");
    if (result.exit == 77) GTEST_SKIP() << result.output;
    EXPECT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(result.output.find("skip:"), std::string::npos) << result.output;
}

TEST_F(ReportPage, OfAComparisonShowsBothSidesBesideRealMotions) {
    const auto& files = swept();
    const auto made = run_command(program() + " compare " + files.at("ntu-1p.h5") + " '" +
                                  files.at(std::string("ntu-1p") + Swept::other_motions) + "' --recogniser " +
                                  files.at("ntu-1p-recogniser.h5") + " --real " + files.at("data/ntu-1p") +
                                  " -o " + at("compared"));
    ASSERT_EQ(made.exit, 0) << made.output;
    ASSERT_EQ(report(at("compared") + " -o " + at("r.html")).exit, 0);
    const auto rows = data_in("r.html")["rows"];
    ASSERT_EQ(rows.size(), 6);
    for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(rows[i]["compared"].dump(), i < 4 ? "[]" : "[4,5]")
            << "the sweep's rows stand by themselves";
    const auto result = in_browser("compared/report.html", " --comparison");
    if (result.exit == 77) GTEST_SKIP() << result.output;
    EXPECT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(result.output.find("skip:"), std::string::npos) << result.output;
}
