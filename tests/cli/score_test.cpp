// `actformer score` as its users meet it, beside the reference program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/checksum/checksum.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "eval/metrics/confusion.hpp"
#include "eval/scoring/features_file.hpp"
#include "eval/scoring/measures_file.hpp"
#include "eval/scoring/motions_file_source.hpp"
#include "eval/scoring/score.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/common_joints.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/made_dataset.hpp"
#include "tests/support/odd_split.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/unit_limbs.hpp"

using namespace actformer;
using namespace actformer::test;
using hdf5::Reader;
namespace fs = std::filesystem;

namespace {

ingest::Motion made_motion(std::uint32_t frames, std::uint32_t persons, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    ingest::Motion motion{"", frames, persons, 25, 3, {}};
    motion.values.resize(std::size_t{frames} * persons * 25 * 3);
    for (auto& v : motion.values) v = normal(random);
    make_unit_limbs(motion);
    return motion;
}

/// Datasets of synthetic clips, made once: ntu-1p of classes 1 to 4, ntu-2p of classes 1 and 2.
const fs::path& datasets() {
    static const TempDir dir;
    static const fs::path folder = [] {
        run_actformer("synth ntu -o " + (dir / "raw").string() + " --clips 60 --actions 1-4,50-51");
        run_actformer("ingest ntu " + (dir / "raw").string() + " -o " + (dir / "out").string());
        return dir / "out";
    }();
    return folder;
}

struct Score : testing::Test {
    void SetUp() override {
        one_person_classes = classes_of("ntu-1p");
        write_stgcn_weights(dir / "one.h5",
                            eval::random_stgcn_weights(3, one_person_classes, eval::ntu_graph(), 0.125, 1));
        write_stgcn_weights(dir / "two.h5",
                            eval::random_stgcn_weights(6, classes_of("ntu-2p"), eval::ntu_graph(), 0.125, 2));
    }
    static std::uint32_t classes_of(const char* name) {
        return static_cast<std::uint32_t>(ingest::Dataset(datasets() / name).header().classes.size());
    }

    /// `each` motions of the first `classes` classes.
    void motions(const std::string& file, unsigned classes, unsigned each, std::uint32_t persons = 1,
                 unsigned seed = 1, std::uint32_t frames = 60) {
        ingest::MotionsWriter writer(dir / file);
        for (unsigned c = 0; c < classes; ++c)
            for (unsigned i = 0; i < each; ++i)
                writer.add(fmt::format("A{:03}_{}", c + 1, i),
                           made_motion(frames, persons, seed * 1000 + c * 100 + i));
        writer.finish();
    }
    void features(const std::string& file, const std::vector<std::uint32_t>& labels,
                  std::size_t dimensions = 8, std::uint32_t classes = 3, unsigned seed = 1) {
        eval::FeaturesFile out(dir / file, labels.size(), dimensions, classes);
        std::mt19937 random(seed);
        std::normal_distribution<float> normal;
        std::vector<float> values(labels.size() * dimensions), logits(labels.size() * classes);
        for (auto& v : values) v = normal(random);
        for (auto& v : logits) v = normal(random);
        out.add(0, values, logits);
        out.labels(labels);
        out.finish();
    }

    std::string at(const std::string& name) const { return (dir / name).string(); }
    CommandResult score(const std::string& arguments) const {
        return run_command("XDG_CACHE_HOME=" + at("cache") + " " + program() + " score " + arguments);
    }
    nlohmann::json scored(const std::string& arguments) const {
        const auto result = score(arguments + " --json");
        EXPECT_EQ(result.exit, 0) << result.output;
        return nlohmann::json::parse(result.output, nullptr, false);
    }
    std::string one_person() const {
        return "--recogniser " + at("one.h5") + " --real " + (datasets() / "ntu-1p").string() + " ";
    }
    std::string two_persons() const {
        return "--recogniser " + at("two.h5") + " --real " + (datasets() / "ntu-2p").string() + " ";
    }

    void expect_refused(const std::string& arguments, const std::vector<std::string>& words) const {
        const auto result = score(arguments + " -o " + at("refused.json"));
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto& word : words)
            EXPECT_NE(result.output.find(word), std::string::npos) << word << ": " << result.output;
        EXPECT_FALSE(fs::exists(at("refused.json")));
    }

    nlohmann::json oracle(const std::string& real, const std::string& made) const {
        const auto result =
            run_command("/usr/bin/python3 " + shared("reference/fid.py") + " " + at(real) + " " + at(made));
        EXPECT_EQ(result.exit, 0) << result.output;
        return nlohmann::json::parse(result.output, nullptr, false);
    }

    std::uint32_t one_person_classes = 0;
    TempDir dir;
};

void expect_near(const nlohmann::json& ours, const nlohmann::json& theirs) {
    EXPECT_NEAR(ours["mean"].get<double>(), theirs.get<double>(), 1e-6 * std::abs(theirs.get<double>()));
}

std::vector<std::uint32_t> labels_of(const std::vector<std::size_t>& counts) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t c = 0; c < counts.size(); ++c) out.insert(out.end(), counts[c], c);
    return out;
}

}  // namespace

