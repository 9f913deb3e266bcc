// The network on the device against a plain forward pass in double.
#include "eval/stgcn/recogniser.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/hdf5/writer.hpp"
#include "tests/support/larger.hpp"
#include "tests/support/plain_recogniser.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;

namespace {

std::vector<float> made_motions(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<float> out(count);
    for (auto& v : out) v = normal(random);
    return out;
}

/// The largest difference, relative to the largest number there is.
double relative_error(const float* values, const std::vector<double>& truth) {
    double worst = 0, scale = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        worst = test::larger(worst, std::abs(values[i] - truth[i]));
        scale = std::max(scale, std::abs(truth[i]));
    }
    return worst / scale;
}

struct Case {
    std::uint32_t persons, frames, sequences;
    bool ntu;
    double width;
};

void expect_right(const Case& c, const kernels::Tiles& tiles, kernels::Device& device) {
    const auto weights =
        c.ntu ? eval::random_stgcn_weights(c.persons * 3, 7, eval::ntu_graph(), c.width, 1)
              : eval::random_stgcn_weights(c.persons * 3, 11, {test::small_tree, 0}, c.width, 2);
    eval::StgcnRecogniser recogniser(device, weights, tiles);
    const std::size_t numbers = std::size_t{weights.channels} * c.frames * weights.joints();
    const auto motions = made_motions(c.sequences * numbers, c.frames);
    const auto got = recogniser.recognise(motions, c.sequences, c.frames);
    ASSERT_EQ(got.features.size(), std::size_t{c.sequences} * weights.features());
    ASSERT_EQ(got.logits.size(), std::size_t{c.sequences} * weights.classes);
    const test::PlainRecogniser plain(weights);
    for (std::size_t n = 0; n < c.sequences; n += std::max(1U, c.sequences - 1)) {
        const auto truth = plain(&motions[n * numbers], c.frames);
        EXPECT_LT(relative_error(&got.features[n * weights.features()], truth.features), 2e-5)
            << "frames " << c.frames;
        EXPECT_LT(relative_error(&got.logits[n * weights.classes], truth.logits), 2e-5)
            << "frames " << c.frames;
    }
}

}  // namespace

TEST(Recogniser, AgreesWithThePlainForwardPass) {
    kernels::Device device;
    const auto tiles = kernels::default_tiles(device.info());
    for (const auto& c :
         {Case{1, 64, 3, true, 0.25}, Case{2, 60, 2, true, 0.125}, Case{1, 61, 2, false, 0.125},
          Case{2, 17, 5, false, 0.25}, Case{1, 18, 9, true, 0.125}, Case{1, 19, 17, false, 0.125}})
        expect_right(c, tiles, device);
}

// So few that an interpreter of kernels takes minutes, not hours (./run test --opencl oclgrind).
TEST(Recogniser, AgreesOnAFrameOrTwo) {
    kernels::Device device;
    const auto tiles = kernels::default_tiles(device.info());
    for (const auto& c : {Case{1, 1, 2, true, 0.125}, Case{3, 2, 1, true, 0.2}})
        expect_right(c, tiles, device);
}

TEST(Recogniser, AgreesAtFullWidth) {
    kernels::Device device;
    expect_right({1, 40, 1, true, 1}, kernels::default_tiles(device.info()), device);
}

TEST(Recogniser, AgreesWithEveryShapeOfTiles) {
    kernels::Device device;
    for (const auto& tiles :
         {kernels::Tiles{1, 1, 1, 1, 1, false, 1, 1}, kernels::Tiles{2, 3, 1, 2, 8, true, 1, 2},
          kernels::Tiles{4, 8, 1, 1, 64, true, 1, 64}, kernels::Tiles{4, 4, 2, 2, 32, true, 2, 16},
          kernels::Tiles{8, 6, 2, 5, 4, false, 4, 3}, kernels::Tiles{16, 5, 4, 8, 1, false, 16, 4}})
        expect_right({1, 23, 5, true, 0.125}, tiles, device);
}

