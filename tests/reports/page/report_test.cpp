// What a report says: cells and their figures, the forms the tables come in, and the numbers packed into the page.
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "base/checksum/checked_json.hpp"
#include "base/checksum/checked_lines.hpp"
#include "base/files/lock.hpp"
#include "reports/page/curves.hpp"
#include "reports/page/exports.hpp"
#include "reports/page/html.hpp"
#include "reports/page/moving.hpp"
#include "reports/page/packed.hpp"
#include "reports/page/page.hpp"
#include "reports/page/projection.hpp"
#include "reports/page/row_tables.hpp"
#include "tests/reports/motions/made_motions.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;
using testing::error_of;
using testing::Folder;
using testing::walkers;

void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

Json scores(const std::vector<double>& accuracy, const std::vector<double>& fid) {
    return {{"accuracy", {{"mean", 0}, {"repeats", accuracy}}},
            {"fid_mean", {{"mean", 0}, {"repeats", fid}}}};
}

/// A sweep's folder with rows that tests add.
struct Report : ::testing::Test {
    Folder dir;
    Json rows = Json::array();

    /// A row of done runs, one a set of scores.
    Json& add(const std::string& name, const std::string& cell, const std::vector<Json>& all) {
        Json row{{"name", name},
                 {"status", "done"},
                 {"fills", {cell}},
                 {"dataset", "one"},
                 {"split", "xsub/train"},
                 {"data", {{"synthetic", 60}, {"seed", 1}}},
                 {"settings", {{"prior", "gp"}}},
                 {"runs", Json::array()}};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto file = name + std::to_string(i) + ".json";
            write(dir / "out" / file, all[i].dump());
            row["runs"].push_back({{"seed", i}, {"status", "done"}, {"scores", file}});
        }
        rows.push_back(row);
        return rows.back();
    }
    Measured read() {
        write(dir / "out" / "results.json",
              with_checksum(Json{{"format", 1}, {"sweep", "test"}, {"version", "0"}, {"rows", rows}}).dump());
        return read_measured({dir / "out"});
    }
};

const CellGroup& group(const std::vector<FilledTable>& tables, const std::string& name) {
    const auto cell = find_cell(name);
    return tables[static_cast<std::size_t>(cell.table - paper_tables().data())].rows[cell.row][cell.columns];
}

TEST_F(Report, ACellIsTheMeanOverSeeds) {
    add("full", "table3/full/NTU-1P", {scores({0.2, 0.4}, {1, 3}), scores({0.6}, {6}), scores({0.3}, {1})});
    auto measured = read();
    const auto tables = fill_tables(measured);
    const auto& cell = group(tables, "table3/full/NTU-1P");
    ASSERT_EQ(cell.state, CellState::measured);
    EXPECT_EQ(cell.figures[0].repeats, 4U);
    EXPECT_EQ(over_what(cell.figures[0]), "3 seeds");
    EXPECT_DOUBLE_EQ(cell.figures[0].measured->mean, 40) << "30, 60 and 30, accuracies being in per cent";
    EXPECT_DOUBLE_EQ(cell.figures[1].measured->mean, 3) << "2, 6 and 1";
    // t(0.975, 2) = 4.30265, s = sqrt(7): from any table of Student's distribution
    EXPECT_NEAR(*cell.figures[1].measured->half_width, 4.30265 * std::sqrt(7.0 / 3), 1e-4);
    EXPECT_FALSE(cell.figures[2].measured) << "FIDw is not among the scores";
    EXPECT_DOUBLE_EQ(*cell.figures[0].paper.value, 42.01);
    EXPECT_TRUE(measured.notices.empty());
}

TEST_F(Report, TellsTheRepeatsOfWhatWasMeasured) {
    const Json alone{{"fid_mean", {{"repeats", {2, 3}}}}};  // without accuracy, the table's first metric
    add("full", "table3/full/NTU-1P", {alone});
    add("fixed", "table3/fixed PE/NTU-1P", {Json{{"diversity", {{"repeats", {2, 3}}}}}});
    add("single", "table3/Gaussian prior/NTU-1P", {Json{{"fid_mean", {{"repeats", std::vector{2}}}}}});
    auto measured = read();
    const auto tables = fill_tables(measured);
    const auto lines = provenance(group(tables, "table3/full/NTU-1P"));
    ASSERT_GE(lines.size(), 3U);
    EXPECT_EQ(lines[1], "seeds 0; 2 repeats of generation and scoring");
    EXPECT_EQ(lines[2], "± over 2 repeats");
    EXPECT_EQ(provenance(group(tables, "table3/fixed PE/NTU-1P"))[1], "seeds 0") << "nothing of this table";
    EXPECT_EQ(provenance(group(tables, "table3/Gaussian prior/NTU-1P"))[1],
              "seeds 0; 1 repeat of generation and scoring");
}

