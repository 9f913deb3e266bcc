// `actformer classify` as its users meet it, beside a plain forward pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/plain_recogniser.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/unit_limbs.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

/// (channels, frames, K) of a one-person motion's frames `first` and on.
std::vector<float> values_of(const ingest::Motion& motion, std::uint32_t first, std::uint32_t frames) {
    std::vector<float> x;
    for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t t = first; t < first + frames; ++t)
            for (std::size_t k = 0; k < motion.nodes; ++k) x.push_back(motion.at(t, 0, k)[d]);
    return x;
}

/// Softmax of the mean of some logits.
std::vector<double> softmax_of_mean(const std::vector<std::vector<double>>& logits) {
    std::vector<double> p(logits[0].size(), 0);
    double sum = 0;
    for (std::size_t c = 0; c < p.size(); ++c) {
        for (const auto& one : logits) p[c] += one[c] / static_cast<double>(logits.size());
        p[c] = std::exp(p[c]);
        sum += p[c];
    }
    for (auto& v : p) v /= sum;
    return p;
}

struct Classify : testing::Test {
    void SetUp() override {
        const auto graph = eval::recogniser_graph(ingest::Dataset(toy()).header().topology.parents);
        weights = eval::random_stgcn_weights(3, 3, graph, 0.125, 5);
        write_stgcn_weights(dir / "w.h5", weights);
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }
    CommandResult classify(const std::string& more) const {
        return run_actformer("classify --recogniser " + at("w.h5") + " " + more);
    }
    nlohmann::json classified(const std::string& more) const {
        const auto result = classify(more + " --json");
        EXPECT_EQ(result.exit, 0) << result.output;
        return nlohmann::json::parse(result.output, nullptr, false);
    }
    void expect_refused(const std::string& more, const std::vector<std::string>& words) const {
        const auto result = classify(more + " -o " + at("refused.csv"));
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto& word : words)
            EXPECT_NE(result.output.find(word), std::string::npos) << word << ": " << result.output;
        EXPECT_FALSE(std::filesystem::exists(at("refused.csv")));
    }

    eval::StgcnWeights weights;
    TempDir dir;
};

/// `p` sorted: the best class, its probability, and the runner-up's.
void expect_row(const nlohmann::json& row, const std::vector<double>& p) {
    const auto best = std::max_element(p.begin(), p.end()) - p.begin();
    double second = 0;
    for (std::size_t c = 0; c < p.size(); ++c)
        if (static_cast<std::ptrdiff_t>(c) != best) second = std::max(second, p[c]);
    EXPECT_EQ(row["class"], best + 1) << "counted from 1";
    EXPECT_NEAR(row["probability"].get<double>(), p[best], 1e-4) << "logits in float32";
    EXPECT_NEAR(row["runner_up"]["probability"].get<double>(), second, 1e-4);
    EXPECT_NE(row["runner_up"]["class"], row["class"]);
}

}  // namespace

TEST_F(Classify, TakesTheMeanOfAClipsWindows) {
    const auto json = classified(toy().string() + " --window 15");
    const ingest::Dataset data(toy());
    ASSERT_EQ(json.size(), data.clips().size()) << "a row a clip";
    const PlainRecogniser plain(weights);
    for (std::size_t i = 0; i < data.clips().size(); i += 7) {
        const auto motion = data.motion(i);
        std::vector<std::vector<double>> logits;
        for (std::uint32_t first = 0; first + 15 <= motion.frames; first += 15)
            logits.push_back(plain(values_of(motion, first, 15).data(), 15).logits);
        ASSERT_GT(logits.size(), 1U);
        EXPECT_EQ(json[i]["clip"], data.clips()[i].name);
        EXPECT_EQ(json[i]["windows"], logits.size());
        expect_row(json[i], softmax_of_mean(logits));
        EXPECT_EQ(json[i]["name"], data.header().classes[json[i]["class"].get<std::size_t>() - 1]);
    }
    EXPECT_EQ(classified(toy().string() + " --split s/test").size(), 12U);
}