TEST_F(Score, OfMotionsAgreesWithTheReference) {
    if (!has_reference_python()) GTEST_SKIP() << "needs " << shared("reference") << ", and python3 with h5py";
    motions("m.h5", 4, 6);
    const auto json = scored(one_person() + "--generated " + at("m.h5") + " --keep-features " + at("kept"));
    const auto theirs = oracle("kept/real.h5", "kept/generated.h5");
    expect_near(json["accuracy"], theirs["accuracy"]);
    expect_near(json["fid_mean"], theirs["fid_mean"]);
    expect_near(json["fid_whole"], theirs["fid_whole"]);
    EXPECT_TRUE(json["fid_mean"]["ci95"].is_null()) << "one repeat tells nothing of the spread";
    EXPECT_FALSE(json.contains("fida_mean"));
    EXPECT_EQ(json["per_class"].size(), one_person_classes);
    EXPECT_EQ(json["left_out"].size(), one_person_classes - 4) << "classes without clips";
    EXPECT_GT(json["floor"]["fid_mean"], 0)
        << "of halves of the real clips; the weights are random, so that noise may be nearer";
    EXPECT_EQ(json["provenance"]["real"]["fingerprint"],
              ingest::Dataset(datasets() / "ntu-1p").fingerprint());
    std::uint64_t counted = 0;
    for (const auto& row : json["confusion"])
        for (const auto& n : row) counted += n.get<std::uint64_t>();
    EXPECT_EQ(counted, 24U);
}

namespace {

/// The one-person recogniser's features of groups by hand: a motions file with every person apart, `actformer features` over
/// it, and the maximum over the persons.
void group_features(const TempDir& dir, const std::vector<ingest::Motion>& groups,
                    const std::vector<std::uint32_t>& labels, const std::string& out) {
    ingest::MotionsWriter writer(dir / "apart.h5");
    for (std::size_t i = 0; i < groups.size(); ++i)
        for (std::uint32_t p = 0; p < groups[i].persons; ++p) {
            ingest::Motion alone{"", groups[i].frames, 1, groups[i].nodes, 3, {}};
            for (std::uint32_t t = 0; t < alone.frames; ++t)
                for (std::uint32_t k = 0; k < alone.nodes; ++k)
                    for (std::size_t d = 0; d < 3; ++d) alone.values.push_back(groups[i].at(t, p, k)[d]);
            writer.add(fmt::format("{:06}_{}", i, p), alone);
        }
    writer.finish();
    const auto made = run_actformer("features --recogniser " + (dir / "one.h5").string() + " " +
                                    (dir / "apart.h5").string() + " -o " + (dir / "alone.h5").string());
    ASSERT_EQ(made.exit, 0) << made.output;
    const Reader file(dir / "alone.h5");
    const auto alone = file.read<float>("features");
    const auto d = file.shape("features")[1], persons = file.shape("features")[0] / groups.size();
    std::vector<float> largest;
    for (std::size_t i = 0; i < groups.size(); ++i)
        for (std::size_t c = 0; c < d; ++c) {
            float most = -1e30F;
            for (std::size_t p = 0; p < persons; ++p) most = std::max(most, alone[(i * persons + p) * d + c]);
            largest.push_back(most);
        }
    eval::FeaturesFile features(dir / out, groups.size(), d, 1);
    features.add(0, largest, std::vector<float>(groups.size(), 0.0F));
    features.labels(labels);
    features.finish();
}

}  // namespace

TEST_F(Score, OfGroupsSeesEveryPersonAlone) {
    if (!has_reference_python()) GTEST_SKIP() << "needs " << shared("reference") << ", and python3 with h5py";
    motions("m.h5", 2, 5, 2, 1, 20);
    const auto json = scored(two_persons() + "--window 20 --single-recogniser " + at("one.h5") +
                             " --generated " + at("m.h5"));
    const ingest::Dataset data(datasets() / "ntu-2p");
    std::vector<ingest::Motion> windows, generated;
    std::vector<std::uint32_t> real_labels, labels;
    for (std::size_t c = 0; c < data.clips().size(); ++c) {
        const auto clip = data.motion(c);
        for (std::uint32_t first = 0; first + 20 <= clip.frames; first += 20) {
            ingest::Motion window{"", 20, 2, 25, 3, {}};
            const auto begin = clip.values.begin() + first * 150;
            window.values.assign(begin, begin + 20 * 150);
            windows.push_back(window);
            real_labels.push_back(data.clips()[c].label);
        }
    }
    const ingest::MotionsFile stored(dir / "m.h5");
    for (const auto& name : stored.names()) {
        generated.push_back(stored.read(name));
        labels.push_back(name[3] - '1');
    }
    group_features(dir, windows, real_labels, "r.h5");
    group_features(dir, generated, labels, "g.h5");
    const auto theirs = oracle("r.h5", "g.h5");
    // float features of batches of other sizes are the same: the distances are those of the same numbers
    expect_near(json["fida_mean"], theirs["fid_mean"]);
    expect_near(json["fida_whole"], theirs["fid_whole"]);
    EXPECT_NE(json["fida_whole"], json["fid_whole"]);
}

/// The two-person dataset as what a recogniser of the common joints sees of it.
void write_common_joints(const fs::path& folder) {
    const ingest::Dataset data(datasets() / "ntu-2p");
    std::vector<MadeClip> clips;
    for (std::size_t c = 0; c < data.clips().size(); ++c) {
        auto clip = data.clips()[c];
        const auto seen = ingest::CommonJoints(data.body(c), "").of(data.motion(c));
        clips.push_back({clip, seen, std::vector<float>(2 * 15, 0.3F)});
        clips.back().motion.name = clip.name;
    }
    auto header = data.header();
    header.topology = ingest::common15();
    header.centre_windows = true;
    write_dataset(folder, header, clips);
}