TEST_F(Report, OneTrainingHasAnIntervalOverItsRepeats) {
    add("full", "table3/full/NTU-1P", {scores({0.2, 0.4, 0.6}, {1, 2, 6})});
    auto measured = read();
    const auto tables = fill_tables(measured);
    const auto& cell = group(tables, "table3/full/NTU-1P");
    EXPECT_EQ(over_what(cell.figures[0]), "3 repeats");
    EXPECT_FALSE(cell.figures[0].best) << "there is no other row";
}

TEST_F(Report, WhatChanceMayHaveMadeIsNotTheBest) {
    add("full", "table3/full/NTU-1P", {scores({0.5, 0.6, 0.7}, {4})});
    add("gaussian", "table3/Gaussian prior/NTU-1P", {scores({0.65, 0.55, 0.75}, {9})});
    auto measured = read();
    const auto tables = fill_tables(measured);
    for (const auto* row : {"full", "Gaussian prior"})
        for (const auto& figures : group(tables, "table3/" + std::string(row) + "/NTU-1P").figures)
            EXPECT_FALSE(figures.best) << row << ": intervals overlap, and one repeat has none";
}

TEST_F(Report, RepeatsArePairedBySeedAndTrainingsAreNot) {
    // The same numbers, 0.05 apart in each pair give or take 0.001, and 0.1 from one pair to the next.
    add("full", "table3/full/NTU-1P", {scores({0.5, 0.6, 0.7}, {4})});
    add("gaussian", "table3/Gaussian prior/NTU-1P", {scores({0.55, 0.651, 0.75}, {9})});
    add("two", "table4/full/NTU-2P", {scores({0.5}, {4}), scores({0.6}, {4}), scores({0.7}, {4})});
    add("average", "table4/AvgPool D/NTU-2P",
        {scores({0.55}, {9}), scores({0.651}, {9}), scores({0.75}, {9})});
    auto measured = read();
    const auto tables = fill_tables(measured);
    EXPECT_TRUE(group(tables, "table3/Gaussian prior/NTU-1P").figures[0].best)
        << "sets of motions of equal seeds";
    EXPECT_FALSE(group(tables, "table4/AvgPool D/NTU-2P").figures[0].best) << "three trainings each";
}

TEST_F(Report, TheBestOfAColumnIsTheHighestAccuracyAndTheLowestDistance) {
    add("full", "table3/full/NTU-1P", {scores({0.5, 0.51}, {4, 4.1})});
    add("gaussian", "table3/Gaussian prior/NTU-1P", {scores({0.7, 0.71}, {9, 9.1})});
    auto measured = read();
    const auto tables = fill_tables(measured);
    const auto &full = group(tables, "table3/full/NTU-1P"),
               &gaussian = group(tables, "table3/Gaussian prior/NTU-1P");
    EXPECT_FALSE(full.figures[0].best);
    EXPECT_TRUE(full.figures[1].best);
    EXPECT_TRUE(gaussian.figures[0].best);
    EXPECT_FALSE(gaussian.figures[1].best);
    EXPECT_TRUE(full.figures[0].paper_best) << "the paper's best is marked on its own";
}

TEST_F(Report, RowsThatWereScoredAgainstTheSameMotionsStandSideBySide) {
    const auto with = [](Json scored, double acceleration) {
        scored["limb_acceleration"] = {{"mean", acceleration},
                                       {"repeats", {acceleration, acceleration * 1.01}}};
        scored["real"] = {{"accuracy", 0.9}, {"limb_acceleration", 1}};
        scored["floor"] = {{"fid_mean", 0.5}};
        return scored;
    };
    add("full", "table3/full/NTU-1P", {with(scores({0.59, 0.61}, {3.1, 2.9}), 1.5)});
    add("mine", "", {with(scores({0.4, 0.41}, {9, 9.1}), 0.9)})["fills"] = Json::array();
    add("elsewhere", "", {scores({0.4}, {9})})["dataset"] = "two";
    auto by_another = scores({0.99, 0.98}, {0.1, 0.11});
    by_another["provenance"] = {{"recogniser", {{"checksum", "other"}}}};
    add("by another recogniser", "", {by_another});
    auto on_others = scores({0.99, 0.98}, {0.1, 0.11});
    on_others["provenance"] = {{"real", {{"fingerprint", "other"}}}};
    add("on other clips of that name", "", {on_others});
    add("not run", "", {})["status"] = "waiting";
    const auto measured = read();
    const RowTables tables(measured);
    ASSERT_EQ(tables.filled().size(), 4U);
    const auto& one = tables.filled()[0];
    ASSERT_EQ(one.paper->columns[0].metrics.size(), 3U) << "accuracy, FIDm and acceleration";
    ASSERT_EQ(one.rows.size(), 3U) << "two rows and real motions";
    const auto figures = [&](std::size_t row, std::size_t metric) {
        return one.rows[row][0].figures[metric];
    };
    EXPECT_DOUBLE_EQ(figures(0, 0).measured->mean, 60);
    EXPECT_DOUBLE_EQ(figures(2, 0).measured->mean, 90) << "real motions, in per cent";
    EXPECT_DOUBLE_EQ(figures(2, 1).measured->mean, 0.5) << "real against real";
    EXPECT_TRUE(figures(0, 0).best && figures(0, 1).best && figures(1, 2).best);
    EXPECT_FALSE(figures(2, 0).best || figures(2, 1).best || figures(2, 2).best);
    EXPECT_EQ(tables.filled()[1].rows.size(), 2U);
    const auto html = html_tables(tables.filled());
    EXPECT_NE(html.find("Rows on one"), std::string::npos);
    EXPECT_NE(html.find("limb acceleration"), std::string::npos);
    EXPECT_NE(to_csv(tables.filled()).find("\nrows1,real motions,one,fid_mean,measured,0.5,,,0,,,,\n"),
              std::string::npos);
    EXPECT_NE(to_latex(tables.filled()).find("real motions & 90.00 & 0.50"), std::string::npos);
}

