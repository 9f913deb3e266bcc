// `actformer features` as its users meet it, beside the reference program where that can run.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/hdf5/reader.hpp"
#include "eval/scoring/features.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/larger.hpp"
#include "tests/support/plain_recogniser.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/unit_limbs.hpp"

using namespace actformer;
using namespace actformer::test;
using hdf5::Reader;
namespace fs = std::filesystem;

namespace {

ingest::Motion made_motion(std::uint32_t frames, std::uint32_t persons, std::uint32_t joints, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    ingest::Motion motion{"", frames, persons, joints, 3, {}};
    motion.values.resize(std::size_t{frames} * persons * joints * 3);
    for (auto& v : motion.values) v = normal(random);
    make_unit_limbs(motion);
    return motion;
}

/// The largest difference, relative to the largest number there is.
double relative_error(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    double worst = 0, scale = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        worst = larger(worst, std::abs(double{a[i]} - b[i]));
        scale = std::max(scale, std::abs(double{b[i]}));
    }
    return worst / scale;
}

struct Features : testing::Test {
    void weights(std::uint32_t channels, std::uint32_t classes, const eval::Graph& graph) {
        write_stgcn_weights(dir / "w.h5", eval::random_stgcn_weights(channels, classes, graph, 0.125, 5));
    }
    void motions(const std::vector<std::pair<std::string, std::uint32_t>>& frames, std::uint32_t persons = 1,
                 std::uint32_t joints = 25) {
        ingest::MotionsWriter writer(dir / "m.h5");
        for (unsigned i = 0; i < frames.size(); ++i)
            writer.add(frames[i].first, made_motion(frames[i].second, persons, joints, i));
        writer.finish();
    }
    CommandResult features(const std::string& input, const std::string& more = "") {
        return run_actformer("features --recogniser " + at("w.h5") + " " + at(input) + " -o " + at("f.h5") +
                             " " + more);
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }

    void expect_refused(const CommandResult& result, const std::vector<std::string>& words) {
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto& word : words)
            EXPECT_NE(result.output.find(word), std::string::npos) << word << ": " << result.output;
        EXPECT_FALSE(fs::exists(at("f.h5")));
        EXPECT_FALSE(fs::exists(at("f.h5.partial")));
    }

    TempDir dir;
};

/// A dataset of synthetic clips, made once.
const fs::path& dataset() {
    static const TempDir dir;
    static const fs::path folder = [] {
        run_actformer("synth ntu -o " + (dir / "raw").string() + " --clips 24 --actions 1-6,50-52");
        run_actformer("ingest ntu " + (dir / "raw").string() + " -o " + (dir / "out").string());
        return dir / "out";
    }();
    return folder;
}

bool has_torch() {
    static const bool has = fs::exists(shared("reference/stgcn.py")) && has_eager_pytorch();
    return has;
}

}  // namespace

TEST_F(Features, TakeEveryMotionAtItsFullLength) {
    weights(6, 4, eval::ntu_graph());
    motions({{"A001_0", 20}, {"A001_1", 33}, {"A002_0", 20}, {"A004_0", 7}}, 2);
    const auto result = features("m.h5", "--json");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["sequences"], 4);
    EXPECT_EQ(json["features"], 32);

    const Reader file(dir / "f.h5");
    EXPECT_EQ(file.read_strings("names"), (std::vector<std::string>{"A001_0", "A001_1", "A002_0", "A004_0"}));
    EXPECT_EQ(file.read<std::uint32_t>("labels"), (std::vector<std::uint32_t>{0, 0, 1, 3}));
    const auto got = file.read<float>("features"), logits = file.read<float>("logits");
    const auto recogniser = eval::read_stgcn_weights(dir / "w.h5");
    const PlainRecogniser plain(recogniser);
    const ingest::MotionsFile stored(dir / "m.h5");
    for (std::size_t i = 0; i < 4; ++i) {
        const auto motion = stored.read(stored.names()[i]);
        std::vector<float> x;
        for (std::size_t p = 0; p < 2; ++p)
            for (std::size_t d = 0; d < 3; ++d)
                for (std::size_t t = 0; t < motion.frames; ++t)
                    for (std::size_t k = 0; k < 25; ++k) x.push_back(motion.at(t, p, k)[d]);
        const auto truth = plain(x.data(), motion.frames);
        for (std::size_t c = 0; c < 32; ++c) ASSERT_NEAR(got[i * 32 + c], truth.features[c], 1e-4);
        for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(logits[i * 4 + c], truth.logits[c], 1e-4);
    }
}

