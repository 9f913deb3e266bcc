// The papers' tables: those that come with the program, and what their files may and may not say.
#include "reports/tables/paper_tables.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.hpp"
#include "reports/tables/own_tables.hpp"

namespace actformer::reports {
namespace {

const std::string head = "title: Table 9\ncaption: c\nsource: s\norder: 9\n";
const std::string columns = "columns:\n  - {dataset: A, metrics: [accuracy, diversity]}\n";

std::string refusal(const std::string& yaml) {
    try {
        read_table(yaml, "x/table9.yaml");
    } catch (const Error& e) {
        return e.what();
    }
    return "nothing is wrong";
}

void expect_refused(const std::string& yaml, const std::vector<std::string>& words) {
    const auto why = refusal(yaml);
    EXPECT_EQ(why.find('\n'), std::string::npos) << why;
    for (const auto& word : words) EXPECT_NE(why.find(word), std::string::npos) << word << ": " << why;
}

TEST(PaperTables, AreWhatThePaperPrints) {
    const auto& tables = paper_tables();
    ASSERT_GE(tables.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(tables[i].id, "table" + std::to_string(i + 1));
    // The sums of all figures, a mistyped digit changes one of them.
    const double sums[] = {1249.01, 377.72, 238.16, 580.00, 299.82};
    for (std::size_t i = 0; i < 5; ++i) {
        double sum = 0;
        for (const auto& row : tables[i].rows)
            for (const auto& figures : row.figures)
                for (const auto& figure : figures) sum += figure.value.value_or(0);
        EXPECT_NEAR(sum, sums[i], 1e-9) << tables[i].id;
    }
    const auto cell = find_cell("table5/without shared z/GTA-5P");
    EXPECT_EQ(cell.table->rows[cell.row].figures[cell.columns][0].value, 2.42);
    EXPECT_EQ(words_of(cell), "Table 5 · without shared z · GTA-5P");
}

TEST(PaperTables, HoldIntervalsAndWhatIsNotAtHand) {
    const auto table = read_table(head + columns +
                                      "metrics:\n  accuracy: {heading: Acc., scale: 1}\n"
                                      "  diversity: {better: higher}\n"
                                      "real: real motions\n"
                                      "rows:\n"
                                      "  real motions: {A: [98.8 ± 0.25, 7.07]}\n"
                                      "  a: {A: [-, not at hand]}\n"
                                      "  b: {A: not at hand}\n"
                                      "  c: {}\n",
                                  "x/table9.yaml");
    EXPECT_EQ(table.id, "table9");
    const auto& metrics = table.columns[0].metrics;
    EXPECT_EQ(metrics[0].heading, "Acc.");
    EXPECT_EQ(metrics[0].scale, 1);
    EXPECT_EQ(metrics[0].better, eval::Direction::higher) << "as scoring has it";
    EXPECT_EQ(metrics[1].better, eval::Direction::higher) << "as the table has it";
    EXPECT_EQ(table.real, 0U);
    const auto figure = [&](std::size_t row, std::size_t metric) {
        return table.rows[row].figures[0][metric];
    };
    EXPECT_EQ(figure(0, 0).value, 98.8);
    EXPECT_EQ(figure(0, 0).half_width, 0.25);
    EXPECT_FALSE(figure(0, 1).half_width);
    EXPECT_FALSE(figure(1, 0).value);
    EXPECT_TRUE(figure(1, 0).at_hand);
    EXPECT_FALSE(figure(1, 1).at_hand);
    EXPECT_FALSE(figure(2, 0).at_hand || figure(2, 1).at_hand);
    ASSERT_EQ(table.rows[3].figures[0].size(), 2U);
    EXPECT_TRUE(figure(3, 0).at_hand);
}

TEST(PaperTables, TellFileAndLineOfWhatIsWrong) {
    const auto rows = [](const std::string& text) { return head + columns + "rows:\n  a: " + text + "\n"; };
    expect_refused(rows("{A: [1]}"), {"x/table9.yaml: line 8:", "row 'a', A: 1 figures for 2 metrics"});
    expect_refused(rows("{A: [1, x]}"), {"line 8", "'x' is no figure"});
    expect_refused(rows("{A: [1, 2 ± ]}"), {"line 8", "'2 ±' is no figure"});
    expect_refused(rows("{A: [1, nan]}"), {"line 8", "is no figure"});
    expect_refused(rows("{A: [1, [2]]}"), {"line 8", "must be a number"});
    expect_refused(rows("{A: 3}"), {"line 8", "'A' of row 'a' must be a list"});
    expect_refused(rows("{B: [1, 2]}"), {"line 8", "no key 'B'; there are A"});
    expect_refused(rows("3"), {"line 8", "row 'a' must be a map"});
    expect_refused(rows("{}\n  a: {}"), {"line 9", "rows: 'a' is given twice"});
    expect_refused(rows("{}\n  a/b: {}"), {"line 9", "'a/b'"});
    expect_refused(rows("{}\nreal: b"), {"line 9", "no row 'b'"});
    expect_refused(rows("{}\ncolour: red"), {"line 9", "no key 'colour'", "caption"});
    expect_refused(rows("{}\nmetrics: {fid_mean: {}}"), {"line 9", "no key 'fid_mean'; there are accuracy"});
    expect_refused(rows("{}\nmetrics: {accuracy: {better: best}}"), {"line 9", "nearest to real", "'best'"});
    expect_refused(rows("{}\nmetrics: 3"), {"line 9", "metrics must be a map"});
    expect_refused(rows("{}\nmetrics: {accuracy: 3}"), {"line 9", "a metric must be a map"});
    expect_refused(head + "columns: [{dataset: A, metrics: [fid_meen]}]\nrows: {a: {}}\n",
                   {"line 5", "no metric 'fid_meen'", "fid_mean"});
    expect_refused(head + "columns: [{dataset: A}]\nrows: {a: {}}\n", {"line 5", "dataset and metrics"});
    expect_refused(head + "columns: []\nrows: {a: {}}\n", {"line 5", "columns"});
    expect_refused(head + "columns: [{dataset: A, metrics: [accuracy, fid_mean, accuracy]}]\nrows: {a: {}}\n",
                   {"line 5", "'accuracy' comes twice"});
    expect_refused(head + columns, {"x/table9.yaml", "no 'rows'"});
    expect_refused(head + columns + "rows: {}\n", {"line 7", "rows"});
    expect_refused("title: [\n", {"x/table9.yaml: line"});
    expect_refused("just text", {"line 1", "must be a map"});
}

/// "[a0, a1, ...]", or with braces.
std::string many(char open, std::size_t count, const std::string& begin, const std::string& end, char close) {
    std::string out(1, open);
    for (std::size_t i = 0; i < count; ++i) out += begin + std::to_string(i) + end + ", ";
    return out + close;
}

TEST(PaperTables, OfMoreThanAnyPaperPrintsAreRefused) {
    const auto table = [](const std::string& metrics, std::size_t rows) {
        return head + "columns: [{dataset: A, metrics: &m [" + metrics +
               "]}, {dataset: B, metrics: *m}]\nrows: {a: &a {}, " +
               many('{', rows - 1, "r", ": *a", '}').substr(1) + "\n";
    };
    EXPECT_EQ(refusal(table("accuracy", 50'000)), "nothing is wrong");
    expect_refused(table("accuracy", 50'001), {"x/table9.yaml: line 6", "more than 100000 figures"});
    expect_refused(table("accuracy, diversity, fid_mean, fid_whole", 12'501),
                   {"x/table9.yaml: line 6", "more than 100000 figures"});
    expect_refused(head + "columns: " + many('[', 101, "{dataset: D", ", metrics: [accuracy]}", ']') +
                       "\nrows: {a: {}}\n",
                   {"line 5", "101 columns; at most 100"});
}

std::vector<PaperTable> with(const std::string& yaml) {
    return with_own_tables(paper_tables(), YAML::Load(yaml), {"sweep.yaml"});
}

TEST(OwnTables, StandBeforeThePapersAndGiveTheirsMoreRows) {
    const auto tables = with(
        "mine:\n"
        "  caption: Real motion\n"
        "  columns: [{dataset: CMU, metrics: [accuracy, fid_mean]}]\n"
        "  rows: {ActFormer: {}, other: {CMU: [50.5, 12]}}\n"
        "table1: {rows: {Mine: {}, ActFormer: {}}}\n");
    ASSERT_EQ(tables.size(), paper_tables().size() + 1);
    EXPECT_EQ(tables[0].id, "mine");
    EXPECT_EQ(tables[0].title, "mine");
    EXPECT_EQ(words_of(find_cell("mine/other/CMU", tables)), "mine · other · CMU");
    EXPECT_EQ(tables[0].rows[1].figures[0][0].value, 50.5);
    EXPECT_EQ(tables[1].rows.size(), paper_tables()[0].rows.size() + 1) << "ActFormer is there already";
    const auto cell = find_cell("table1/Mine/NTU-1P", tables);
    EXPECT_FALSE(cell.table->rows[cell.row].figures[cell.columns][0].value);
    // Two sweeps of one table come to one, with the rows of both.
    const auto again = with_own_tables(
        tables,
        YAML::Load("mine: {columns: [{dataset: CMU, metrics: [accuracy, fid_mean]}], rows: {third: {}}}"),
        {"other.yaml"});
    EXPECT_EQ(again.size(), tables.size());
    EXPECT_EQ(again[0].rows.size(), 3U);
}

TEST(OwnTables, RefuseWhatWouldHideSomething) {
    const std::string cmu = "columns: [{dataset: CMU, metrics: [accuracy]}]";
    for (const auto& [yaml, words] : std::vector<std::pair<std::string, std::string>>{
             {"\nmine: {" + cmu + "}", "line 2: has no 'rows'"},
             {"mine: {rows: {a: {}}}", "has no 'columns'"},
             {"mine: {" + cmu + ", rows: {a/b: {}}}", "nor hold a /"},
             {"a b: {" + cmu + ", rows: {a: {}}}", "letters, digits, - and _"},
             {"table1: {" + cmu + ", rows: {a: {}}}", "there is a table 'table1' with other columns"},
             {"table3: {rows: {full: {NTU-1P: [1, 2, 3]}}}", "a row 'full' with other figures"},
             {"table1: {rows: {a: {NTU-9P: []}}}", "no key 'NTU-9P'"},
             {"table1: {rows: {a: {}}}\ntable1: {rows: {b: {}}}", "line 2: tables: 'table1' is given twice"},
             {"table1: {rows: {a: {}}, rows: {b: {}}}", "table 'table1': 'rows' is given twice"},
             {"table1: {rows: {a: {}}}\n[table2]: {rows: {b: {}}}", "line 2: tables: a key must be a text"},
             {"table1: {rows: {a: {}}}\n~: {rows: {b: {}}}", "line 2: tables: a key must be a text"},
             {"[mine]", "must be a map"}}) {
        std::string why = "nothing is wrong";
        try {
            with(yaml);
        } catch (const Error& e) {
            why = e.what();
        }
        EXPECT_EQ(why.find("sweep.yaml: "), 0U) << why;
        EXPECT_NE(why.find(words), std::string::npos) << yaml << ": " << why;
    }
}

TEST(OwnTables, OfMoreThanAnyReportShowsAreRefused) {
    const auto refusal_of = [](const std::string& yaml) -> std::string {
        try {
            with(yaml);
        } catch (const Error& e) {
            return e.what();
        }
        return "nothing is wrong";
    };
    const auto table =
        "&t {columns: [{dataset: A, metrics: [accuracy]}], rows: " + many('{', 1000, "r", ": {}", '}') + "}";
    const auto tables = [&](std::size_t again) {
        return "{t: " + table + ", " + many('{', again, "t", ": *t", '}').substr(1);
    };
    EXPECT_EQ(refusal_of(tables(99)), "nothing is wrong");
    const auto why = refusal_of(tables(100));
    EXPECT_NE(why.find("sweep.yaml: line 1: more than 100000 figures"), std::string::npos) << why;
    EXPECT_NE(refusal_of(many('{', 1001, "t", ": {}", '}')).find("1001 tables; at most 1000"),
              std::string::npos);
}

}  // namespace
}  // namespace actformer::reports
