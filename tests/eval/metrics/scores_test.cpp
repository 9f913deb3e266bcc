// Scores against the reference program and closed forms.
#include "eval/metrics/scores.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/error.hpp"
#include "eval/scoring/features_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
using eval::Samples;

namespace {

/// Class c has counts[c] samples around a centre of its own; `spread` stretches them.
Samples made_samples(const std::vector<std::size_t>& counts, std::size_t dimensions, unsigned seed,
                     float spread = 1) {
    std::mt19937 random(seed), centres(99);
    std::normal_distribution<float> normal;
    Samples out;
    out.dimensions = dimensions;
    out.classes = counts.size();
    for (std::uint32_t c = 0; c < counts.size(); ++c) {
        std::vector<float> centre(dimensions);
        for (auto& v : centre) v = normal(centres);
        for (std::size_t i = 0; i < counts[c]; ++i) {
            for (const auto v : centre) out.features.push_back(v + spread * normal(random));
            for (std::uint32_t k = 0; k < counts.size(); ++k)
                out.logits.push_back(normal(random) + (k == c ? 1.5F : 0));
            out.labels.push_back(c);
        }
    }
    return out;
}

void write(const std::filesystem::path& path, const Samples& samples) {
    eval::FeaturesFile file(path, samples.size(), samples.dimensions, samples.classes);
    const std::vector<float> features(samples.features.begin(), samples.features.end());
    file.add(0, features, samples.logits);
    file.labels(samples.labels);
    file.finish();
}

void expect_near(double ours, const nlohmann::json& theirs) {
    EXPECT_NEAR(ours, theirs.get<double>(), 1e-6 * std::abs(theirs.get<double>()));
}

void expect_as_the_reference(const Samples& real, const Samples& generated) {
    const TempDir dir;
    write(dir / "real.h5", real);
    write(dir / "generated.h5", generated);
    const auto oracle = run_command("/usr/bin/python3 " + shared("reference/fid.py") + " " +
                                    (dir / "real.h5").string() + " " + (dir / "generated.h5").string());
    ASSERT_EQ(oracle.exit, 0) << oracle.output;
    const auto json = nlohmann::json::parse(oracle.output);
    const auto got = distances(statistics_of(real), statistics_of(generated));
    expect_near(got.whole, json["fid_whole"]);
    ASSERT_TRUE(got.mean);
    expect_near(*got.mean, json["fid_mean"]);
    expect_near(confusion_of(generated).mean_class_accuracy(), json["accuracy"]);
}

}  // namespace

TEST(Scores, AgreeWithTheReference) {
    if (!has_reference_python()) GTEST_SKIP() << "needs " << shared("reference") << ", and python3 with h5py";
    expect_as_the_reference(made_samples({40, 50, 60}, 16, 1), made_samples({30, 45, 40}, 16, 2, 1.2F));
    // fewer samples than dimensions on one side, on both, and two only
    expect_as_the_reference(made_samples({400, 500, 300}, 64, 3), made_samples({20, 30, 40}, 64, 4, 0.9F));
    expect_as_the_reference(made_samples({25, 30, 12, 9}, 256, 5), made_samples({20, 14, 40, 9}, 256, 6));
    expect_as_the_reference(made_samples({2, 3}, 32, 7), made_samples({2, 2}, 32, 8));
    // so many that they are shrunk in several rounds
    expect_as_the_reference(made_samples({300, 500}, 16, 9), made_samples({400, 350}, 16, 10, 1.01F));
}

TEST(Scores, OfIdenticalSetsAreNothing) {
    const auto x = made_samples({2, 7, 100, 300}, 64, 1);
    const auto got = distances(statistics_of(x), statistics_of(x));
    EXPECT_EQ(got.whole, 0);
    EXPECT_EQ(got.mean, 0);
    EXPECT_TRUE(got.left_out.empty());
}