TEST_F(Report, WhatShouldBeNearRealIsMarkedByItsDistanceFromReal) {
    const std::vector<PaperTable> papers{
        read_table("title: Table 9\n"
                   "caption: c\n"
                   "source: s\n"
                   "order: 9\n"
                   "columns: [{dataset: A, metrics: [diversity, accuracy]}]\n"
                   "real: real\n"
                   "rows:\n"
                   "  real: {A: [7.0, 99.8]}\n"
                   "  near: {A: [6.9, 90]}\n"
                   "  far: {A: [7.5, 95 ± 0.5]}\n"
                   "  lost: {A: not at hand}\n",
                   "table9.yaml")};
    const auto run = [](double diversity, double real) {
        return Json{{"diversity", {{"mean", 0}, {"repeats", {diversity, diversity + 0.01}}}},
                    {"real", {{"diversity", real}}}};
    };
    add("near", "table9/near/A", {run(9, 8)});
    add("far", "table9/far/A", {run(6.5, 7)});
    auto measured = read();
    measured.tables = papers;
    const auto tables = fill_tables(measured);
    const auto figures = [&](std::size_t row, std::size_t metric) {
        return tables[0].rows[row][0].figures[metric];
    };
    EXPECT_TRUE(figures(1, 0).paper_best) << "0.1 from the paper's real motions";
    EXPECT_FALSE(figures(2, 0).paper_best || figures(0, 0).paper_best);
    EXPECT_TRUE(figures(2, 0).best) << "0.5 from the real motions that it was scored with";
    EXPECT_FALSE(figures(1, 0).best) << "1 from them";
    EXPECT_TRUE(figures(2, 1).paper_best) << "real motions do not count";
    const auto html = html_tables(tables);
    EXPECT_NE(html.find("nearest to real motions is best\">→"), std::string::npos);
    EXPECT_NE(html.find(">not at hand<"), std::string::npos);
    EXPECT_NE(html.find(">95.00 ± 0.50<"), std::string::npos);
    const auto csv = to_csv(tables);
    EXPECT_NE(csv.find("\ntable9,far,A,accuracy,not measured,,,,0,95,0.5,,\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\ntable9,lost,A,diversity,not run,,,,0,not at hand,,,\n"), std::string::npos) << csv;
    EXPECT_NE(to_latex(tables).find("diversity $\\rightarrow$"), std::string::npos);
}

TEST_F(Report, NothingOfThePapersIsEverTakenForMeasured) {
    auto measured = read();
    const auto tables = fill_tables(measured);
    ASSERT_EQ(tables.size(), 5U);
    for (const auto& table : tables)
        for (const auto& row : table.rows)
            for (const auto& one : row) {
                EXPECT_EQ(one.state, CellState::not_run);
                for (const auto& figures : one.figures) EXPECT_FALSE(figures.measured || figures.best);
            }
    const auto html = html_tables(tables);
    EXPECT_EQ(html.find("class=\"value\""), std::string::npos);
    EXPECT_NE(html.find("not run"), std::string::npos);
    EXPECT_EQ(to_latex(tables).find("42.01"), std::string::npos);
}

TEST_F(Report, SaysWhatFailedAndWhatIsNotFinished) {
    rows.push_back(
        {{"name", "a"}, {"status", "failed"}, {"why", "no <space> left"}, {"fills", {"table3/full/NTU-1P"}}});
    rows.push_back({{"name", "b"}, {"status", "waiting"}, {"fills", {"table3/fixed PE/NTU-1P"}}});
    auto measured = read();
    const auto html = html_tables(fill_tables(measured));
    EXPECT_NE(html.find(">failed<"), std::string::npos);
    EXPECT_NE(html.find("no &lt;space&gt; left"), std::string::npos);
    EXPECT_NE(html.find("not finished"), std::string::npos);
}