TEST_F(Score, OfGroupsAloneSeesTheCommonJointsOfAnySkeleton) {
    const auto seen = (dir / "seen").string(), real = (datasets() / "ntu-2p").string();
    write_common_joints(seen);
    write_stgcn_weights(
        dir / "common.h5",
        eval::random_stgcn_weights(3, 7, eval::recogniser_graph(ingest::common15().parents), 0.125, 3));
    const ingest::Dataset data(real);
    const auto subjects = ingest::subjects_of(data);
    ingest::MotionsWriter own(dir / "own.h5"), common(dir / "common-motions.h5");
    own.describe(subjects);
    for (unsigned i = 0; i < 12; ++i) {
        const auto name = fmt::format("A{:03}_{}", i % 2 + 1, i / 2);
        const auto motion = made_motion(60, 2, i);
        own.add(name, motion);
        common.add(name, ingest::CommonJoints(subjects, "").of(motion));
    }
    own.finish();
    common.finish();
    const auto single = "--single-recogniser " + at("common.h5") + " --real ";
    const auto of_own = scored(single + real + " --generated " + at("own.h5")),
               of_common = scored(single + seen + " --generated " + at("common-motions.h5"));
    EXPECT_EQ(of_own["fida_whole"], of_common["fida_whole"]) << "the same numbers are seen";
    EXPECT_EQ(of_own["fida_mean"], of_common["fida_mean"]);
    EXPECT_GT(of_own["fida_whole"]["mean"], 0);
    for (const auto* other : {"accuracy", "fid_mean", "fid_whole", "diversity", "multimodality"})
        EXPECT_FALSE(of_own.contains(other)) << other;
    EXPECT_FALSE(of_own["per_class"][0]["fida"].is_null());
    EXPECT_TRUE(of_own["per_class"][0]["fid"].is_null());
    EXPECT_TRUE(of_own["per_class"][0]["floor"].is_null()) << "that of the FID";
    EXPECT_GT(of_own["per_class"][0]["fida_floor"], 0);
    motions("bare.h5", 2, 3, 2);
    expect_refused(single + real + " --generated " + at("bare.h5"),
                   {"bare.h5", "not known", "15 common joints"});
}

TEST_F(Score, OfFeaturesNeedsNoRecogniser) {
    if (!has_reference_python()) GTEST_SKIP() << "needs " << shared("reference") << ", and python3 with h5py";
    features("r.h5", labels_of({30, 40, 12}), 32, 3, 1);
    features("g.h5", labels_of({20, 9, 50}), 32, 3, 2);
    const auto json = scored("--real-features " + at("r.h5") + " --generated-features " + at("g.h5"));
    const auto theirs = oracle("r.h5", "g.h5");
    expect_near(json["accuracy"], theirs["accuracy"]);
    expect_near(json["fid_mean"], theirs["fid_mean"]);
    expect_near(json["fid_whole"], theirs["fid_whole"]);
    EXPECT_NE(json["warnings"][0].get<std::string>().find("A001 (30 real, 20 generated)"), std::string::npos)
        << "few samples are warned of with numbers: " << json["warnings"];
    const auto text = score("--real-features " + at("r.h5") + " --generated-features " + at("g.h5"));
    EXPECT_NE(text.output.find("FIDm"), std::string::npos) << text.output;
    EXPECT_NE(text.output.find("real against real"), std::string::npos) << text.output;
}

TEST_F(Score, ReadsFeaturesThatAnotherToolWrote) {
    if (!has_reference_python()) GTEST_SKIP() << "needs " << shared("reference") << ", and python3 with h5py";
    // Double precision, whole numbers of another size, names of any length: what h5py writes unasked. The distance is a
    // millionth of the features' size, out of single precision's reach.
    write_file(dir / "write.py",
               "import sys, h5py, numpy as np\n"
               "random = np.random.default_rng(1)\n"
               "labels = np.repeat([0, 1], 40)\n"
               "base = random.normal(size=(80, 12)) + 1000\n"
               "for path, shift in ((sys.argv[1], 0), (sys.argv[2], 1e-3)):\n"
               "    with h5py.File(path, 'w') as f:\n"
               "        f['features'] = base + shift\n"
               "        f['logits'] = random.normal(size=(80, 2))\n"
               "        f['labels'] = labels\n"
               "        f['names'] = [f'walk{i // 2}@{60 * (i % 2)}' for i in range(80)]\n");
    ASSERT_EQ(run_command("/usr/bin/python3 " + at("write.py") + " " + at("r.h5") + " " + at("g.h5")).exit,
              0);
    const auto json = scored("--real-features " + at("r.h5") + " --generated-features " + at("g.h5"));
    expect_near(json["fid_mean"], oracle("r.h5", "g.h5")["fid_mean"]);
    EXPECT_NEAR(json["fid_whole"]["mean"].get<double>(), 12e-6, 1e-10);
    EXPECT_EQ(json["floor"]["samples"].get<int>() % 2, 0) << "both windows of a clip on one side";
}

TEST_F(Score, OfIdenticalFeaturesIsNothing) {
    features("r.h5", labels_of({30, 5, 12}), 16);
    const auto json = scored("--real-features " + at("r.h5") + " --generated-features " + at("r.h5"));
    EXPECT_EQ(json["fid_mean"]["mean"], 0);
    EXPECT_EQ(json["fid_whole"]["mean"], 0);
}

