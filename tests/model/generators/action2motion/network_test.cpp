// Action2Motion's networks: counts, both paths against each other, and against an independent computation in PyTorch.
#include <ATen/core/grad_mode.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <numeric>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "model/generators/action2motion/body.hpp"
#include "model/generators/action2motion/layers.hpp"
#include "model/generators/action2motion/motions.hpp"
#include "model/generators/action2motion/network.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::model::action2motion;
using namespace actformer::test;
using ingest::Representation;

namespace model = actformer::model;

namespace {

/// NTU-13's tree of 18 joints.
const ingest::Topology& ntu13() {
    static const ingest::Topology tree{{}, {-1, 0, 1, 2, 3, 1, 5, 6, 1, 0, 9, 10, 0, 12, 13, 14, 11, 8}};
    return tree;
}

/// Of positions of joints, D = 3 * joints * persons.
Settings settings_for(const ingest::Topology& tree, std::uint32_t classes, std::uint32_t persons = 1,
                      Body body = Body::plain) {
    Settings s;
    s.representation = Representation::xyz;
    s.topology = tree;
    s.persons = persons;
    s.classes = classes;
    s.body = body;
    return s;
}

std::int64_t count(const Settings& settings) {
    std::int64_t sum = 0;
    for (const auto& weight : weights_of(settings)) sum += weight.count();
    return sum;
}

struct Counts {
    std::int64_t prior, posterior, decoder;
    bool operator==(const Counts&) const = default;
};

Counts counts(const Settings& settings) {
    std::vector<std::int64_t> sums;
    for (const auto& network : summary(settings))
        sums.push_back(
            std::accumulate(network.lines.begin(), network.lines.end(), std::int64_t{0},
                            [](std::int64_t sum, const auto& line) { return sum + line.parameters; }));
    return {sums.at(0), sums.at(1), sums.at(2)};
}

/// What both sides are given: weights, motions, noise.
struct Given {
    at::Tensor real, labels, noise, prior_noise, bones;
    bool own = false;
};

struct Case {
    std::string name;
    Settings settings;
    bool own;
    bool in_pytorch = true;  ///< of several that are alike, one is enough
};

constexpr std::int64_t motions = 5;
constexpr std::uint32_t frames = 6;

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](const std::string& name, Settings settings, bool own) {
        settings.frames = frames;
        settings.hidden = 32;
        settings.latent = 7;
        all.push_back({name, std::move(settings), own});
    };
    const auto &ntu = ingest::ntu25(), &smpl = ingest::smpl24();
    add("75", settings_for(ntu, 6), false);
    add("75-own", settings_for(ntu, 6), true);
    auto rotations = settings_for(smpl, 4);
    rotations.representation = Representation::rot6d;  // 25 nodes of 6
    add("150", rotations, true);
    add("two-persons", settings_for(ntu, 3, 2), true);
    add("two-persons-truth", settings_for(ntu, 3, 2), false);
    auto no_counter = settings_for(ntu, 6);
    no_counter.time_counter = false;
    add("no-counter", no_counter, true);
    for (const auto* tree : {&ntu, &smpl, &ntu13()})
        for (const auto feedback : {Feedback::raw, Feedback::joints})
            for (const bool own : {false, true}) {
                auto lie = settings_for(*tree, 5, 1, Body::lie);
                lie.feedback = feedback;
                add("lie-" + std::to_string(tree->joints()) +
                        (feedback == Feedback::raw ? "-raw" : "-joints") + (own ? "-own" : ""),
                    lie, own);
                all.back().in_pytorch = own == (tree != &smpl) && (tree == &ntu || feedback == Feedback::raw);
            }
    auto paper = settings_for(ntu, 6);
    paper.frames = frames;
    all.push_back({"paper", paper, true});
    return all;
}

Given given(const Case& of) {
    const auto d = of.settings.numbers(), latent = std::int64_t{of.settings.latent};
    return {at::randn({frames, motions, d}),
            at::arange(motions, at::kLong).remainder(std::int64_t{of.settings.classes}),
            at::randn({frames, motions, latent}),
            at::randn({frames, motions, latent}),
            at::rand({motions, d / 3}),
            of.own};
}

Given in_double(Given given) {
    for (auto* t : {&given.real, &given.noise, &given.prior_noise, &given.bones}) *t = t->to(at::kDouble);
    return given;
}