TEST_F(Report, UnknownCellsAndCellsFilledTwiceAreTold) {
    add("first", "table3/full/NTU-1P", {scores({0.1}, {1})});
    add("second", "table3/full/NTU-1P", {scores({0.2}, {2})});
    add("third", "table9/full/NTU-1P", {scores({0.3}, {3})});
    auto measured = read();
    const auto tables = fill_tables(measured);
    EXPECT_DOUBLE_EQ(group(tables, "table3/full/NTU-1P").figures[0].measured->mean, 20);
    ASSERT_EQ(measured.notices.size(), 2U);
    EXPECT_NE(measured.notices[0].find("‘first’"), std::string::npos) << measured.notices[0];
    EXPECT_NE(measured.notices[1].find("table9"), std::string::npos) << measured.notices[1];
}

TEST_F(Report, MissingAndDamagedScoresAreToldAndTheRestStands) {
    add("full", "table3/full/NTU-1P", {scores({0.5}, {4}), scores({0.7}, {6})});
    add("gone", "table3/fixed PE/NTU-1P", {scores({0.5}, {4})});
    std::filesystem::remove(dir / "out" / "gone0.json");
    write(dir / "out" / "full1.json", "{\"accuracy\": {\"rep");
    auto measured = read();
    ASSERT_EQ(measured.notices.size(), 2U);
    EXPECT_NE(measured.notices[0].find("full1.json is damaged"), std::string::npos) << measured.notices[0];
    EXPECT_NE(measured.notices[1].find("gone0.json is missing"), std::string::npos) << measured.notices[1];
    const auto tables = fill_tables(measured);
    EXPECT_EQ(group(tables, "table3/full/NTU-1P").figures[0].repeats, 1U);
    EXPECT_EQ(group(tables, "table3/fixed PE/NTU-1P").state, CellState::waiting);
}

TEST_F(Report, ScoresOfAnotherShapeAreNoFigures) {
    add("odd", "table3/full/NTU-1P",
        {Json{{"accuracy", 7},
              {"fid_mean", {{"repeats", "many"}}},
              {"fid_whole", {{"repeats", {nullptr, "x", 2.5}}}},
              {"per_class", 3},
              {"confusion", {{1, 2}, 3}},
              {"provenance", {1}},
              {"warnings", "w"}}});
    auto measured = read();
    const auto tables = fill_tables(measured);
    const auto& cell = group(tables, "table3/full/NTU-1P");
    EXPECT_FALSE(cell.figures[0].measured || cell.figures[1].measured);
    EXPECT_DOUBLE_EQ(cell.figures[2].measured->mean, 2.5);
    EXPECT_FALSE(page("t", tables, measured.notices, details(measured)).empty());
}

TEST_F(Report, RefusesWhatIsNoSweep) {
    EXPECT_NE(error_of([&] { read_measured({dir / "none"}); }).find("none: no such file or folder"),
              std::string::npos);
    std::filesystem::create_directory(dir / "empty");
    EXPECT_NE(error_of([&] { read_measured({dir / "empty"}); }).find("no results.json"), std::string::npos);
    write(dir / "motions.h5", "");
    EXPECT_NE(error_of([&] { read_measured({dir / "motions.h5"}); }).find("motions.h5: a file; the folder"),
              std::string::npos);
    write(dir / "half" / "results.json", "{\"format\": 1, \"ro");
    EXPECT_NE(error_of([&] { read_measured({dir / "half"}); }).find("damaged"), std::string::npos);
    write(dir / "later" / "results.json", "{\"format\": 2, \"rows\": []}");
    EXPECT_NE(error_of([&] { read_measured({dir / "later"}); }).find("another version"), std::string::npos);
}

TEST_F(Report, RowsKnowTheOtherSideOfTheirComparison) {
    const auto compared = [&](std::size_t count) {
        const std::vector<Json> sides(count, Json::object());
        write(dir / "two" / "results.json",
              Json{{"format", 1}, {"comparison", true}, {"rows", sides}}.dump());
        rows = Json::array({Json::object()});
        read();
        auto measured = read_measured({dir / "out", dir / "two"});
        std::vector<Json> out;
        const auto shown = details(measured);
        for (const auto& row : shown["rows"]) out.push_back(row["compared"]);
        return out;
    };
    EXPECT_EQ(compared(2), (std::vector<Json>{Json::array(), {1, 2}, {1, 2}}));
    EXPECT_EQ(compared(3000), std::vector<Json>(3001, Json::array())) << "more than anybody can look at";
}