TEST_F(Score, LeavesOutAndNamesClassesOfOneSample) {
    features("r.h5", labels_of({30, 1, 12, 8}), 8, 4, 1);
    features("g.h5", labels_of({20, 9, 1, 7}), 8, 4, 2);
    const auto json = scored("--real-features " + at("r.h5") + " --generated-features " + at("g.h5"));
    ASSERT_EQ(json["left_out"].size(), 2U);
    EXPECT_EQ(json["left_out"][0]["class"], "A002");
    EXPECT_EQ(json["left_out"][0]["real"], 1);
    EXPECT_EQ(json["left_out"][1]["class"], "A003");
    EXPECT_EQ(json["left_out"][1]["generated"], 1);
    EXPECT_TRUE(json["per_class"][1]["fid"].is_null());
    EXPECT_NEAR(json["fid_mean"]["mean"].get<double>(),
                (json["per_class"][0]["fid"].get<double>() + json["per_class"][3]["fid"].get<double>()) / 2,
                1e-9);
    EXPECT_NE(json["warnings"][0].get<std::string>().find("A002 (1 real, 9 generated)"), std::string::npos);
}

TEST_F(Score, SaysWhatFidAtInfinityNeeds) {
    features("r.h5", labels_of({7, 3}), 8, 2, 1);
    features("g.h5", labels_of({5, 9}), 8, 2, 2);
    features("enough.h5", labels_of({8, 3}), 8, 2, 3);
    const auto scoring = [&](const std::string& real, const std::string& generated) {
        return "--real-features " + at(real) + " --generated-features " + at(generated);
    };
    const auto few = scoring("r.h5", "g.h5");
    const std::string of_mean =
        "no FIDm at infinity: it needs 8 samples of a class on each side; A001 comes nearest, with 7 real "
        "and 5 generated";
    const std::string of_whole =
        "no FIDw at infinity: it needs 2 samples on each side in a quarter of every class, rounded down, as "
        "8 of one class give; there are 1 real and 3 generated";
    const auto json = scored(few + " --fid-infinity");
    EXPECT_FALSE(json.contains("fid_whole_infinity"));
    for (const auto& warning : {of_mean, of_whole})
        EXPECT_EQ(std::ranges::count(json["warnings"], nlohmann::json(warning)), 1) << json["warnings"];
    EXPECT_NE(score(few + " --fid-infinity").output.find("warning: " + of_whole), std::string::npos);
    EXPECT_EQ(score(few).output.find("at infinity"), std::string::npos) << "nobody asked for it";
    const auto enough = scored(scoring("enough.h5", "enough.h5") + " --fid-infinity");
    EXPECT_TRUE(enough.contains("fid_mean_infinity"));
    EXPECT_EQ(enough["warnings"].dump().find("at infinity"), std::string::npos) << enough["warnings"];
}

TEST_F(Score, WarnsOfARecogniserNearChance) {
    features("r.h5", labels_of({300, 300, 300}));  // logits are random
    const auto result = score("--real-features " + at("r.h5") + " --generated-features " + at("r.h5"));
    EXPECT_NE(result.output.find("% of the real motions, where guessing among 3 classes is right on 33.3 %"),
              std::string::npos)
        << result.output;
    EXPECT_EQ(eval::near_chance(0.5, 3), "");
    EXPECT_NE(eval::near_chance(0.071, 14), "");
}

TEST_F(Score, RepeatsHaveAnInterval) {
    features("r.h5", labels_of({30, 40}), 8, 2, 1);
    std::string files;
    std::vector<double> each;
    for (unsigned i = 0; i < 3; ++i) {
        const auto name = fmt::format("g{}.h5", i);
        features(name, labels_of({20, 20}), 8, 2, 10 + i);
        files += " " + at(name);
        each.push_back(scored("--real-features " + at("r.h5") + " --generated-features " +
                              at(name))["fid_mean"]["mean"]);
    }
    const auto fid = scored("--real-features " + at("r.h5") + " --generated-features" + files)["fid_mean"];
    EXPECT_EQ(fid["repeats"].get<std::vector<double>>(), each);
    const double mean = (each[0] + each[1] + each[2]) / 3;
    double squares = 0;
    for (const double v : each) squares += (v - mean) * (v - mean);
    EXPECT_NEAR(fid["mean"].get<double>(), mean, 1e-12);
    EXPECT_NEAR(fid["ci95"].get<double>(), 4.302653 * std::sqrt(squares / 2 / 3), 1e-6);
}

