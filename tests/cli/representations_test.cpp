// Every representation through the whole program: a recogniser and a generator train on it, motions are generated, scored, drawn
// and shown in a report; and what does not fit is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/made_dataset.hpp"
#include "tests/support/run_log.hpp"

using namespace actformer;
using namespace actformer::test;
using ingest::Representation;

namespace {

constexpr std::uint32_t window = 20;

/// A folder with the configurations of a recogniser and of a generator for the arms in one representation.
struct Chain {
    TempDir dir;
    Representation how;

    explicit Chain(Representation representation) : how(representation) {
        write_file(dir / "recogniser.yaml",
                   configuration("recogniser",
                                 "test_split: s/test\nwidth: 0.25\nbatch: 12\nepochs: "
                                 "30\nrate_drops: [24]\n"));
        write_file(dir / "generator.yaml",
                   configuration("generator",
                                 "width: 16\nheads: 2\ndepth: 1\nlatent: 8\nd_width: 4\nbatch: "
                                 "6\nepochs: 3\nscore_every: 3\nscore_per_class: 4\n"));
    }

    std::string at(const std::string& name) const { return (dir / name).string(); }
    std::string data() const { return arms_in(how).string(); }

    void run(const std::string& arguments) const {
        const auto result = run_actformer(arguments);
        EXPECT_EQ(result.exit, 0) << how.name() << ": " << result.output;
    }

  private:
    std::string configuration(const std::string& model, const std::string& more) const {
        return fmt::format("model: {}\ndata: {}\ntrain_split: s/train\nframes: {}\nthreads: 1\n{}", model,
                           data(), window, more);
    }
};

void expect_recogniser(const Chain& chain) {
    chain.run("train recogniser -c " + chain.at("recogniser.yaml") + " -o " + chain.at("recogniser"));
    double accuracy = 0;
    for (const auto& line : log_of(chain.dir / "recogniser"))
        accuracy = line.value("class_accuracy", accuracy);
    // Which of three arms swings can be seen in any representation; chance is a third.
    EXPECT_GT(accuracy, 0.6) << chain.how.name();
    const auto weights = eval::read_stgcn_weights(chain.dir / "recogniser/weights-last.h5");
    EXPECT_EQ(weights.representation, chain.how);
    EXPECT_EQ(weights.channels, chain.how.numbers());
    EXPECT_EQ(weights.graph.parents, chain.how.node_parents(ArmsClip::topology()));
}

void expect_generator(const Chain& chain) {
    chain.run("train generator -c " + chain.at("generator.yaml") + " -o " + chain.at("generator") +
              " recogniser=" + chain.at("recogniser"));
    bool scored = false;
    for (const auto& line : log_of(chain.dir / "generator"))
        for (const auto& [key, value] : line.items()) {
            const bool sound = !value.is_number() || std::isfinite(value.get<double>());
            EXPECT_TRUE(sound) << chain.how.name() << " " << key;
            scored = scored || key == "fid_whole";
        }
    EXPECT_TRUE(scored) << chain.how.name();
}

/// Numbers are finite and finished as the representation has them.
void expect_finished(const ingest::Motion& motion, Representation how) {
    const auto length = [](const float* x) { return std::hypot(x[0], x[1], x[2]); };
    for (std::uint32_t t = 0; t < motion.frames; ++t)
        for (std::uint32_t k = 0; k < motion.nodes; ++k) {
            const float* x = motion.at(t, 0, k);
            for (std::uint32_t d = 0; d < motion.numbers; ++d) ASSERT_TRUE(std::isfinite(x[d]));
            if (how.free_node(motion.nodes) == k) {
                for (std::uint32_t d = 3; d < motion.numbers; ++d) ASSERT_EQ(x[d], 0);
            } else if (how == Representation::limb) {
                ASSERT_NEAR(length(x), 1, 0.05);
            } else if (how == Representation::rot6d) {
                ASSERT_NEAR(length(x), 1, 1e-5);  // float32 through one division
                ASSERT_NEAR(length(x + 3), 1, 1e-5);
                // Rounding grows by the inverse sine of the raw rows' angle, which is small now and then.
                ASSERT_NEAR(x[0] * x[3] + x[1] * x[4] + x[2] * x[5], 0, 1e-3);
            }
        }
}

void expect_motions(const Chain& chain) {
    chain.run("generate --generator " + chain.at("generator") + " -o " + chain.at("motions.h5") +
              " --per-class 4 --seed 3");
    const ingest::MotionsFile file(chain.dir / "motions.h5");
    EXPECT_EQ(file.representation(), chain.how);
    ASSERT_TRUE(file.subjects());
    EXPECT_EQ(*file.subjects(), ingest::subjects_of(ingest::Dataset(arms_in(chain.how))));
    ASSERT_EQ(file.names().size(), 12U);
    for (const auto& name : file.names()) {
        const auto motion = file.read(name);
        EXPECT_EQ(motion.frames, window);
        EXPECT_EQ(motion.nodes, chain.how.nodes(ArmsClip::topology()));
        expect_finished(motion, chain.how);
    }
}

void expect_scores_and_pictures(const Chain& chain) {
    const auto scores =
        run_actformer("score --recogniser " + chain.at("recogniser") + " --real " + chain.data() +
                      " --split s/train --generated " + chain.at("motions.h5") +
                      fmt::format(" --window {} --json 2>/dev/null", window));
    ASSERT_EQ(scores.exit, 0) << scores.output;
    EXPECT_NE(scores.output.find("fid"), std::string::npos) << scores.output;
    chain.run("features --recogniser " + chain.at("recogniser") + " " + chain.data() + " -o " +
              chain.at("features.h5") + fmt::format(" --window {}", window));
    for (const auto& input : {chain.at("motions.h5"), chain.data()}) {
        chain.run("render " + input + " --count 3 --size 60 -o " + chain.at("drawn.png"));
        EXPECT_EQ(read_file(chain.dir / "drawn.png").substr(1, 3), "PNG");
    }
}

void expect_report(const std::vector<std::unique_ptr<Chain>>& chains) {
    const TempDir dir;
    std::string datasets = "datasets:\n", recognisers = "recognisers:\n", rows = "rows:\n";
    for (const auto& chain : chains) {
        const auto name = chain->how.name();
        datasets += fmt::format("  {}: {{path: {}}}\n", name, chain->data());
        recognisers +=
            fmt::format("  {}-eyes: {{weights: {}}}\n", name, chain->at("recogniser/weights-last.h5"));
        rows += fmt::format("  {0}: {{data: {0}, recogniser: {0}-eyes, motions: [{1}], split: s/train}}\n",
                            name, chain->at("motions.h5"));
    }
    write_file(dir / "sweep.yaml", "name: three\n" + datasets + recognisers + rows);
    const auto swept =
        run_actformer("sweep " + (dir / "sweep.yaml").string() + " -o " + (dir / "out").string());
    ASSERT_EQ(swept.exit, 0) << swept.output;
    const auto report =
        run_actformer("report " + (dir / "out").string() + " -o " + (dir / "report.html").string());
    ASSERT_EQ(report.exit, 0) << report.output;
    EXPECT_EQ(report.output.find("notice"), std::string::npos) << report.output;
    const auto page = read_file(dir / "report.html");
    for (const auto& chain : chains)
        EXPECT_NE(page.find("\"" + chain->how.name() + "\""), std::string::npos) << chain->how.name();
}

/// A recogniser's weights at random.
std::string recogniser_for(const TempDir& dir, Representation how) {
    auto weights = eval::random_stgcn_weights(
        how.numbers(), 3, eval::recogniser_graph(how.node_parents(ArmsClip::topology())), 0.125, 1);
    weights.representation = how;
    const auto path = dir / (how.name() + "-eyes.h5");
    eval::write_stgcn_weights(path, weights);
    return path.string();
}

/// Four motions of the first class in `how`; `described` as the program's own, or as a tool that says nothing leaves them.
std::string motions_in(const TempDir& dir, Representation how, bool described) {
    const auto path = dir / (how.name() + ".h5");
    ingest::MotionsWriter writer(path);
    if (described) writer.describe(ingest::subjects_of(ingest::Dataset(arms_in(how))));
    for (std::uint32_t i = 0; i < 4; ++i)
        writer.add(fmt::format("A001_{}", i), ArmsClip(0, i, window).in(how));
    writer.finish();
    return path.string();
}

CommandResult score(const std::string& recogniser, Representation data, const std::string& motions) {
    return run_actformer("score --recogniser " + recogniser + " --real " + arms_in(data).string() +
                         " --split s/train --window 20 --generated " + motions);
}

}  // namespace