TEST_F(Report, WhatIsNotAsItWasWrittenIsTold) {
    const auto right = with_checksum(Json{{"format", 1}, {"rows", Json::array()}});
    auto wrong = right;
    wrong["sweep"] = "another";
    write(dir / "right" / "results.json", right.dump());
    EXPECT_EQ(error_of([&] { read_measured({dir / "right"}); }), "");
    write(dir / "wrong" / "results.json", wrong.dump());
    EXPECT_NE(error_of([&] { read_measured({dir / "wrong"}); }).find("damaged"), std::string::npos);

    write(dir / "cut" / "results.json",
          Json{{"format", 1}, {"version", "0"}, {"rows", Json::array()}}.dump());
    EXPECT_NE(error_of([&] { read_measured({dir / "cut"}); }).find("damaged"), std::string::npos);

    auto changed = with_checksum(scores({0.2}, {1})), cut = scores({0.2}, {1});
    changed["accuracy"]["mean"] = 0.9;
    cut["provenance"] = {{"version", "0.1.0"}};
    add("full", "table3/full/NTU-1P", {with_checksum(scores({0.2}, {1})), changed, cut});
    const auto measured = read();
    for (const auto* damaged : {"full1.json is damaged", "full2.json is damaged"})
        EXPECT_EQ(std::ranges::count_if(
                      measured.notices,
                      [&](const std::string& notice) { return notice.find(damaged) != std::string::npos; }),
                  1)
            << damaged;
}

TEST_F(Report, NamesAreTextInEveryForm) {
    const std::string name = "</script><b>&\"x, y_z\\";
    auto& row = add("full", "table3/full/NTU-1P", {scores({0.5}, {4})});
    row["name"] = name;
    row["data"] = {{"path", "<img src=x>"}};
    auto measured = read();
    const auto tables = fill_tables(measured);
    const auto html = page("<i>title", tables, measured.notices, details(measured));
    for (const auto* markup : {"</script><b>", "<b>&\"x", "<b>&amp;&quot;x", "<img", "<i>title"})
        EXPECT_EQ(html.find(markup), std::string::npos) << markup;
    EXPECT_NE(html.find("&lt;/script&gt;&lt;b&gt;&amp;&quot;x"), std::string::npos);
    EXPECT_NE(html.find("<div class=\"note\">"), std::string::npos) << "what the data is comes first";
    EXPECT_EQ(to_json(tables, {})["tables"][2]["rows"][3]["groups"][0]["provenance"][0],
              "sweep test, row " + name);
}

TEST_F(Report, SaysWhatTheMotionsAreWhereverAFigureIs) {
    auto stand_in = scores({0.5}, {4}), recorded = scores({0.6}, {3});
    stand_in["provenance"]["real"]["origin"] = {
        {"data", "stand-in"}, {"skeleton", "generic"}, {"part", "20 categories"}};
    recorded["provenance"]["real"]["origin"] = {{"data", "recorded"}};
    add("babel", "table1/ActFormer/BABEL", {stand_in})["data"] = {{"path", "babel"}};
    add("ntu", "table1/ActFormer/NTU-1P", {recorded})["data"] = {{"path", "ntu-1p"}};
    auto measured = read();
    const auto tables = fill_tables(measured);
    const auto html = html_tables(tables), note = html_note(tables, {}), csv = to_csv(tables),
               latex = to_latex(tables);
    const auto has = [](const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(
        has(html, ">BABEL <small class=\"origin\">stand-in, generic skeleton, 20 categories</small></th>"))
        << html;
    EXPECT_TRUE(has(html, ">NTU-1P <small class=\"origin\">recorded</small></th>"));
    EXPECT_TRUE(has(html, ">NTU-13</th>")) << "nothing was measured there";
    EXPECT_TRUE(has(html, "<b>BABEL</b> (stand-in, generic skeleton, 20 categories), measured on"));
    EXPECT_TRUE(has(note, "cannot be held against the paper's"));
    EXPECT_TRUE(has(note, "generic skeleton"));
    EXPECT_TRUE(has(csv, ",\"stand-in, generic skeleton, 20 categories\",\n"));
    EXPECT_TRUE(has(latex, "{BABEL (stand-in, generic skeleton, 20 categories)}"));
    EXPECT_TRUE(has(latex, ". BABEL: stand-in, generic skeleton, 20 categories"));
    EXPECT_EQ(to_json(tables, {})["tables"][0]["rows"][3]["groups"][2]["origin"], "recorded");
}

/// By a recogniser with this accuracy on real motions of four classes.
Json scored_by(double real_accuracy) {
    auto out = scores({0.3}, {4});
    out["real"]["accuracy"] = real_accuracy;
    out["per_class"] = std::vector(4, Json{{"class", "walk"}});
    return out;
}

TEST_F(Report, SaysWhereTheRecogniserIsNearChanceInEveryForm) {
    add("full", "table3/full/NTU-1P", {scored_by(0.9), scored_by(0.26)});
    add("fixed", "table3/fixed PE/NTU-1P", {scored_by(0.26)});
    add("gaussian", "table3/Gaussian prior/NTU-1P", {scored_by(0.9)});
    add("untold", "table4/full/NTU-2P", {scores({0.3}, {4})});
    auto measured = read();
    const auto tables = fill_tables(measured);
    const std::string said =
        "the recogniser is right on 26.0 % of the real motions, where guessing among 4 classes is right on "
        "25.0 %: what it says of generated ones means nothing; train it longer, or on this data";
    EXPECT_EQ(near_chance_lines(tables[2]), std::vector{"NTU-1P (fixed PE; full): " + said});
    EXPECT_TRUE(near_chance_lines(tables[3]).empty()) << "its scores do not tell";

    const auto count = [](const std::string& text, const std::string& part) {
        std::size_t times = 0;
        for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
        return times;
    };
    const auto html = html_tables(tables), csv = to_csv(tables);
    EXPECT_EQ(
        count(html, "</div>\n<p class=\"warning\">NTU-1P (fixed PE; full): " + said + "</p>\n</section>"),
        1U);
    EXPECT_EQ(count(html, "<br>the recogniser is near chance on real motions</span>"), 6U)
        << "the tips of two rows' cells";
    EXPECT_EQ(count(to_latex(tables), ". NTU-1P (fixed PE; full): the recogniser is right on 26.0 \\% of"),
              1U);
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "table,row,dataset,metric,state,mean,ci95,over,repeats,paper,paper_ci95,origin,near_chance");
    EXPECT_EQ(count(csv, ",\"" + said + "\"\n"), 6U) << csv;
    const auto rows_of_it = to_json(tables, {})["tables"][2]["rows"];
    const auto of = [&](const std::string& name) {
        for (const auto& row : rows_of_it)
            if (row["name"] == name) return row["groups"][0]["near_chance"].get<std::string>();
        return "no row " + name;
    };
    EXPECT_EQ(of("full"), said);
    EXPECT_EQ(of("fixed PE"), said);
    EXPECT_EQ(of("Gaussian prior"), "");
}