constexpr double lambda = 0.7;

/// Everything to compare: outputs, losses and gradients.
std::map<std::string, at::Tensor> results(Network& network, const Given& given) {
    for (auto& weight : network.parameters())
        if (weight.grad().defined()) weight.mutable_grad() = at::Tensor();
    const auto outcome = network.forward(given.real, given.labels, given.noise, given.own);
    const auto total = outcome.reconstruction.sum() + lambda * outcome.divergence.sum();
    total.backward();
    std::map<std::string, at::Tensor> all{
        {"pred", outcome.out},
        {"joints", outcome.poses},
        {"mu", outcome.posterior.mean},
        {"logvar", outcome.posterior.log_variance},
        {"mu_p", outcome.prior.mean},
        {"logvar_p", outcome.prior.log_variance},
        {"mse", outcome.reconstruction},
        {"kl", outcome.divergence},
        {"loss/total", total},
        {"generated", network.generate(given.labels, given.prior_noise, given.bones)}};
    for (const auto& item : network.named_parameters()) all["grad/" + item.key()] = item.value().grad();
    return all;
}

void expect_near(const at::Tensor& ours, const at::Tensor& theirs, double tolerance,
                 const std::string& what) {
    const auto scale = 1e-3 + theirs.abs().max().item<double>();
    EXPECT_LE((ours.to(at::kDouble) - theirs.to(at::kDouble)).abs().max().item<double>(), tolerance * scale)
        << what;
}

template <typename T>
void write(hdf5::Writer& file, const std::string& name, const at::Tensor& tensor, at::ScalarType type) {
    const auto values = tensor.detach().to(type).contiguous();
    const auto sizes = values.sizes();
    file.write<T>(name, {sizes.begin(), sizes.end()},
                  {values.data_ptr<T>(), static_cast<std::size_t>(values.numel())});
}

void write_weights(const std::filesystem::path& path, const Settings& s) {
    hdf5::Writer file(path);
    const Network network(s, 3);
    for (const auto& item : network.named_parameters())
        write<float>(file, item.key(), item.value(), at::kFloat);
    file.attribute("dim", s.numbers());
    file.attribute("classes", std::int64_t{s.classes});
    file.attribute("latent", std::int64_t{s.latent});
    file.attribute("hidden", std::int64_t{s.hidden});
    file.attribute("time", std::int64_t{s.time_counter});
    file.attribute("lie", std::int64_t{s.body == Body::lie});
    file.finish();
}

void write_input(const std::filesystem::path& path, const Given& in) {
    hdf5::Writer file(path);
    write<float>(file, "x", in.real.transpose(0, 1), at::kFloat);
    write<std::int64_t>(file, "y", in.labels, at::kLong);
    write<float>(file, "eps", in.noise, at::kFloat);
    write<float>(file, "eps_prior", in.prior_noise, at::kFloat);
    write<float>(file, "bones", in.bones, at::kFloat);
    file.finish();
}

/// Weights as exact as a file has them.
void load_rounded(Network& network, const std::filesystem::path& path) {
    const hdf5::Reader file(path);
    const at::NoGradGuard no_gradients;
    for (auto& item : network.named_parameters()) {
        auto values = file.read<float>(item.key());
        item.value().copy_(at::from_blob(values.data(), item.value().sizes(), at::kFloat));
    }
}

/// What the other side has for `name`, laid out as ours: its sequences have motions first.
at::Tensor theirs(const hdf5::Reader& out, const std::string& name, const at::Tensor& ours) {
    const bool of_motions = name == "pred" || name == "joints" || name == "generated";
    auto values = out.read<double>(name.starts_with("grad/") ? "grad_norm/" + name.substr(5) : name);
    if (!of_motions)
        return at::from_blob(values.data(), name.starts_with("grad/") ? at::IntArrayRef{} : ours.sizes(),
                             at::kDouble)
            .clone();
    return at::from_blob(values.data(), {ours.size(1), ours.size(0), ours.size(2)}, at::kDouble)
        .transpose(0, 1)
        .clone();
}

struct Action2Motion : testing::Test {
    Action2Motion() { at::manual_seed(5); }
};

}  // namespace