TEST_F(Score, KeepsTheRealSide) {
    motions("m.h5", 4, 3);
    const auto arguments = one_person() + "--generated " + at("m.h5");
    const auto first = scored(arguments);
    std::vector<fs::path> kept;
    for (const auto& entry : fs::directory_iterator(dir / "cache/actformer/features"))
        if (entry.path().extension() == ".h5") kept.push_back(entry.path());
    ASSERT_EQ(kept.size(), 1U);
    const auto bytes = read_file(kept[0]);
    const auto time = fs::last_write_time(kept[0]);
    EXPECT_EQ(scored(arguments), first);
    EXPECT_EQ(fs::last_write_time(kept[0]), time) << "not made again";
    write_file(kept[0], bytes.substr(0, bytes.size() / 2));
    const auto again = score(arguments + " --json").output;
    EXPECT_TRUE(again.starts_with(kept[0].string() + ": damaged, or of an earlier version; made anew\n"))
        << again;
    EXPECT_EQ(nlohmann::json::parse(again.substr(again.find('{'))), first) << "what is damaged is made anew";
    EXPECT_EQ(read_file(kept[0]), bytes);
    scored(arguments + " --window 30");
    EXPECT_EQ(
        std::distance(fs::directory_iterator(dir / "cache/actformer/features"), fs::directory_iterator()), 5)
        << "other windows, other features, each with its lock, and the folder's";

    fs::remove_all(dir / "cache");
    const auto both = run_command(
        fmt::format("for i in 1 2; do (XDG_CACHE_HOME={} {} score {} --json >{}/$i.json) & done; wait",
                    at("cache"), program(), arguments, dir.path().string()));
    EXPECT_EQ(both.output, "");
    EXPECT_EQ(nlohmann::json::parse(read_file(dir / "1.json")), first) << "two at once";
    EXPECT_EQ(nlohmann::json::parse(read_file(dir / "2.json")), first);

    write_file(dir / "no-folder/actformer", "");
    const auto without = run_command("XDG_CACHE_HOME=" + at("no-folder") + " " + program() + " score " +
                                     arguments + " --json");
    EXPECT_EQ(nlohmann::json::parse(without.output), first) << "where there can be no cache";
}

TEST_F(Score, CutsNamesOfClassesAtACharacter) {
    const auto text = [](std::size_t letters) {
        std::string out;
        while (letters-- > 0) out += "é";
        return out;
    };
    fs::copy(datasets() / "ntu-2p", dir / "named", fs::copy_options::recursive);
    auto description = nlohmann::ordered_json::parse(read_file(dir / "named/dataset.json"));
    description.erase("checksum");  // as who edits it does
    description.erase("program");
    description["classes"][0] = text(20);
    description["classes"][1] = text(30);
    write_file(dir / "named/dataset.json", description.dump());
    motions("m.h5", 2, 3, 2);
    const auto result =
        score("--recogniser " + at("two.h5") + " --real " + at("named") + " --generated " + at("m.h5"));
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("\n" + text(20) + std::string(9, ' ')), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("\n" + text(27) + "  "), std::string::npos) << result.output;
}

TEST_F(Score, TellsHowManySequencesOfAllSetsAreDone) {
    motions("few.h5", 2, 3);
    motions("many.h5", 4, 6, 1, 2);
    ::setenv("XDG_CACHE_HOME", at("cache").c_str(), 1);
    kernels::Device device("");
    eval::ScoreMotions request;
    request.recogniser = at("one.h5");
    request.real.dataset = datasets() / "ntu-1p";
    for (const auto* name : {"many.h5", "few.h5"})
        request.generated.push_back(eval::motions_in(dir / name, {0, 4, {}}));
    const auto windows = eval::open_windows(device, request.real)->info().names.size();
    const auto told = [&](const std::string& work) {
        request.work = dir / work;
        fs::create_directories(request.work);
        std::vector<std::uint64_t> out;
        eval::score_motions(request, device, [&](std::uint64_t done, std::uint64_t all) {
            out.push_back(done);
            EXPECT_EQ(all, windows + 24 + 6);
        });
        return out;
    };
    const auto first = told("first"), again = told("again");
    ::unsetenv("XDG_CACHE_HOME");
    EXPECT_TRUE(std::ranges::is_sorted(first)) << "one work, not three";
    EXPECT_EQ(first.back(), windows + 24 + 6);
    ASSERT_FALSE(again.empty());
    EXPECT_EQ(again.front(), windows + 4) << "the real side's features were kept";
}

TEST_F(Score, ReplacesScoresAndNoFilesOfOthers) {
    features("real.h5", {0, 0, 1, 1, 2, 2});
    const auto scoring = "--real-features " + at("real.h5") + " --generated-features " + at("real.h5");
    const auto own = (datasets() / "ntu-1p/dataset.json").string();
    for (const std::string text : {"years of work", "{\"checksum\": \"mine\"}", "[]"}) {
        write_file(dir / "s.json", text);
        test::expect_refused(score(scoring + " -o " + at("s.json")),
                             {"s.json: is there, and holds no scores", "--force"});
        EXPECT_EQ(read_file(dir / "s.json"), text);
    }
    test::expect_refused(score(scoring + " -o " + own), {"dataset.json: is there"});
    EXPECT_EQ(score(scoring + " -o " + at("s.json") + " --force").exit, 0);
    EXPECT_EQ(score(scoring + " --seed 3 -o " + at("s.json")).exit, 0) << "scores, now";
    EXPECT_EQ(nlohmann::json::parse(read_file(dir / "s.json"))["provenance"]["seed"], 3);
}

TEST_F(Score, RefusesOptionsWithoutEffect) {
    motions("m.h5", 4, 3);
    features("r.h5", labels_of({3, 3, 3}));
    const auto made = one_person() + "--generated " + at("m.h5");
    const auto name_of = [](const std::string& option) { return option.substr(0, option.find(' ')); };
    for (const char* option : {"--repeats 3", "--per-class 5", "--generate-on cpu"})
        expect_refused(made + " " + option, {name_of(option) + ": is for --generator", "leave it out"});
    for (const char* option :
         {"--window 30", "--frames 9", "--split all", "--repeats 2", "--device cpu", "--batch 7"})
        expect_refused("--real-features " + at("r.h5") + " --generated-features " + at("r.h5") + " " + option,
                       {name_of(option) + ": features are scored as they are; leave it out"});
    for (const char* option : {"--kid", "--fid-infinity"})
        expect_refused("--single-recogniser " + at("one.h5") + " --real " + (datasets() / "ntu-2p").string() +
                           " --generated " + at("m.h5") + " " + option,
                       {option, "--recogniser that sees all persons"});
}