TEST_F(Report, ATableOfAllRowsSaysWhereItsRecogniserIsNearChance) {
    add("mine", "", {scored_by(0.3)})["fills"] = Json::array();
    const auto measured = read();
    const RowTables tables(measured);
    const auto lines = near_chance_lines(tables.filled()[0]);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].starts_with("one (mine; real motions): the recogniser is right on 30.0 %"))
        << lines[0];
}

TEST_F(Report, CsvHasALineForEveryFigureOfThePaper) {
    add("full", "table3/full/NTU-1P", {scores({0.5, 0.7}, {4, 6})});
    auto measured = read();
    const auto csv = to_csv(fill_tables(measured));
    EXPECT_NE(csv.find(",2 repeats,2,12.53,,"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\ntable3,full,NTU-1P,fid_mean,measured,5,12.706"), std::string::npos)
        << "t(0.975, 1) = 12.706, s / sqrt(2) = 1";
    EXPECT_NE(csv.find("\ntable3,fixed PE,NTU-1P,accuracy,not run,,,,0,37.57,,,\n"), std::string::npos);
    // 4 rows of 12, then 4, 6 and 3 rows of 5 and their groups
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 12 + 4 * 9 + 4 * 3 + 6 * 5 + 3 * 9);
}

TEST_F(Report, LatexTakesNoNameForACommand) {
    auto table = read_table(
        "title: Table 9\ncaption: c\nsource: s\norder: 9\n"
        "columns: [{dataset: A, metrics: [diversity]}]\nrows:\n  one: {A: [1]}\n  two: {A: [2]}\n",
        "table9.yaml");
    const std::string hostile = "a\\input{b}$x$ & #1_2 %c ~ ^ \"d\"\n\\\\ e";
    table.columns[0].dataset = table.rows[0].name = table.caption = hostile;
    table.rows[1].name = "[1ex] *";
    auto measured = read();
    measured.tables = {table};
    const auto latex = to_latex(fill_tables(measured));
    const std::string escaped =
        R"(a\textbackslash{}input\{b\}\$x\$ \& \#1\_2 \%c \~{} \^{} "d"\textbackslash{}x0A\textbackslash{}\textbackslash{} e)";
    for (const auto& line :
         {" & \\multicolumn{1}{c}{" + escaped + "} \\\\\n", "\n" + escaped + " & -- \\\\\n",
          std::string("\n{}[1ex] * & -- \\\\\n"), "\n\\caption{" + escaped + "}\n"})
        EXPECT_NE(latex.find(line), std::string::npos) << line << latex;
}

TEST_F(Report, LatexHasAsManyColumnsInEveryLine) {
    add("full", "table3/full/NTU-1P", {scores({0.599, 0.601}, {4.9, 5.1})});
    add("fixed", "table3/fixed PE/NTU-1P", {scores({0.4, 0.401}, {9, 9.1})});
    auto measured = read();
    EXPECT_NE(to_latex(fill_tables(measured)).find(". Intervals of 95 \\% over 2 repeats}"),
              std::string::npos);
    const auto tables = fill_tables(measured);
    std::size_t rows = 0, lines = 0, full = 0;
    for (const auto& table : tables) {
        std::size_t figures = 0;
        for (const auto& column : table.paper->columns) figures += column.metrics.size();
        if (figures == 3) rows += 1 + table.rows.size();  // the first tells what is measured
    }
    std::istringstream latex(to_latex(tables));
    bool in_third = false;
    for (std::string line; std::getline(latex, line);) {
        in_third = in_third || line == "\\begin{tabular}{lrrr}";
        if (in_third && line.starts_with("full &")) {
            ++full;
            EXPECT_EQ(line,
                      "full & \\textbf{60.00}{\\scriptsize\\,$\\pm$1.27} & "
                      "\\textbf{5.00}{\\scriptsize\\,$\\pm$1.27} & -- \\\\");
        }
        if (in_third && line.ends_with("\\\\") && line.find("multicolumn") == std::string::npos) {
            EXPECT_EQ(std::count(line.begin(), line.end(), '&'), 3) << line;
            ++lines;
        }
        if (line == "\\end{tabular}") in_third = false;
    }
    EXPECT_GE(full, 1U);
    EXPECT_EQ(lines, rows);
}

TEST(Packed, IsBase64OfLittleEndianNumbers) {
    const auto of = [](const std::string& text) {
        return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
    };
    EXPECT_EQ(of(""), "");  // RFC 4648, section 10
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(packed(std::vector<std::int16_t>{0x6F66, 0x626F, 0x7261}), "Zm9vYmFy");
    EXPECT_EQ(packed(std::vector<std::int16_t>{-1}), "//8=");
}

TEST(PackedMotion, ComesBackWithinHalfAStep) {
    const auto walk = walkers(2, 7);
    const auto motion = packed_motion(walk, 60, 2);
    EXPECT_EQ(motion["frames"], 4);
    EXPECT_DOUBLE_EQ(motion["fps"].get<double>(), 15);
    const double scale = motion["scale"];
    EXPECT_LT(scale, 1e-4) << "a tenth of a millimetre for bodies of some metres";
    // the last coordinate of all, read from the base64 by hand: 2 bytes, little-endian
    const auto text = motion["xyz"].get<std::string>();
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<unsigned char> bytes;
    for (std::size_t i = 0; i + 4 <= text.size(); i += 4) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 4; ++k) bits = bits << 6 | (letters.find(text[i + k]) & 63U);
        for (int shift = 16; shift >= 0; shift -= 8)
            bytes.push_back(static_cast<unsigned char>(bits >> shift));
    }
    ASSERT_GE(bytes.size(), 2U * 4 * 2 * 25 * 3);
    for (std::size_t i = 0; i < 4 * 2 * 25 * 3; ++i) {
        const auto whole = static_cast<std::int16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8);
        const auto frame = i / 150, rest = i % 150;
        EXPECT_NEAR(motion["origin"][i % 3].get<double>() + scale * whole,
                    walk.joints[2 * frame * 150 + rest], 0.51 * scale);
    }
}

