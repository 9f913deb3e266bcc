// Frechet distances of sample sets against the reference program and closed forms.
#include "eval/metrics/fid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "eval/metrics/confusion.hpp"
#include "eval/scoring/features_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/made_samples.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
using eval::Samples;

namespace {

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

TEST(Fid, AgreeWithTheReference) {
    if (!has_reference_python()) GTEST_SKIP() << "needs " << shared("reference") << ", and python3 with h5py";
    expect_as_the_reference(made_samples({40, 50, 60}, 16, 1), made_samples({30, 45, 40}, 16, 2, 1.2F));
    // fewer samples than dimensions on one side, on both, and two only
    expect_as_the_reference(made_samples({400, 500, 300}, 64, 3), made_samples({20, 30, 40}, 64, 4, 0.9F));
    expect_as_the_reference(made_samples({25, 30, 12, 9}, 256, 5), made_samples({20, 14, 40, 9}, 256, 6));
    expect_as_the_reference(made_samples({2, 3}, 32, 7), made_samples({2, 2}, 32, 8));
    // so many that they are shrunk in several rounds
    expect_as_the_reference(made_samples({300, 500}, 16, 9), made_samples({400, 350}, 16, 10, 1.01F));
}

TEST(Fid, OfIdenticalSetsAreNothing) {
    const auto x = made_samples({2, 7, 100, 300}, 64, 1);
    const auto got = distances(statistics_of(x), statistics_of(x));
    EXPECT_EQ(got.whole, 0);
    EXPECT_EQ(got.mean, 0);
    EXPECT_TRUE(got.left_out.empty());
}

TEST(Fid, NameTheClassesLeftOut) {
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

TEST(Fid, GroupsAreTheirPersonsLargestFeatures) {
    const std::vector<float> features{1, -2, 3, -4, 0, -1, 5, 5, 4, 6, 6, 4};
    EXPECT_EQ(eval::largest_of_group(features, 2, 3), (std::vector<float>{3, -1, 6, 6}));
    EXPECT_EQ(eval::largest_of_group(features, 4, 1), features);
}
