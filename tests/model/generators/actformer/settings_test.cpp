// Generator configurations: what they become and what they refuse, through `actformer model` too.
#include "model/generators/actformer/settings.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "model/generators/actformer/layers.hpp"
#include "model/generators/adversarial/gan_settings.hpp"
#include "model/generators/generator_settings.hpp"
#include "tests/support/command.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;

namespace {

MotionSpec ntu_motions(std::uint32_t persons, std::size_t classes) {
    return {ingest::Representation::limb, ingest::ntu25(), persons, static_cast<std::uint32_t>(classes),
            "ntu"};
}

const std::string configs = source("model/configs/");

Config with(const std::vector<std::string>& assignments) {
    Config config("actformer", actformer_keys());
    for (const auto& assignment : assignments) config.override_with(assignment);
    return config;
}

/// All keys that an ActFormer's configuration may have.
Config whole_config() {
    auto keys = actformer_keys();
    for (auto& key : gan_keys()) keys.push_back(std::move(key));
    for (auto& key : generator_keys()) keys.push_back(std::move(key));
    return {"actformer", keys};
}

void expect_refused(const std::vector<std::string>& assignments, std::uint32_t persons, std::size_t classes,
                    const std::vector<std::string>& words) {
    try {
        const auto config = with(assignments);
        actformer_generator_settings(config, ntu_motions(persons, classes));
        actformer_discriminator_settings(config, ntu_motions(persons, classes));
        ADD_FAILURE() << "taken";
    } catch (const Error& e) {
        for (const auto& word : words)
            EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << word << ": " << e.what();
    }
}

}  // namespace

TEST(ActFormerGeneratorSettings, SwitchesComeThrough) {
    const auto config = with({"prior=gaussian", "shared_z=false", "pe=independent", "interaction=concat",
                              "body=graphconv", "d_persons=selfatt", "d_width=16", "latent=32", "depth=3"});
    const auto g = actformer_generator_settings(config, ntu_motions(2, 26));
    EXPECT_EQ(g.prior.kind, PriorKind::gaussian);
    EXPECT_EQ(g.prior.streams, 2U);
    EXPECT_EQ(g.prior.channels, 32U);
    EXPECT_EQ(g.positions, Positions::independent);
    EXPECT_EQ(g.interaction, Interaction::concat);
    EXPECT_EQ(g.body, Body::graphconv);
    EXPECT_EQ(interacting_blocks(g), (std::vector<bool>{false, false, false}));
    const auto d = actformer_discriminator_settings(config, ntu_motions(2, 26));
    EXPECT_EQ(d.persons_in, PersonsInD::selfatt);
    EXPECT_EQ(d.features(), 256U);
}

TEST(ActFormerGeneratorSettings, RotationsHaveANodeOfTranslationOnTheRoot) {
    const ingest::Topology tree{{"root", "arm", "hand"}, {-1, 0, 1}};
    const MotionSpec rotations{ingest::Representation::rot6d, tree, 2, 26, "smpl"};
    const auto g = actformer_generator_settings(with({}), rotations);
    EXPECT_EQ(g.parents, (std::vector<int>{-1, 0, 1, 0}));
    EXPECT_EQ(g.numbers(), 6U);
    const auto d = actformer_discriminator_settings(with({}), rotations);
    EXPECT_EQ(d.parents, g.parents);
    EXPECT_EQ(d.numbers, 6U);
}

TEST(ActFormerGeneratorSettings, RefusesWhatNoNetworkHas) {
    expect_refused({"heads=7"}, 2, 26, {"heads: 7", "width: 200", "196"});
    expect_refused({"width=25", "heads=5"}, 2, 26, {"width: 25 is odd"});
    expect_refused({"persons=1"}, 2, 26, {"ntu: 2 persons", "persons: 1"});
    expect_refused({"classes=94"}, 2, 26, {"ntu: 26 classes", "classes: 94"});
    expect_refused({"body=lstm"}, 2, 26, {"body", "transformer, graphconv", "lstm"});
    expect_refused({"pe=none"}, 2, 26, {"pe must be one of concat, tiled, independent, fixed"});
    expect_refused({"d_persons=sum"}, 2, 26, {"concat, avgpool, maxpool, selfatt"});
    expect_refused({"frames=8"}, 2, 26, {"frames must be a whole number from 16"});
    expect_refused({}, 2, 0, {"classes are too few"});
}