TEST_F(Features, DependOnTheFramesAskedForAndNotOnTheBatch) {
    weights(3, 4, {small_tree, 0});
    motions({{"walk", 20}, {"run", 33}, {"sit", 25}}, 1, 21);
    ASSERT_EQ(features("m.h5", "--frames 20").exit, 0);
    const auto cropped = Reader(dir / "f.h5").read<float>("features");
    EXPECT_FALSE(Reader(dir / "f.h5").has("labels")) << "these names tell no action";
    ASSERT_EQ(features("m.h5", "--frames 20 --batch 1").exit, 0);
    EXPECT_EQ(Reader(dir / "f.h5").read<float>("features"), cropped);
    const auto bytes = read_file(dir / "f.h5");
    ASSERT_EQ(features("m.h5", "--frames 20 --batch 1").exit, 0);
    EXPECT_EQ(read_file(dir / "f.h5"), bytes);
    ASSERT_EQ(features("m.h5").exit, 0);
    EXPECT_NE(Reader(dir / "f.h5").read<float>("features"), cropped);
}

TEST_F(Features, CutDatasetsIntoWindows) {
    const ingest::Dataset data(dataset() / "ntu-2p");
    weights(6, static_cast<std::uint32_t>(data.header().classes.size()), eval::ntu_graph());
    fs::create_symlink(dataset() / "ntu-2p", dir / "data");
    const auto result = features("data", "--window 40");
    ASSERT_EQ(result.exit, 0) << result.output;
    std::size_t windows = 0;
    for (const auto& clip : data.clips()) windows += std::max(1U, clip.frames / 40);
    const Reader file(dir / "f.h5");
    EXPECT_EQ(file.shape("features"), (hdf5::Shape{windows, 32}));
    EXPECT_EQ(file.read<std::uint32_t>("labels").front(), data.clips()[0].label);
    EXPECT_EQ(file.read_strings("names").front(), data.clips()[0].name + "@0");
}

TEST_F(Features, RefuseWhatDoesNotFit) {
    weights(3, 4, eval::ntu_graph());
    motions({{"A001_0", 20}}, 2);
    expect_refused(features("m.h5"), {"m.h5", "A001_0", "6 channels"});
    motions({{"A001_0", 20}}, 1, 24);
    expect_refused(features("m.h5"), {"m.h5", "A001_0", "24 joints"});
    motions({{"A001_0", 20}, {"A002_0", 9}});
    expect_refused(features("m.h5", "--frames 10"), {"A002_0", "9 frames"});
    motions({{"A005_0", 20}});
    expect_refused(features("m.h5"), {"A005_0", "4 classes"});
    auto broken = made_motion(5, 1, 25, 1);
    broken.values[7] = std::nanf("");
    ingest::MotionsWriter writer(dir / "m.h5");
    writer.add("A001_0", broken);
    writer.finish();
    expect_refused(features("m.h5"), {"A001_0", "finite"});
    expect_refused(features("none.h5"), {"none.h5"});
    write_file(dir / "m.h5", "text");
    expect_refused(features("m.h5"), {"m.h5", "HDF5"});
    write_file(dir / "w.h5", "text");
    expect_refused(features("m.h5"), {"w.h5", "HDF5"});
}

