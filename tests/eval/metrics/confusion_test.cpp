// Which class was taken for which: accuracies by hand, and what a reader sees of few and of many classes.
#include "eval/metrics/confusion.hpp"

#include <gtest/gtest.h>

#include <sstream>

using actformer::eval::Confusion;

namespace {

std::vector<std::string> numbered(std::size_t classes) {
    std::vector<std::string> names;
    for (std::size_t c = 0; c < classes; ++c) names.push_back("class-" + std::to_string(c));
    return names;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

void add(Confusion& to, std::size_t truth, std::size_t guess, int times) {
    for (int i = 0; i < times; ++i) to.add(truth, guess);
}

}  // namespace

TEST(Confusion, AveragesOverTheClassesThatHaveSamples) {
    Confusion c(4);
    EXPECT_EQ(c.mean_class_accuracy(), 0);
    EXPECT_EQ(c.sample_accuracy(), 0);
    add(c, 0, 0, 3);
    add(c, 0, 2, 1);
    add(c, 1, 1, 1);
    add(c, 1, 0, 1);
    EXPECT_EQ(c.samples(), 6U);
    EXPECT_DOUBLE_EQ(c.mean_class_accuracy(), (0.75 + 0.5) / 2);
    EXPECT_DOUBLE_EQ(c.sample_accuracy(), 4.0 / 6);
    EXPECT_EQ(c.rows()[0], (std::vector<std::uint64_t>{3, 0, 1, 0}));
}

TEST(Confusion, ShowsOnlyTheClassesThatOccur) {
    Confusion c(94);
    add(c, 5, 5, 3);
    add(c, 5, 70, 1);
    add(c, 8, 8, 2);
    const auto lines = lines_of(c.table(numbered(94)));
    ASSERT_EQ(lines.size(), 4U) << "a heading, two classes with samples, and one that was guessed";
    EXPECT_EQ(lines[0], "truth        samples    6    9   71  (per cent taken for class ..)");
    EXPECT_EQ(lines[1], "  6 class-5        4   75    .   25");
    EXPECT_EQ(lines[2], "  9 class-8        2    .  100    .");
    EXPECT_EQ(lines[3], " 71 class-70       0    .    .    .");
}

TEST(Confusion, ListsManyClassesWithTheirCommonestMistakes) {
    Confusion c(94);
    for (std::size_t k = 0; k < 94; ++k) add(c, k, k, 4);
    add(c, 20, 3, 1);
    add(c, 20, 40, 2);
    add(c, 20, 50, 2);
    add(c, 20, 60, 1);
    const auto lines = lines_of(c.table(numbered(94)));
    ASSERT_EQ(lines.size(), 95U);
    EXPECT_EQ(lines[1], "  1 class-0        4     100");
    EXPECT_EQ(lines[21], " 21 class-20      10      40  20 class-40, 20 class-50, 10 class-3");
    for (const auto& line : lines) EXPECT_LE(line.size(), 80U);
}

TEST(Confusion, TakesTheLargestLogit) {
    actformer::eval::Samples s{1, 3, {0, 0, 0, 0}, {}, {0, 0, 0, 2}};
    s.logits = {1, 0, 0, /**/ 0, 1, 0, /**/ 2, 2, 2, /**/ 0, 0, 9};  // of equal logits the first counts
    const auto confusion = confusion_of(s);
    EXPECT_NEAR(confusion.mean_class_accuracy(), (2.0 / 3 + 1) / 2, 1e-15);
    EXPECT_EQ(confusion.at(0, 1), 1U);
}