TEST(ModelCommand, PrintsTable6ForThePapersConfiguration) {
    const auto line = "model " + configs + "actformer-ntu-2p.yaml frames=64";
    const auto text = run_actformer(line);
    EXPECT_EQ(text.exit, 0) << text.output;
    EXPECT_NE(text.output.find("1,359,675"), std::string::npos) << text.output;
    EXPECT_NE(text.output.find("5,174,593"), std::string::npos) << text.output;
    const auto json = nlohmann::json::parse(run_actformer(line + " --json").output);
    EXPECT_EQ(json.at("generator").at("parameters"), 1'359'675);
    EXPECT_EQ(json.at("discriminator").at("parameters"), 5'174'593);
}

TEST(ModelCommand, SaysWhoseJointsItTakesAndKeepsItsColumns) {
    const auto printed = run_actformer("model " + configs + "actformer-cmu.yaml");
    ASSERT_EQ(printed.exit, 0) << printed.output;
    EXPECT_TRUE(printed.output.starts_with("for NTU's 25 joints, as no --data is given\n\n"))
        << printed.output;
    std::istringstream lines(printed.output);
    std::size_t width = 0;
    for (std::string line; std::getline(lines, line); width = line.size()) {
        const bool begins = width == 0;
        EXPECT_TRUE(begins || line.empty() || line.size() == width) << line;
    }
}

TEST(ModelCommand, TakesEveryGeneratorConfiguration) {
    for (const auto& entry : std::filesystem::directory_iterator(configs)) {
        const auto file = entry.path().filename().string();
        if (file.starts_with("recogniser")) continue;
        const auto config = read_generator_config(entry.path());
        const auto told = [&](const char* key, std::uint32_t otherwise) {
            const auto count = static_cast<std::uint32_t>(config.get<std::int64_t>(key));
            return count == 0 ? otherwise : count;
        };
        const auto spec = ntu_motions(told("persons", 1), told("classes", 4));
        EXPECT_FALSE(method_named(config.model(), file).networks(config, spec).empty()) << file;
    }
    EXPECT_EQ(run_actformer("model " + configs + "actformer-ntu-1p.yaml").exit, 0);
    EXPECT_EQ(run_actformer("model " + configs + "actformer-small.yaml persons=2 classes=4").exit, 0);
    const auto refused = run_actformer("model " + configs + "actformer-ntu-2p.yaml heads=9");
    EXPECT_EQ(refused.exit, 1);
    EXPECT_EQ(lines_in(refused.output), 1) << refused.output;
}

TEST(ActFormerGeneratorSettings, SwitchesThatThePaperDoesNotHaveAreOffInItsConfigurations) {
    for (const auto* name : {"actformer.yaml", "actformer-ntu-1p.yaml", "actformer-ntu-2p.yaml"}) {
        auto config = whole_config();
        config.load(configs + name);
        EXPECT_EQ(config.get<std::string>("pe_start"), "normal") << name;
        EXPECT_EQ(config.get<std::int64_t>("d_differences"), 1) << name;
        EXPECT_EQ(config.get<double>("d_gain"), 1) << name;
        EXPECT_EQ(config.get<double>("d_joints"), 0) << name;
        EXPECT_EQ(config.get<double>("d_poses"), 1) << name;
        EXPECT_EQ(config.get<double>("smooth"), 0) << name;
        EXPECT_EQ(config.get<double>("smooth_root"), 0) << name;
        EXPECT_EQ(config.get<std::int64_t>("discriminator_steps"), 4) << name;
    }
    for (const auto* name : {"actformer.yaml", "actformer-ntu-1p.yaml", "actformer-ntu-2p.yaml", "csgn.yaml",
                             "csgn-lineage.yaml"}) {
        const auto gan = gan_settings(read_generator_config(configs + name));
        EXPECT_EQ(gan.spread, 0) << name;
        EXPECT_EQ(gan.mirror, 0) << name;
        EXPECT_EQ(gan.turn, 0) << name;
    }
}

TEST(ActFormerGeneratorSettings, RefuseAugmentationThatHidesWhatWasRecorded) {
    for (const auto& [assignment, words] : std::vector<std::pair<std::string, std::string>>{
             {"mirror=0.5", "mirror: 0.5 leaves nothing"}, {"turn=1", "turn: 1 leaves nothing"}}) {
        auto config = whole_config();
        config.override_with(assignment);
        EXPECT_NE(error_of([&] { gan_settings(config); }).find(words), std::string::npos) << assignment;
    }
}