TEST(Recogniser, GivesAMotionTheSameNumbersInAnyBatch) {
    kernels::Device device;
    const auto weights = eval::random_stgcn_weights(3, 5, eval::ntu_graph(), 0.25, 3);
    eval::StgcnRecogniser recogniser(device, weights, kernels::default_tiles(device.info()));
    const auto motions = made_motions(21 * 3 * 20 * 25, 4);
    const auto together = recogniser.recognise(motions, 21, 20);
    for (const std::size_t n : {0U, 7U, 20U}) {
        recogniser.recognise(made_motions(4 * 3 * 33 * 25, 5), 4, 33);  // another length in between
        const auto alone = recogniser.recognise(std::span(motions).subspan(n * 1500, 1500), 1, 20);
        for (std::size_t i = 0; i < weights.features(); ++i)
            ASSERT_EQ(alone.features[i], together.features[n * weights.features() + i]);
    }
}

TEST(Recogniser, RefusesMotionsOfAnotherSize) {
    kernels::Device device;
    const auto weights = eval::random_stgcn_weights(3, 5, eval::ntu_graph(), 0.125, 3);
    eval::StgcnRecogniser recogniser(device, weights, kernels::default_tiles(device.info()));
    EXPECT_THROW(recogniser.recognise(made_motions(100, 1), 1, 20), Error);
    EXPECT_THROW(recogniser.recognise(std::span<const float>(), 1, 0), Error);
    EXPECT_TRUE(recogniser.recognise(std::span<const float>(), 0, 20).features.empty());
}

namespace {

std::string refusal_of(const std::filesystem::path& weights) {
    kernels::Device device;
    try {
        eval::open_recogniser(device, weights);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST(Recogniser, IsOpenedByTheKindOfItsWeights) {
    const test::TempDir dir;
    const auto weights = eval::random_stgcn_weights(6, 5, eval::ntu_graph(), 0.125, 3);
    write_stgcn_weights(dir / "w.h5", weights);
    kernels::Device device;
    const auto opened = eval::open_recogniser(device, dir / "w.h5");
    EXPECT_EQ(opened->info().kind, "stgcn");
    EXPECT_EQ(opened->info().representation, ingest::Representation::limb);
    EXPECT_EQ(opened->info().channels, 6U);
    EXPECT_EQ(opened->info().joints(), 25U);
    EXPECT_EQ(opened->info().classes, 5U);
    EXPECT_EQ(opened->info().features, 32U);
    const auto motions = made_motions(2 * 6 * 20 * 25, 6);
    eval::StgcnRecogniser direct(device, weights, kernels::default_tiles(device.info()));
    EXPECT_EQ(opened->recognise(motions, 2, 20).logits, direct.recognise(motions, 2, 20).logits);

    hdf5::Writer other(dir / "gru.h5");
    other.attribute("kind", std::string("transformer"));
    other.finish();
    const auto said = refusal_of(dir / "gru.h5");
    EXPECT_NE(said.find("gru.h5: attribute 'kind' is 'transformer'"), std::string::npos) << said;
    EXPECT_NE(said.find("stgcn"), std::string::npos) << said;
    hdf5::Writer generator(dir / "g.h5");
    generator.attribute("model", std::string("generator"));
    generator.finish();
    EXPECT_NE(refusal_of(dir / "g.h5").find("generator"), std::string::npos) << refusal_of(dir / "g.h5");
}

TEST(Recogniser, OpensWeightsWithoutAKindAsAnStgcn) {
    const test::TempDir dir;
    const auto weights = eval::random_stgcn_weights(3, 4, {test::small_tree, 0}, 0.0625, 3);
    hdf5::Writer file(dir / "public.h5");
    for (const auto& tensor : eval::stgcn_tensors(weights))
        file.write<float>(tensor.name, hdf5::Shape(tensor.shape.begin(), tensor.shape.end()),
                          weights.at(tensor.name));
    file.attribute("channels", std::int64_t{3});
    file.attribute("classes", std::int64_t{4});
    file.attribute("parents", std::vector<std::int64_t>(test::small_tree.begin(), test::small_tree.end()));
    file.attribute("center", std::int64_t{0});
    file.finish();
    kernels::Device device;
    EXPECT_EQ(eval::open_recogniser(device, dir / "public.h5")->info().kind, "stgcn");
}
