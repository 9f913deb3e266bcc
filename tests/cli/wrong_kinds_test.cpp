// Paths of the wrong kind: the answer says what lies there, and nothing in it changes.
#include <gtest/gtest.h>

#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/toy_recogniser.hpp"
#include "tests/support/tree.hpp"

namespace actformer::test {
namespace {

namespace fs = std::filesystem;

/// Of a plan, whose lines name the faults above the last.
void expect_words(const CommandResult& result, const std::vector<std::string>& words) {
    EXPECT_EQ(result.exit, 1) << result.output;
    for (const auto& word : words)
        EXPECT_NE(result.output.find(word), std::string::npos) << word << ": " << result.output;
}

struct WrongKinds : testing::Test {
    void SetUp() override {
        write_toy_recogniser(toy(), dir / "r.h5");
        fs::copy(toy(), dir / "toy");
        write_file(dir / "trained/config.yaml", "model: recogniser\n");
        write_file(dir / "trained/log.jsonl", "");
        write_file(dir / "swept/results.json", "{}");
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }
    void export_motions() const {
        ASSERT_EQ(run_actformer("export " + at("toy") + " --split s/test -o " + at("m.h5")).exit, 0);
    }
    void refused(const std::string& arguments, const std::vector<std::string>& words) const {
        SCOPED_TRACE(arguments);
        expect_refused(run_actformer(arguments), words);
    }
    TempDir dir;
};

TEST_F(WrongKinds, WeightsFeaturesAndShardsAreNoMotions) {
    refused("render " + at("r.h5") + " -o " + at("a.png"), {"r.h5: a recogniser's weights, not motions"});
    refused("export " + at("r.h5") + " -o " + at("a.glb"), {"r.h5: a recogniser's weights, not motions"});
    refused("inspect " + at("toy/shard-00000.h5"),
            {"shard-00000.h5: a dataset's shard, not motions", "its folder"});
    const auto of_toy = "--recogniser " + at("r.h5") + " --real " + at("toy") + " --split s/train ";
    refused("score " + of_toy + "--generated " + at("r.h5"), {"r.h5: a recogniser's weights, not motions"});
    ASSERT_EQ(run_actformer("features --recogniser " + at("r.h5") + " " + at("toy") + " --split s/test -o " +
                            at("f.h5"))
                  .exit,
              0);
    refused("classify --recogniser " + at("r.h5") + " " + at("f.h5"), {"f.h5: features, not motions"});
    refused("classify --recogniser " + at("toy") + " " + at("f.h5"),
            {"toy: a dataset; a training or weights"});
}

TEST_F(WrongKinds, MotionsAreNoWeightsAndNoFeatures) {
    export_motions();
    const auto features = [&](const std::string& recogniser) {
        return "features --recogniser " + at(recogniser) + " " + at("m.h5") + " -o " + at("f.h5");
    };
    refused(features("m.h5"),
            {"m.h5: holds motions, not a recogniser's weights; give a recogniser's training or its weights"});
    ASSERT_EQ(run_actformer(features("r.h5")).exit, 0);
    refused("classify --recogniser " + at("f.h5") + " " + at("m.h5"),
            {"f.h5: holds features, not a recogniser's weights"});
    const auto score = [&](const std::string& real, const std::string& generated) {
        return "score --real-features " + at(real) + " --generated-features " + at(generated);
    };
    refused(score("m.h5", "f.h5"),
            {"m.h5: holds motions, not features; give what `actformer features` makes"});
    refused(score("f.h5", "r.h5"), {"r.h5: holds a recogniser's weights, not features"});
}

TEST_F(WrongKinds, FoldersOfOthersAreNoPlaceToWrite) {
    const auto before = tree(dir.path());
    for (const auto* folder : {"toy", "trained", "swept"})
        refused("synth ntu --clips 2 -o " + at(folder),
                {folder, "not synthetic raw data; choose another -o"});
    refused("sweep mini --dry-run -o " + at("toy"), {"toy: holds a dataset, not a sweep"});
    refused("sweep mini --dry-run -o " + at("r.h5"), {"r.h5: a file, and a folder is expected"});
    EXPECT_EQ(tree(dir.path()), before);
}

TEST_F(WrongKinds, ATrainingStaysOutOfADataset) {
    if (!fs::exists(program() + "-train")) GTEST_SKIP() << "built without libtorch";
    const auto before = tree(dir.path());
    for (const auto* folder : {"toy", "swept"})
        refused("train recogniser -c recogniser-small --data " + at("toy") + " train_split=s/train -o " +
                    at(folder),
                {folder, "not a training; choose another -o"});
    EXPECT_EQ(tree(dir.path()), before);
}

TEST_F(WrongKinds, ASweepsPlanLooksAtThem) {
    const auto sweep_of = [&](const std::string& path, const std::string& recogniser,
                              const std::string& weights) {
        write_file(dir / "s.yaml",
                   "datasets: {toy: {path: " + path + "}}\nrecognisers: {toy: {weights: " + recogniser +
                       "}}\nrows: {a: {data: toy, recogniser: toy, split: s/train, weights: " + weights +
                       "}}\n");
        return run_actformer("sweep " + at("s.yaml") + " --dry-run -o " + at("out"));
    };
    export_motions();
    const std::string generator = "weights/cmu/actformer.h5";
    expect_words(sweep_of("toy", "r.h5", "r.h5"),
                 {"r.h5: holds a recogniser's weights, not a generator's weights"});
    expect_words(sweep_of("toy", "r.h5", "toy"), {"toy: holds a dataset, not a generator's weights"});
    expect_words(sweep_of("toy", generator, generator),
                 {"actformer.h5: holds a generator's weights, not a recogniser's weights"});
    expect_words(sweep_of("trained", "r.h5", generator), {"trained: holds a training, not a dataset"});
}

TEST_F(WrongKinds, ASweepsPlanLooksIntoFilesAndTrainings) {
    export_motions();
    fs::create_symlink("m.h5", dir / "link.h5");
    const auto sweep_of = [&](const std::string& recogniser, const std::string& made_by) {
        write_file(dir / "s.yaml",
                   "datasets: {toy: {path: toy}}\nrecognisers: {toy: {weights: " + recogniser +
                       "}}\nrows: {a: {data: toy, recogniser: toy, split: s/train, " + made_by + "}}\n");
        return run_actformer("sweep " + at("s.yaml") + " --dry-run -o " + at("out"));
    };
    EXPECT_EQ(sweep_of("r.h5", "motions: m.h5").exit, 0);
    expect_words(sweep_of("r.h5", "motions: toy"), {"toy: a folder; a file of motions (.h5) is expected"});
    expect_words(sweep_of("r.h5", "motions: r.h5"), {"r.h5: a recogniser's weights, not motions"});
    expect_words(sweep_of("r.h5", "motions: toy/shard-00000.h5"), {"a dataset's shard, not motions"});
    expect_words(sweep_of("r.h5", "motions: [m.h5, m.h5]"), {"m.h5: given twice in motions"});
    expect_words(sweep_of("r.h5", "motions: [m.h5, link.h5]"), {"link.h5: given twice in motions"});
    expect_words(sweep_of("m.h5", "motions: m.h5"), {"m.h5: holds motions, not a recogniser's weights"});
    expect_words(sweep_of("r.h5", "weights: m.h5"), {"m.h5: holds motions, not a generator's weights"});
    expect_words(sweep_of("trained", "motions: m.h5"), {"trained: holds no weights-*.h5"});
    fs::copy(source("weights/cmu/actformer.h5"), dir / "trained/weights-last.h5");
    expect_words(sweep_of("trained", "motions: m.h5"),
                 {"weights-last.h5: holds a generator's weights, not a recogniser's weights"});
}

TEST_F(WrongKinds, AComparisonLooksBeforeItScores) {
    export_motions();
    const auto with = [&](const std::string& a, const std::string& recogniser, const std::string& split) {
        return "compare " + a + " " + at("m.h5") + " --recogniser " + recogniser + " --real " + at("toy") +
               " --split " + split + " -o " + at("c");
    };
    refused(with(at("r.h5"), at("r.h5"), "s/train"), {"r.h5: a recogniser's weights; a generator"});
    refused(with(at("toy"), at("r.h5"), "s/train"), {"toy: a dataset; a generator"});
    refused(with(at("m.h5"), at("r.h5"), "s/trian"), {"no split 's/trian'", "did you mean s/train?"});
    refused(with(at("m.h5"), at("toy"), "s/train"), {"toy: holds a dataset, not a recogniser's weights"});
    EXPECT_FALSE(fs::exists(dir / "c"));
}

TEST_F(WrongKinds, EndingsOfOtherFilesAreRefused) {
    const std::vector<std::string> calls{"features --recogniser r.h5 toy -o a.csv",
                                         "classify --recogniser r.h5 toy -o a.h5",
                                         "report x -o a.tex",
                                         "report x --csv a.html",
                                         "report x --latex a.html",
                                         "score --real-features f.h5 --generated-features f.h5 -o a.html",
                                         "import recogniser " + at("r.h5") + " --data toy -o a.gif"};
    for (const auto& call : calls) refused(call, {"the file written is not a ", "let its name end in "});
    export_motions();
    ASSERT_EQ(
        run_actformer("classify --recogniser " + at("r.h5") + " " + at("m.h5") + " -o " + at("plain")).exit,
        0);
}

TEST_F(WrongKinds, KeptFeaturesTakeNoMotionsPlace) {
    export_motions();
    fs::create_directory(dir / "kept");
    fs::copy(dir / "m.h5", dir / "kept/generated.h5");
    const auto motions = read_file(dir / "m.h5");
    const auto score = "score --recogniser " + at("r.h5") + " --real " + at("toy") +
                       " --split s/train --generated " + at("m.h5") + " --keep-features " + at("kept") +
                       " -o " + at("s.json");
    refused(score, {"kept/generated.h5: is there, and holds no features", "--force"});
    EXPECT_EQ(read_file(dir / "kept/generated.h5"), motions);
    EXPECT_EQ(run_actformer(score + " --force").exit, 0);
    EXPECT_EQ(run_actformer(score).exit, 0) << "features of its own are replaced";
}

TEST_F(WrongKinds, AClassWithoutAClipIsToldWithThoseThatHaveSome) {
    ASSERT_EQ(run_actformer("export " + at("toy") + " --class c1 -o " + at("m.h5")).exit, 0);
    refused("export " + at("m.h5") + " --class c2 -o " + at("a.glb"),
            {"no clip of class 'c2'; it has clips of c1"});
}

}  // namespace
}  // namespace actformer::test