TEST(PackedMotion, ABodyThatIsGoneStaysWhereItWas) {
    auto walk = walkers(1, 3);
    walk.seen = {1, 0, 1};
    for (std::size_t i = 75; i < 150; ++i) walk.joints[i] = 1e30F;
    const auto motion = packed_motion(walk, 3);
    EXPECT_LT(motion["scale"].get<double>(), 1e-3) << "what is not there does not count";
}

TEST(Projections, AreThePrincipalAxes) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    eval::Samples real{3, 2, {}, {}, {}};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        // deviations 6, 3 and 1 along (1, 1, 0) / sqrt 2, (0, 0, 1) and (1, -1, 0) / sqrt 2, about (5, 0, -2)
        const double a = 6 * normal(random), b = 3 * normal(random), c = normal(random), r = std::sqrt(0.5);
        for (const double x : {5 + r * (a + c), r * (a - c), -2 + b}) real.features.push_back(x);
        real.labels.push_back(i % 2);
    }
    const Projection projection(real);
    // shares 36 : 9 : 1; a variance of 1000 samples is known to about 2 / sqrt(2000) = 4.5 %
    EXPECT_NEAR(projection.explained()[0], 36.0 / 46, 0.03);
    EXPECT_NEAR(projection.explained()[1], 9.0 / 46, 0.03);
    eval::Samples one{3, 2, {5 + 6 * std::sqrt(0.5), 6 * std::sqrt(0.5), -2}, {}, {1}};
    const auto points = projection.of(one);
    EXPECT_NEAR(points.xy[0] / 4096.0, 1, 0.15) << "one deviation along the first axis";
    EXPECT_NEAR(points.xy[1] / 4096.0, 0, 0.15);
    EXPECT_EQ(points.labels[0], 1);
    EXPECT_EQ(projection.real().labels.size(), 1000U);
    double square = 0;
    for (std::size_t i = 0; i < 1000; ++i) square += std::pow(projection.real().xy[2 * i] / 4096.0, 2);
    EXPECT_NEAR(square / 999, 1, 1e-3) << "the real side has deviation 1";
}