TEST(Scores, NameTheClassesLeftOut) {
    const auto real = made_samples({10, 1, 10, 10, 0}, 8, 1), made = made_samples({10, 10, 1, 10, 0}, 8, 2);
    const auto got = distances(statistics_of(real), statistics_of(made));
    ASSERT_EQ(got.left_out.size(), 3U);
    EXPECT_EQ(got.left_out[0].label, 1U);
    EXPECT_EQ(got.left_out[0].real, 1U);
    EXPECT_EQ(got.left_out[1].label, 2U);
    EXPECT_EQ(got.left_out[1].generated, 1U);
    EXPECT_EQ(got.left_out[2].label, 4U);
    EXPECT_EQ(*got.mean, (*got.by_class[0] + *got.by_class[3]) / 2);
    EXPECT_FALSE(got.by_class[1] || got.by_class[2] || got.by_class[4]);

    const auto thin =
        distances(statistics_of(made_samples({1, 1}, 4, 1)), statistics_of(made_samples({5, 5}, 4, 2)));
    EXPECT_FALSE(thin.mean) << "no class is left";
    EXPECT_GT(thin.whole, 0);
    EXPECT_THROW(statistics_of(made_samples({1, 0}, 4, 1)), Error);
    EXPECT_THROW(distances(statistics_of(real), statistics_of(made_samples({9, 9}, 8, 2))), Error);
}

TEST(Scores, AccuracyIsTheMeanOverTheClassesThatHaveSamples) {
    Samples s{1, 3, {0, 0, 0, 0}, {}, {0, 0, 0, 2}};
    s.logits = {1, 0, 0, /**/ 0, 1, 0, /**/ 2, 2, 2, /**/ 0, 0, 9};  // of equal logits the first counts
    const auto confusion = confusion_of(s);
    EXPECT_NEAR(confusion.mean_class_accuracy(), (2.0 / 3 + 1) / 2, 1e-15);
    EXPECT_EQ(confusion.at(0, 1), 1U);
}

TEST(Scores, GroupsAreTheirPersonsLargestFeatures) {
    const std::vector<float> features{1, -2, 3, -4, 0, -1, 5, 5, 4, 6, 6, 4};
    EXPECT_EQ(eval::largest_of_group(features, 2, 3), (std::vector<float>{3, -1, 6, 6}));
    EXPECT_EQ(eval::largest_of_group(features, 4, 1), features);
}

TEST(Scores, DiversityIsTheMeanDistanceOfPairs) {
    Samples corners;  // of a simplex: every pair is sqrt 2 apart; class 1 is twice as large
    corners.dimensions = 10;
    corners.classes = 3;
    for (std::uint32_t i = 0; i < 10; ++i) {
        for (std::uint32_t c = 0; c < 10; ++c) corners.features.push_back(c == i ? (i < 5 ? 1 : 2) : 0);
        corners.labels.push_back(i < 5 ? 0 : 1);
    }
    EXPECT_NEAR(*multimodality(corners), 1.5 * std::sqrt(2.0), 1e-12);
    // all pairs: 10 of class 0, 10 of class 1, 25 across
    const double mean = (10 * std::sqrt(2.0) + 10 * std::sqrt(8.0) + 25 * std::sqrt(5.0)) / 45;
    EXPECT_NEAR(*diversity(corners, 200'000, 3), mean, 0.01) << "ten standard errors of so many pairs";
    EXPECT_EQ(diversity(corners), diversity(corners)) << "the same seed draws the same pairs";
    EXPECT_NE(diversity(corners, 200, 1), diversity(corners, 200, 2));

    const auto single = made_samples({1, 0}, 4, 1);
    EXPECT_FALSE(diversity(single));
    EXPECT_FALSE(multimodality(made_samples({1, 1}, 4, 1)));
    auto lonely = made_samples({5, 1}, 4, 1);
    const auto with = multimodality(lonely);
    lonely.features.resize(5 * 4);
    lonely.logits.clear();
    lonely.labels.resize(5);
    EXPECT_EQ(with, multimodality(lonely)) << "a class of one sample has no pairs";
}

TEST(Scores, CheckTheirSamples) {
    const auto says = [](const Samples& s) {
        try {
            check(s, "file.h5");
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    auto s = made_samples({3, 3}, 4, 1);
    EXPECT_EQ(says(s), "");
    s.features[9] = std::nan("");
    EXPECT_NE(says(s).find("file.h5: feature 1 of sample 2 is not finite"), std::string::npos) << says(s);
    s = made_samples({3, 3}, 4, 1);
    s.logits[3] = INFINITY;
    EXPECT_NE(says(s).find("logit 1 of sample 1"), std::string::npos) << says(s);
    s = made_samples({3, 3}, 4, 1);
    s.labels[5] = 2;
    EXPECT_NE(says(s).find("label 2"), std::string::npos) << says(s);
    s.labels.pop_back();
    EXPECT_NE(says(s).find("do not go with"), std::string::npos) << says(s);
    EXPECT_NE(says(Samples{}).find("no samples"), std::string::npos);
}