TEST_F(Score, RefusesOneFileAsTwoRepeats) {
    motions("m.h5", 2, 3);
    features("f.h5", {0, 0, 1, 1});
    fs::create_symlink("m.h5", dir / "link.h5");
    for (const auto* again : {"m.h5", "link.h5"})
        expect_refused(one_person() + "--generated " + at("m.h5") + " " + at(again),
                       {"--generated: " + at(again) + " is given twice; each file is a repeat"});
    expect_refused("--real-features " + at("f.h5") + " --generated-features " + at("f.h5") + " " + at("f.h5"),
                   {"--generated-features: " + at("f.h5") + " is given twice"});
}

TEST_F(Score, TakesNoMeasuresOfOtherWindows) {
    ingest::MotionsWriter whole(dir / "m.h5"), writer(dir / "bad.h5");
    whole.describe(ingest::subjects_of(ingest::Dataset(datasets() / "ntu-1p")));
    for (unsigned i = 0; i < 12; ++i)
        whole.add(fmt::format("A{:03}_{}", i % 4 + 1, i / 4), made_motion(60, 1, i));
    whole.finish();
    auto motion = made_motion(60, 1, 7);
    motion.values[100] = std::nanf("");
    for (unsigned i = 0; i < 2; ++i) writer.add(fmt::format("A001_{}", i), motion);
    writer.finish();
    const auto of_split = [&](const std::string& split) {
        return one_person() + "--split " + split + " -o " + at("s.json") + " --generated " + at("m.h5") + " ";
    };
    const auto stopped = score(of_split("xsub/train") + at("bad.h5"));
    ASSERT_EQ(stopped.exit, 1) << stopped.output;
    ASSERT_TRUE(fs::exists(dir / "s.json.work")) << "what is done is kept: " << stopped.output;
    const auto json = scored(of_split("xsub/test"));
    EXPECT_FALSE(fs::exists(dir / "s.json.work"));
    EXPECT_EQ(json, scored(of_split("xsub/test"))) << "as without a scoring of another split before it";
    EXPECT_TRUE(json.contains("limb_acceleration"));
}

TEST_F(Score, LeavesWhatOthersPutAtItsWorkingFolder) {
    features("f.h5", labels_of({8, 8, 8}));
    const auto arguments = "--real-features " + at("f.h5") + " --generated-features " + at("f.h5");
    write_file(dir / "thesis/chapter", "precious");
    fs::create_directory_symlink("thesis", dir / "refused.json.work");
    expect_refused(arguments, {"refused.json.work: a symbolic link", "remove it, or choose another -o"});
    fs::remove(dir / "refused.json.work");
    fs::rename(dir / "thesis", dir / "refused.json.work");
    expect_refused(arguments, {"refused.json.work/chapter: ", "move it, or choose another -o"});
    EXPECT_EQ(read_file(dir / "refused.json.work/chapter"), "precious");
    const std::string key(32, '0');
    for (const auto& own : {key + ".h5", key + ".measures", key + ".h5.partial", std::string("real.h5")})
        write_file(dir / "own.json.work" / own, "left");
    EXPECT_EQ(score(arguments + " -o " + at("own.json")).exit, 0);
    EXPECT_FALSE(fs::exists(dir / "own.json.work"));
}

TEST_F(Score, TakesASplitWhoseNameIsNoText) {
    copy_with_odd_split(datasets() / "ntu-1p", dir / "odd");
    motions("m.h5", 4, 3);
    const auto result = score("--recogniser " + at("one.h5") + " --real " + at("odd") + " --split '" +
                              odd_split + "' --generated " + at("m.h5") + " -o " + at("s.json"));
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(nlohmann::json::parse(read_file(dir / "s.json"))["provenance"]["real"]["split"],
              odd_split_in_json);
}

TEST_F(Score, TellsHowFastRootsMove) {
    const ingest::Dataset dataset(datasets() / "ntu-1p");
    for (const int speed : {1, 2}) {  // metres a second
        ingest::MotionsWriter writer(dir / fmt::format("{}.h5", speed));
        writer.describe(ingest::subjects_of(dataset));
        for (unsigned i = 0; i < 12; ++i) {
            auto motion = made_motion(60, 1, i);
            for (std::size_t t = 0; t < 60; ++t)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    motion.values[t * 25 * 3 + axis] =
                        axis == 0 ? static_cast<float>(speed) * static_cast<float>(t) / 30 : 0;
            writer.add(fmt::format("A{:03}_{}", i % 4 + 1, i / 4), motion);
        }
        writer.finish();
    }
    const auto arguments = one_person() + "--split all --generated " + at("1.h5") + " " + at("2.h5");
    // A scoring that was interrupted before scores had a root speed left measures without one.
    Checksum key;
    key.add(
        fmt::format("real|all|60|{}|{}", ingest::dataset_checksum(datasets() / "ntu-1p"), ACTFORMER_VERSION));
    fs::create_directories(dir / "s.json.work");
    eval::write_measures(dir / "s.json.work" / (key.hex() + ".measures"), {{1}, {1}, {}, {1}, {}, 0});
    const auto json = scored(arguments + " -o " + at("s.json"));
    const auto& repeats = json["root_speed"]["repeats"];
    ASSERT_TRUE(repeats[0].is_number()) << json;
    EXPECT_NEAR(repeats[1].get<double>() / repeats[0].get<double>(), 2, 1e-4);
    EXPECT_EQ(json["real"]["root_speed"], 1);
    EXPECT_TRUE(json["per_class"][0]["root_speed"].is_number());
}