TEST(Projections, FarPointsAndSamplesThatAreAllTheSameStayFinite) {
    eval::Samples same{2, 1, {3, 3, 3, 3}, {}, {0, 0}};
    EXPECT_EQ(Projection(same).real().xy, (std::vector<std::int16_t>{0, 0, 0, 0}));
    eval::Samples real{2, 1, {0, 0, 1, 0, 2, 0.5}, {}, {0, 0, 0}}, far{2, 1, {1e9, 0}, {}, {0}};
    EXPECT_NEAR(std::abs(Projection(real).of(far).xy[0]), 8 * 4096, 8);
    eval::Samples other{3, 1, {0, 0, 0}, {}, {0}};
    EXPECT_NE(error_of([&] { Projection(real).of(other); }).find("3 dimensions"), std::string::npos);
}

TEST(Projections, AreNotOfVeryManyDimensions) {
    const eval::Samples wide{4097, 1, std::vector<double>(std::size_t{2} * 4097), {}, {0, 0}};
    EXPECT_EQ(error_of([&] { Projection{wide}; }),
              "features of 4097 dimensions, and a plane through up to 4096 is drawn");
}

TEST(Curves, JoinLinesOfAnEpochAndTellOfBrokenOnes) {
    const Folder dir;
    const std::string whole = "{\"epoch\": 2, \"loss\": 1.5}\n" +
                              checked_line({{"epoch", 2}, {"accuracy", 0.25}}, 3),
                      first = "{\"epoch\": 1, \"loss\": 2.5, \"rate\": 0.1}\n";
    auto changed = checked_line({{"epoch", 4}, {"loss", 7.5}}, 5);
    changed[changed.find("7.5")] = '8';
    write(dir / "run" / "log.jsonl", first + "not json\n" + whole + changed + "{\"epoch\": 3, \"lo");
    const auto expected = Json::parse(R"([{"epoch": 1, "loss": 2.5, "rate": 0.1},
                                          {"epoch": 2, "loss": 1.5, "accuracy": 0.25}])");
    const auto curves = read_curves(dir / "run");
    EXPECT_EQ(curves.epochs, expected);
    EXPECT_TRUE(curves.fault.ends_with("run/log.jsonl: lines 2, 5: damaged")) << curves.fault;

    write(dir / "run" / "log.jsonl", first + whole + "{\"epoch\": 3, \"lo");
    EXPECT_EQ(read_curves(dir / "run").epochs, expected);
    EXPECT_TRUE(read_curves(dir / "run").fault.ends_with("run/log.jsonl: its last line is cut short"));
    const auto held = FileLock::if_free(dir / "run" / "lock");
    EXPECT_EQ(read_curves(dir / "run").fault, "") << "the training is writing it";
    EXPECT_EQ(read_curves(dir / "none").epochs, Json::array());
}

TEST(Curves, AreChartsOfWhateverWasTrained) {
    const auto charts = curve_charts(Json::parse(R"([
        {"epoch": 1, "step": 7, "kl_loss": 3, "reconstruction_loss": 9, "seconds": 2},
        {"epoch": 2, "step": 14, "kl_loss": 2, "accuracy": 0.25, "train_accuracy": 0.5, "fid_whole": 7, "steps_a_second": 4}
    ])"),
                                     "generated motions");
    EXPECT_EQ(charts["points"], Json::parse(R"([{"epoch": 1, "kl_loss": 3.0, "reconstruction_loss": 9.0},
        {"epoch": 2, "kl_loss": 2.0, "accuracy": 25.0, "train_accuracy": 50.0, "fid_whole": 7.0}])"));
    ASSERT_EQ(charts["charts"].size(), 3U) << charts["charts"];
    EXPECT_EQ(charts["charts"][0]["series"], Json::parse(R"([{"key": "kl_loss", "name": "kl"},
        {"key": "reconstruction_loss", "name": "reconstruction"}])"));
    EXPECT_EQ(charts["charts"][1]["unit"], "%");
    EXPECT_EQ(charts["charts"][1]["series"], Json::parse(R"([{"key": "accuracy", "name": "generated motions"},
        {"key": "train_accuracy", "name": "train"}])"));
    EXPECT_EQ(charts["charts"][2]["title"], "FIDw");
}

TEST(Curves, LongOnesAreThinnedAndKeepTheirEnd) {
    const Folder dir;
    std::string log;
    for (int i = 1; i <= 2001; ++i) log += "{\"epoch\": " + std::to_string(i) + ", \"loss\": 1}\n";
    write(dir / "run" / "log.jsonl", log);
    const auto curves = read_curves(dir / "run").epochs;
    EXPECT_LE(curves.size(), 501U);
    EXPECT_EQ(curves.front()["epoch"], 1);
    EXPECT_EQ(curves.back()["epoch"], 2001);
}

}  // namespace
}  // namespace actformer::reports