TEST_F(Features, ReplaceFeaturesAndNoFilesOfOthers) {
    weights(3, 4, eval::ntu_graph());
    motions({{"A001_0", 20}});
    const auto shard = dataset() / "ntu-1p/shard-00000.h5";
    for (const auto& other : {shard, dir / "w.h5", dir / "m.h5"}) {
        fs::copy_file(other, dir / "f.h5");
        test::expect_refused(features("m.h5"), {"f.h5: is there, and holds no features", "--force"});
        EXPECT_EQ(read_file(dir / "f.h5"), read_file(other));
        fs::remove(dir / "f.h5");
    }
    write_file(dir / "f.h5", "years of work");
    test::expect_refused(features("m.h5"), {"f.h5: is there"});
    ASSERT_EQ(features("m.h5", "--force").exit, 0);
    ASSERT_EQ(features("m.h5", "--frames 10").exit, 0) << "features, now";
    EXPECT_EQ(Reader(dir / "f.h5").attribute_numbers("frames").front(), 10);
}

TEST_F(Features, RefuseDatasetsOfAnotherKind) {
    fs::create_symlink(dataset() / "ntu-1p", dir / "data");
    const auto classes = static_cast<std::uint32_t>(ingest::Dataset(dir / "data").header().classes.size());
    weights(6, classes, eval::ntu_graph());
    expect_refused(features("data"), {"data", "persons"});
    weights(3, classes, {small_tree, 0});
    expect_refused(features("data"), {"data", "25 joints"});
    weights(3, classes + 1, eval::ntu_graph());
    expect_refused(features("data"), {"data", "classes"});
    auto other = eval::ntu_graph();
    other.parents[24] = 0;
    weights(3, classes, other);
    expect_refused(features("data"), {"data", "another tree"});
    weights(3, classes, eval::ntu_graph());
    expect_refused(features("data", "--split nowhere"), {"nowhere"});
    ASSERT_EQ(features("data").exit, 0);
}

TEST_F(Features, AgreeWithTheReference) {
    if (!has_torch())
        GTEST_SKIP() << "needs " << shared("reference/stgcn.py") << ", and python3 with torch and h5py";
    struct Case {
        std::uint32_t persons, frames;
        bool ntu;
        double width;
    };
    const std::vector<Case> cases{
        {1, 64, true, 1}, {1, 60, false, 1}, {2, 61, true, 0.25}, {1, 17, true, 1}, {2, 1, false, 0.5}};
    std::string lines;  // of arguments: one Python, which loads torch once, takes them all
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto& c = cases[i];
        const auto graph = c.ntu ? eval::ntu_graph() : eval::Graph{small_tree, 0};
        write_stgcn_weights(dir / "w.h5", eval::random_stgcn_weights(3 * c.persons, 94, graph, c.width, 8));
        motions({{"a", c.frames}, {"b", c.frames + 3}, {"c", c.frames}, {"d", c.frames + 3}, {"e", c.frames}},
                c.persons, graph.joints());
        const auto frames = "--frames " + std::to_string(c.frames);
        ASSERT_EQ(features("m.h5", frames).exit, 0);
        const auto kept = [&](const std::string& name) { return at(std::to_string(i) + name); };
        for (const std::string name : {"w.h5", "m.h5", "f.h5"}) fs::rename(at(name), kept(name));
        lines += fmt::format("features {} {} {} {}\n", kept("w.h5"), kept("m.h5"), kept("o.h5"), frames);
    }
    write_file(dir / "lines", lines);
    write_file(dir / "all.py",
               "import runpy, sys\n"
               "program, lines = sys.argv[1:]\n"
               "for line in open(lines):\n"
               "    sys.argv = [program, *line.split()]\n"
               "    runpy.run_path(program, run_name='__main__')\n");
    const auto oracle = run_command("OMP_NUM_THREADS=2 /usr/bin/python3 " + at("all.py") + " " +
                                    shared("reference/stgcn.py") + " " + at("lines"));
    ASSERT_EQ(oracle.exit, 0) << oracle.output;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Reader ours(dir / (std::to_string(i) + "f.h5")), theirs(dir / (std::to_string(i) + "o.h5"));
        for (const auto* name : {"features", "logits"})
            EXPECT_LT(relative_error(ours.read<float>(name), theirs.read<float>(name)), 1e-4)
                << name << ' ' << cases[i].frames;
    }
}