TEST(Representations, GoThroughTheWholeProgram) {
    std::vector<std::unique_ptr<Chain>> chains;
    for (const auto how : Representation::all()) {
        chains.push_back(std::make_unique<Chain>(how));
        expect_recogniser(*chains.back());
        expect_generator(*chains.back());
        expect_motions(*chains.back());
        expect_scores_and_pictures(*chains.back());
    }
    expect_report(chains);
}

TEST(Representations, RefuseOneAnother) {
    const TempDir dir;
    constexpr auto limb = Representation::limb, rot6d = Representation::rot6d;
    const auto sees_limbs = recogniser_for(dir, limb), sees_rotations = recogniser_for(dir, rot6d);
    const auto limbs = motions_in(dir, limb, true), rotations = motions_in(dir, rot6d, true);
    expect_refused(score(sees_limbs, rot6d, limbs), {"rot6d", "limb-eyes.h5", "takes limb"});
    expect_refused(score(sees_limbs, limb, rotations),
                   {"rot6d.h5", "in rot6d", "limb-eyes.h5", "takes limb"});
    expect_refused(run_actformer("features --recogniser " + sees_rotations + " " + limbs + " -o " +
                                 (dir / "f.h5").string()),
                   {"limb.h5", "in limb", "takes rot6d"});
    expect_refused(run_actformer("render " + rotations + " --bones " + arms_in(limb).string() + " -o " +
                                 (dir / "x.png").string()),
                   {"in rot6d", "is in limb"});
    const Chain chain(rot6d);
    expect_refused(run_actformer("train generator -c " + chain.at("generator.yaml") + " -o " +
                                 chain.at("run") + " recogniser=" + sees_limbs),
                   {"rot6d", "takes limb"});
    EXPECT_FALSE(std::filesystem::exists(chain.dir / "run"));
}

TEST(Representations, TakeMotionsThatSayNothingAsTheRecogniserDoes) {
    const TempDir dir;
    for (const auto how : Representation::all()) {
        const auto result = score(recogniser_for(dir, how), how, motions_in(dir, how, false));
        EXPECT_EQ(result.exit, 0) << how.name() << ": " << result.output;
    }
}

TEST(Representations, NoticePositionsGivenAsLimbs) {
    const TempDir dir;
    const auto positions = motions_in(dir, Representation::xyz, false);
    const std::vector<std::string> words{"xyz.h5", "A001_0", "no limb vectors", "representation to xyz",
                                         "ingest motions"};
    expect_refused(score(recogniser_for(dir, Representation::limb), Representation::limb, positions), words);
    expect_refused(run_actformer("render " + positions + " --bones " +
                                 arms_in(Representation::limb).string() + " -o " + (dir / "x.png").string()),
                   words);
}