TEST_F(Score, TakesLabelsFromAFile) {
    ingest::MotionsWriter writer(dir / "m.h5");
    ingest::MotionsWriter named(dir / "named.h5");
    std::string lines = "# name and action\n";
    for (unsigned i = 0; i < 8; ++i) {
        const auto motion = made_motion(60, 1, i);
        writer.add(fmt::format("walk {}", i), motion);
        named.add(fmt::format("A{:03}_{}", 1 + i % 2, i), motion);
    }
    writer.finish();
    named.finish();
    expect_refused(one_person() + "--generated " + at("m.h5"), {"m.h5", "--labels"});
    ingest::MotionsWriter plain(dir / "plain.h5");
    for (unsigned i = 0; i < 8; ++i) {
        plain.add(fmt::format("walk{}", i), made_motion(60, 1, i));
        lines += fmt::format("walk{}\t{}\n", i, i % 2 ? "A002" : "1");
    }
    plain.finish();
    write_file(dir / "labels.txt", lines);
    const auto with =
        scored(one_person() + "--generated " + at("plain.h5") + " --labels " + at("labels.txt"));
    const auto without = scored(one_person() + "--generated " + at("named.h5"));
    EXPECT_NEAR(with["fid_mean"]["mean"].get<double>(), without["fid_mean"]["mean"].get<double>(), 1e-6);

    ingest::MotionsWriter labelled(dir / "labelled.h5"), beyond(dir / "beyond.h5");
    for (unsigned i = 0; i < 8; ++i) {
        labelled.add(fmt::format("walk{}", i), made_motion(60, 1, i), {.label = i % 2, .bone_length = {}});
        beyond.add(fmt::format("A001_{}", i), made_motion(60, 1, i), {.label = 4000, .bone_length = {}});
    }
    labelled.finish();
    beyond.finish();
    EXPECT_EQ(scored(one_person() + "--generated " + at("labelled.h5"))["fid_mean"], without["fid_mean"]);
    expect_refused(one_person() + "--generated " + at("beyond.h5"), {"beyond.h5", "4001"});

    const auto arguments = one_person() + "--generated " + at("plain.h5") + " --labels " + at("labels.txt");
    write_file(dir / "labels.txt", lines + "walk0 1\n");
    expect_refused(arguments, {"labels.txt", "line 10", "twice"});
    write_file(dir / "labels.txt", "walk0 999\n");
    expect_refused(arguments, {"labels.txt", "line 1", "999"});
    write_file(dir / "labels.txt", "walk0\n");
    expect_refused(arguments, {"labels.txt", "line 1", "walk0"});
    write_file(dir / "labels.txt", "walk0 1\n");
    expect_refused(arguments, {"plain.h5", "walk1"});
}

TEST_F(Score, WarnsOfCollapseAndOtherLengths) {
    ingest::MotionsWriter writer(dir / "m.h5");
    for (unsigned i = 0; i < 6; ++i) writer.add(fmt::format("A001_{}", i), made_motion(40, 1, 3));
    writer.finish();
    const auto json = scored(one_person() + "--generated " + at("m.h5"));
    std::string warnings;
    for (const auto& line : json["warnings"]) warnings += line.get<std::string>() + "\n";
    EXPECT_NE(warnings.find("are the same: drink water (6 samples)"), std::string::npos) << warnings;
    EXPECT_NE(warnings.find("40 frames are compared with windows of 60"), std::string::npos) << warnings;
}

TEST_F(Score, RefusesWhatDoesNotFit) {
    motions("m.h5", 4, 3);
    motions("two.h5m", 2, 3, 2);
    expect_refused(one_person() + "--generated " + at("two.h5m"), {"two.h5m", "6 channels"});
    expect_refused("--recogniser " + at("two.h5") + " --real " + (datasets() / "ntu-1p").string() +
                       " --generated " + at("m.h5"),
                   {"ntu-1p", "persons", "two.h5"});
    expect_refused(one_person() + "--single-recogniser " + at("one.h5") + " --generated " + at("m.h5"),
                   {"--single-recogniser"});
    expect_refused(two_persons() + "--single-recogniser " + at("two.h5") + " --generated " + at("two.h5m"),
                   {"two.h5", "one"});
    write_stgcn_weights(dir / "more.h5",
                        eval::random_stgcn_weights(3, one_person_classes + 1, eval::ntu_graph(), 0.125, 1));
    expect_refused("--recogniser " + at("more.h5") + " --real " + (datasets() / "ntu-1p").string() +
                       " --generated " + at("m.h5"),
                   {"classes", "more.h5"});
    ingest::MotionsWriter one_class(dir / "class.h5");
    auto subjects = ingest::subjects_of(ingest::Dataset(datasets() / "ntu-1p"));
    subjects.classes.resize(1);
    one_class.describe(subjects);
    one_class.add("A001_0", made_motion(60, 1, 1));
    one_class.finish();
    expect_refused(one_person() + "--generated " + at("class.h5"), {"class.h5: has 1 class and the"});
    expect_refused(one_person() + "--generated " + at("none.h5"), {"none.h5"});
    expect_refused(one_person() + "--split nowhere --generated " + at("m.h5"), {"nowhere"});
    expect_refused("--recogniser " + at("gone.h5") + " --real " + (datasets() / "ntu-1p").string() +
                       " --generated " + at("m.h5"),
                   {"gone.h5"});
    expect_refused(one_person() + "--generated " + at("m.h5") + " --generator " + at("run"), {"either"});
    expect_refused(one_person(), {"--generated"});
    expect_refused(
        "--real " + datasets().string() + " --recogniser " + at("one.h5") + " --generated " + at("m.h5"),
        {"2 datasets"});
    ingest::MotionsWriter single(dir / "single.h5");
    single.add("A001_0", made_motion(60, 1, 1));
    single.finish();
    const auto result = score(one_person() + "--generated " + at("single.h5") + " -o " + at("s.json"));
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("single.h5: one sample is too few"), std::string::npos) << result.output;
    EXPECT_FALSE(fs::exists(at("s.json")));
}