TEST_F(Action2Motion, CountsTheParametersOfThePaper) {
    const auto &ntu = ingest::ntu25(), &smpl = ingest::smpl24();
    EXPECT_EQ(counts(settings_for(ntu13(), 13)), (Counts{115'644, 115'644, 217'782}));
    EXPECT_EQ(counts(settings_for(ntu13(), 13, 1, Body::lie)), (Counts{115'644, 115'644, 220'434}));
    EXPECT_EQ(counts(settings_for(smpl, 12)), (Counts{117'820, 117'820, 222'280}));
    EXPECT_EQ(counts(settings_for(smpl, 12, 1, Body::lie)), (Counts{117'820, 117'820, 227'110}));
    EXPECT_EQ(counts(settings_for(ntu, 94)), (Counts{128'700, 128'700, 233'547}));
    EXPECT_EQ(counts(settings_for(ntu, 94, 1, Body::lie)), (Counts{128'700, 128'700, 238'803}));
    auto rotations = settings_for(smpl, 120);
    rotations.representation = Representation::rot6d;
    EXPECT_EQ(count(rotations), 539'406);
    EXPECT_EQ(count(settings_for(ntu, 26, 2)), 503'310);
    auto no_counter = settings_for(ntu13(), 13);
    no_counter.time_counter = false;
    EXPECT_EQ(count(no_counter), 448'686);
    std::int64_t trained = 0;
    for (const auto& weight : Network(settings_for(ntu, 94), 0).parameters()) trained += weight.numel();
    EXPECT_EQ(trained, 490'947);
}

TEST_F(Action2Motion, BothPathsAgreeForwardAndBack) {
    for (const auto& one : cases()) {
        Network fused(one.settings, 3, at::kDouble), plain(one.settings, 3, at::kDouble);
        plain.set_fused(false);
        const auto in = in_double(given(one));
        const auto ours = results(fused, in), theirs = results(plain, in);
        for (const auto& [name, values] : theirs)
            expect_near(ours.at(name), values, 1e-9, one.name + " " + name);
    }
}

TEST_F(Action2Motion, ThePapersSizeAgreesInFloat) {
    auto settings = settings_for(ingest::ntu25(), 94);
    Network fused(settings, 3), plain(settings, 3);
    plain.set_fused(false);
    const Given in{at::randn({60, 20, 75}),
                   at::randint(94, {20}, at::kLong),
                   at::randn({60, 20, 30}),
                   at::randn({60, 20, 30}),
                   {},
                   true};
    const auto ours = results(fused, in), theirs = results(plain, in);
    // Two orders of float sums, each fed on through 60 frames.
    for (const auto& [name, values] : theirs) expect_near(ours.at(name), values, 1e-4, name);
}

TEST_F(Action2Motion, PlacesJointsAsBonesAreLong) {
    const auto chains = *chains_of(ingest::smpl24().parents);
    const auto bones = at::rand({7, 24}, at::kDouble),
               joints = chain_kinematics(chains, at::randn({7, 72}, at::kDouble), bones);
    expect_near(bone_lengths(chains, joints).slice(1, 1), bones.slice(1, 1), 1e-12, "lengths");
    EXPECT_FALSE(chains_of(ingest::gta22().parents));
}

TEST_F(Action2Motion, TurnsMotionsIntoPosesAndBack) {
    const auto& tree = ingest::ntu25();
    for (const auto how : Representation::all())
        for (const std::uint32_t persons : {1U, 2U}) {
            auto settings = settings_for(tree, 3, persons);
            settings.representation = how;
            const MotionNumbers numbers(settings, "test");
            const auto motions = at::randn({2, settings.channels(), 4, settings.nodes()});
            const auto poses = numbers.poses(motions);
            ASSERT_EQ(poses.sizes(), (std::vector<std::int64_t>{4, 2, settings.numbers()}));
            // frame 3, motion 1: channel 2 of node 5
            EXPECT_EQ(poses[3][1][5 * settings.channels() + 2].item<float>(),
                      motions[1][2][3][5].item<float>());
            const auto back = numbers.motions(poses);
            ASSERT_EQ(back.sizes(), motions.sizes());
            EXPECT_TRUE(numbers.motions(numbers.poses(back)).allclose(back, 1e-3, 1e-4)) << how.name();
            if (how == Representation::rot6d) {
                EXPECT_TRUE(back.select(3, 25).slice(1, 3, 6).eq(0).all().item<bool>())
                    << "behind the translation";
                EXPECT_TRUE(back.select(3, 25).slice(1, 0, 3).equal(motions.select(3, 25).slice(1, 0, 3)));
            }
        }
    auto lie = settings_for(tree, 3, 1, Body::lie);
    lie.representation = Representation::limb;
    EXPECT_THROW(MotionNumbers(lie, "test"), Error);
    lie.bone_length.assign(25, 0.3F);
    const MotionNumbers numbers(lie, "test");
    const auto limbs = at::randn({2, 3, 4, 25}), unit = limbs / limbs.norm(2, {1}, true);
    const auto back = numbers.motions(numbers.poses(unit));
    EXPECT_TRUE(back.slice(3, 1).allclose(unit.slice(3, 1), 2e-3, 1e-3));
    EXPECT_TRUE(back.select(3, 0).equal(unit.select(3, 0)));
}

TEST_F(Action2Motion, RefusesMotionsThatDoNotFit) {
    const auto& of_list = model::method_named("action2motion", "test");
    const auto refused = [&](const model::MotionSpec& spec, std::vector<std::string> with,
                             const std::string& word) {
        auto config = model::generator_config(of_list);
        for (const auto& assignment : with) config.override_with(assignment);
        try {
            settings_of(config, spec);
            ADD_FAILURE() << "taken: " << word;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
        }
    };
    const model::MotionSpec one{Representation::limb, ingest::ntu25(), 1, 94, "ntu"};
    auto two = one, rotations = one, other_tree = one;
    two.persons = 2;
    rotations.representation = Representation::rot6d;
    other_tree.topology = ingest::gta22();
    refused(two, {"body=lie"}, "body: plain");
    refused(rotations, {"body=lie"}, "body: plain");
    refused(other_tree, {"body=lie"}, "no chains");
    refused(one, {"persons=2"}, "persons: 2");
    refused(one, {"classes=3"}, "classes: 3");
    refused(one, {"hidden=100"}, "hidden: 96");
    EXPECT_EQ(settings_of(model::generator_config(of_list), two).numbers(), 150);
}

TEST_F(Action2Motion, AgreesWithPyTorch) {
    const auto oracle = shared("reference/action2motion.py");
    if (!std::filesystem::exists(oracle)) GTEST_SKIP() << oracle << " is not at hand";
    if (!python_has("h5py, torch"))
        GTEST_SKIP() << "no Python with torch and h5py (Debian: python3-torch python3-h5py)";
    const TempDir dir;
    std::string runs;
    std::vector<std::pair<Case, Given>> all;
    for (const auto& one : cases()) {
        if (!one.in_pytorch) continue;
        const auto in = given(one);
        write_weights(dir / (one.name + "-weights.h5"), one.settings);
        write_input(dir / (one.name + "-input.h5"), in);
        runs += fmt::format("run('{}', {}, '{}')\n", one.name, in.own ? "['--self-feed']" : "[]",
                            one.settings.feedback == Feedback::joints ? "joints" : "raw");
        all.emplace_back(one, in);
    }
    // One Python for all: it takes seconds to start.
    write_file(dir / "all.py", fmt::format(R"(import runpy, sys
main = runpy.run_path('{}')['main']
def run(name, own, feedback):
    at = '{}/' + name
    sys.argv = ['action2motion.py', 'forward', at + '-weights.h5', at + '-input.h5', at + '-out.h5', '--double',
                '--feedback', feedback, '--lambda-kl', '{}'] + own
    main()
{})",
                                           oracle, dir.path().string(), lambda, runs));
    const auto run = run_command("OMP_WAIT_POLICY=passive /usr/bin/python3 " + (dir / "all.py").string());
    ASSERT_EQ(run.exit, 0) << run.output;
    for (const auto& [one, in] : all) {
        Network network(one.settings, 3, at::kDouble);
        const hdf5::Reader out(dir / (one.name + "-out.h5"));
        load_rounded(network, dir / (one.name + "-weights.h5"));
        for (const auto& [name, values] : results(network, in_double(in))) {
            if (name == "joints" && one.settings.body == Body::plain) continue;  // those it predicts
            expect_near(name.starts_with("grad/") ? values.norm() : values, theirs(out, name, values), 1e-5,
                        one.name + " " + name);
        }
    }
}
