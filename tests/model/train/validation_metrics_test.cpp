// Scores of a generator's motions on the way, by a recogniser of joints that the dataset shares with others.
#include <gtest/gtest.h>

#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "model/train/training_data.hpp"
#include "model/train/validation_metrics.hpp"
#include "model/train/window_feed.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer;
using namespace actformer::test;
using namespace actformer::model;

// The common joints of a real window as generated motions are seen, with mean bone lengths, are next to those of the real side, which have
// each body's own.
TEST(ValidationMetrics, SeeTheCommonJointsOfRealAndGeneratedMotionsAlike) {
    constexpr std::uint32_t frames = 16;
    const TempDir dir;
    eval::write_stgcn_weights(
        dir / "common.h5",
        eval::random_stgcn_weights(6, 26, eval::recogniser_graph(ingest::common15().parents), 0.125, 5));
    const ingest::Dataset dataset(toy_pairs());
    const auto clips = ingest::load_view(dataset, "all").store;
    ValidationMetrics metrics(dir / "common.h5", "", dataset, "all", clips, frames);
    Labelled windows;
    for_each_window(clips, 8, frames, [&](const Windows& some) {
        windows.values.insert(windows.values.end(), some.values,
                              some.values + some.count * clips.table().frame_values() * frames);
        windows.labels.insert(windows.labels.end(), some.labels, some.labels + some.count);
    });
    ASSERT_EQ(windows.labels.size(), metrics.real_windows());
    const auto same = metrics.score(windows);
    EXPECT_EQ(same.accuracy, metrics.real_accuracy());
    for (std::size_t i = 0; i < windows.values.size(); i += 2) windows.values[i] *= -1;
    EXPECT_LT(same.fid_whole, 0.01 * metrics.score(windows).fid_whole);
}