TEST_F(Classify, TakesMotionsWithoutLabels) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const auto nodes = weights.joints();
    ingest::MotionsWriter writer(dir / "m.h5");
    std::map<std::string, std::vector<double>> expected;
    const PlainRecogniser plain(weights);
    for (const std::string name : {"a, \"b\"", "walk", "zz"}) {
        ingest::Motion motion{name, 20, 1, nodes, 3, {}};
        motion.values.resize(std::size_t{20} * nodes * 3);
        for (auto& v : motion.values) v = normal(random);
        make_unit_limbs(motion);
        expected[name] = softmax_of_mean({plain(values_of(motion, 0, 20).data(), 20).logits});
        writer.add(name, motion);
    }
    writer.finish();
    const auto json = classified(at("m.h5") + " -o " + at("m.csv") + " 2>/dev/null");
    ASSERT_EQ(json.size(), 3U);
    for (const auto& row : json) {
        expect_row(row, expected.at(row["clip"]));
        EXPECT_EQ(row["name"], fmt::format("A{:03}", row["class"].get<int>())) << "nothing tells the names";
    }
    const auto table = read_file(dir / "m.csv");
    EXPECT_TRUE(
        table.starts_with("clip,windows,class,name,probability,runner_up,runner_up_probability\n"
                          "\"a, \"\"b\"\"\",1,"))
        << table;
    EXPECT_EQ(lines_in(table), 4);
    const auto text = classify(at("m.h5"));
    EXPECT_EQ(lines_in(text.output), 4) << text.output;
    EXPECT_NE(text.output.find("walk"), std::string::npos);
}

TEST_F(Classify, NamesClassesAsTheRecogniserLearntThem) {
    weights.class_names = {"sit", "stand", "walk"};
    write_stgcn_weights(dir / "w.h5", weights);
    const auto json = classified(toy().string());
    for (const auto& row : json)
        EXPECT_EQ(row["name"], weights.class_names[row["class"].get<std::size_t>() - 1]);
}

TEST_F(Classify, RefusesWhatDoesNotFit) {
    expect_refused(at("none.h5"), {"none.h5"});
    expect_refused(toy().string() + " --split nowhere", {"nowhere"});
    expect_refused(toy().string() + " --split s/none", {"s/none"});
    write_file(dir / "text.h5", "text");
    expect_refused(at("text.h5"), {"text.h5", "HDF5"});
    ingest::MotionsWriter writer(dir / "m.h5");
    writer.add("two", {"two", 4, 2, weights.joints(), 3, std::vector<float>(8 * weights.joints() * 3)});
    writer.finish();
    expect_refused(at("m.h5"), {"m.h5", "6 channels", "w.h5"});
    std::filesystem::create_directory(dir / "run");
    const auto result = run_actformer("classify --recogniser " + at("run") + " " + toy().string());
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("weights-"), std::string::npos) << result.output;
}

TEST_F(Classify, ReplacesItsTableAndNoFileOfOthers) {
    write_file(dir / "c.csv", "clip,mark\nwalk,1\n");
    const auto to = toy().string() + " -o " + at("c.csv");
    test::expect_refused(classify(to), {"c.csv: is there, and holds no classes", "--force"});
    EXPECT_EQ(read_file(dir / "c.csv"), "clip,mark\nwalk,1\n");
    EXPECT_EQ(classify(to + " --force").exit, 0);
    EXPECT_EQ(classify(to + " --window 10").exit, 0) << "its own table, now";
}

TEST_F(Classify, NamesTheFileThatItWrote) {
    const auto said = at("c.csv") + ": 48 clips, ";
    EXPECT_NE(classify(toy().string() + " -o " + at("c.csv")).output.find(said), std::string::npos);
    EXPECT_EQ(classify(toy().string()).output.find("48 clips"), std::string::npos);
    const auto piped = classify(toy().string() + " -o /dev/stdout | cat");
    EXPECT_EQ(piped.output.find("48 clips"), std::string::npos) << piped.output;
    EXPECT_NE(piped.output.find("clip,windows,class"), std::string::npos) << piped.output;
}

TEST_F(Classify, TakesTheBestWeightsOfATraining) {
    std::filesystem::create_directory(dir / "run");
    const auto with = [&](const char* file, unsigned seed) {
        write_stgcn_weights(dir / "run" / file, eval::random_stgcn_weights(3, 3, weights.graph, 0.125, seed));
        const auto by_folder =
            run_actformer("classify --json --recogniser " + at("run") + " " + toy().string());
        const auto by_file = run_actformer("classify --json --recogniser " + at("run/" + std::string(file)) +
                                           " " + toy().string());
        EXPECT_EQ(by_folder.exit, 0) << by_folder.output;
        EXPECT_EQ(by_folder.output, by_file.output) << file;
        return by_folder.output;
    };
    const auto last = with("weights-last.h5", 1), average = with("weights-average.h5", 2),
               best = with("weights-best.h5", 3);
    EXPECT_NE(last, average);
    EXPECT_NE(average, best);
}