TEST_F(Score, OfRepeatsThatCanBeMeasuredAndOthersSaysSo) {
    motions("bare.h5", 4, 3, 1, 1, 40);
    ingest::MotionsWriter writer(dir / "described.h5");
    writer.describe(ingest::subjects_of(ingest::Dataset(datasets() / "ntu-1p")));
    for (unsigned c = 0; c < 4; ++c)
        for (unsigned i = 0; i < 3; ++i)
            writer.add(fmt::format("A{:03}_{}", c + 1, i), made_motion(60, 1, 500 + c * 10 + i));
    writer.finish();
    const auto alone = scored(one_person() + "--generated " + at("described.h5"));
    for (const auto& files :
         {at("described.h5") + " " + at("bare.h5"), at("bare.h5") + " " + at("described.h5")}) {
        const auto json = scored(one_person() + "--generated " + files);
        std::string warnings;
        for (const auto& line : json["warnings"]) warnings += line.get<std::string>() + "\n";
        EXPECT_NE(warnings.find("are those of 1 of 2 repeats"), std::string::npos) << warnings;
        EXPECT_NE(warnings.find("motions of 40 to 60 frames are compared with windows of 60"),
                  std::string::npos)
            << warnings;
        EXPECT_EQ(json["limb_acceleration"]["mean"], alone["limb_acceleration"]["mean"]);
        EXPECT_EQ(json["per_class"][0]["limb_acceleration"], alone["per_class"][0]["limb_acceleration"]);
    }
}

TEST_F(Score, RefusesRepeatsOfWhichSomeHaveNoLogits) {
    features("r.h5", labels_of({30, 40}), 8, 2, 1);
    features("with.h5", labels_of({30, 40}), 8, 2, 2);
    hdf5::Writer bare(dir / "without.h5");
    const auto labels = labels_of({30, 40});
    const auto values = Reader(dir / "r.h5").read<float>("features");
    bare.write<float>("features", {70, 8}, values);
    bare.write<std::uint32_t>("labels", {70}, labels);
    bare.finish();
    const auto with = at("with.h5"), without = at("without.h5");
    for (const auto& files : {with + " " + without, without + " " + with})
        expect_refused("--real-features " + at("r.h5") + " --generated-features " + files,
                       {with + " has logits and " + without + " has none"});
}

TEST_F(Score, RefusesFeaturesThatDoNotFit) {
    features("r.h5", labels_of({30, 40}), 8, 2);
    const auto against = [&](const std::string& file) {
        return "--real-features " + at("r.h5") + " --generated-features " + at(file);
    };
    features("wide.h5", labels_of({30, 40}), 9, 2);
    expect_refused(against("wide.h5"), {"wide.h5", "9", "8"});
    features("classes.h5", labels_of({30, 40, 5}), 8, 3);
    expect_refused(against("classes.h5"), {"classes.h5", "3 classes", "2"});
    features("label.h5", labels_of({30, 40, 5}), 8, 2);
    expect_refused(against("label.h5"), {"label.h5", "label 2"});
    features("one.h5", {0}, 8, 2);
    expect_refused(against("one.h5"), {"one.h5", "too few"});
    features("none.h5", {}, 8, 2);
    expect_refused(against("none.h5"), {"none.h5"});
    expect_refused(against("missing.h5"), {"missing.h5"});
    expect_refused("--real-features " + at("r.h5"), {"together"});
    expect_refused(against("r.h5") + " --recogniser " + at("one.h5"), {"either"});
    write_file(dir / "text.h5", "text");
    expect_refused(against("text.h5"), {"text.h5", "HDF5"});

    eval::FeaturesFile file(dir / "nan.h5", 3, 2, 2);
    file.add(0, std::vector<float>{0, 1, 2, std::nanf(""), 4, 5}, std::vector<float>(6, 0.0F));
    file.labels({0, 1, 1});
    file.finish();
    expect_refused("--real-features " + at("nan.h5") + " --generated-features " + at("r.h5"),
                   {"nan.h5", "sample 1", "not finite"});
    eval::FeaturesFile bare(dir / "bare.h5", 3, 2, 2);
    bare.add(0, std::vector<float>(6, 0.0F), std::vector<float>(6, 0.0F));
    bare.finish();
    expect_refused(against("bare.h5"), {"bare.h5", "labels"});
}
