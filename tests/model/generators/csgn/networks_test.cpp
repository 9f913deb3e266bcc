// CSGN's networks: counts, graphs, both paths against each other and against a reference in PyTorch.
#include <ATen/core/grad_mode.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "model/generators/csgn/discriminator.hpp"
#include "model/generators/csgn/generator.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/tensors.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;

namespace {

const std::vector<int> ntu(ingest::ntu25_parents.begin(), ingest::ntu25_parents.end());
const std::vector<int> smpl{-1, 0, 0,  0,  1,  2,  3,  4,  5,  6,  7,  8, 9,
                            9,  9, 12, 13, 14, 16, 17, 18, 19, 20, 21, 0};
const std::vector<int> gta{-1, 2, 11, 2, 3, 4, 5, 2, 7, 8, 9, 12, 13, 14, 0, 1, 0, 16, 17, 0, 19, 20};

CsgnSettings settings(const std::vector<int>& parents, std::uint32_t persons, std::uint32_t classes,
                      ingest::Representation how = ingest::Representation::limb,
                      Partition partition = Partition::radial) {
    CsgnSettings s;
    s.parents = parents;
    s.persons = persons;
    s.classes = classes;
    s.representation = how;
    s.partition = partition;
    return s;
}

CsgnSettings small(CsgnSettings s) {
    s.width = s.d_width = 4;
    s.latent = 6;
    s.frames = 20;
    return s;
}

std::vector<CsgnSettings> all_kinds() {
    using ingest::Representation;
    return {small(settings(ntu, 1, 5)), small(settings(smpl, 1, 5, Representation::rot6d)),
            small(settings(gta, 3, 5, Representation::xyz)),
            small(settings(ntu, 2, 5, Representation::limb, Partition::none)),
            small(settings({-1, 0, 1, 1, 3}, 5, 5))};
}

at::Tensor random_latent(const CsgnSettings& s, std::int64_t samples, std::int64_t frames) {
    return at::randn({samples, 1, latent_frames(static_cast<std::uint32_t>(frames)), s.latent}, at::kDouble);
}

at::Tensor some_labels(std::int64_t samples) {
    return at::arange(samples, at::kLong).remainder(5);
}

void copy_all(const torch::nn::Module& from, torch::nn::Module& to) {
    const at::NoGradGuard no_gradients;
    for (const auto& item : from.named_parameters()) to.named_parameters()[item.key()].copy_(item.value());
    for (const auto& item : from.named_buffers()) to.named_buffers()[item.key()].copy_(item.value());
}

/// Every number away from where it starts, so that all matter.
void stir(torch::nn::Module& network) {
    const at::NoGradGuard no_gradients;
    for (auto& weight : network.parameters()) weight.add_(at::randn_like(weight), 0.2);
}

void expect_same_gradients(const torch::nn::Module& a, const torch::nn::Module& b) {
    const auto theirs = b.named_parameters();
    for (const auto& item : a.named_parameters())
        expect_near(item.value().grad(), theirs[item.key()].grad(), 1e-8, item.key());
    const auto buffers = b.named_buffers();
    for (const auto& item : a.named_buffers())
        expect_near(item.value(), buffers[item.key()], 1e-9, item.key());
}

struct CsgnNetworks : testing::Test {
    CsgnNetworks() { at::manual_seed(5); }
};

using Nodes = std::vector<std::uint32_t>;

Nodes coarse_nodes(const SkeletonLevels& levels) {
    Nodes nodes;
    for (const auto node : levels.coarse_kept) nodes.push_back(levels.middle_kept[node]);
    return nodes;
}

}  // namespace

TEST_F(CsgnNetworks, CountTheParametersOfTheReference) {
    const auto expect = [](const CsgnSettings& s, std::int64_t generator, std::int64_t discriminator) {
        EXPECT_EQ(trained_count(csgn_generator_weights(s)), generator);
        EXPECT_EQ(trained_count(csgn_discriminator_weights(s)), discriminator);
        const auto of_lines = [](const std::vector<SummaryLine>& lines) {
            std::int64_t sum = 0;
            for (const auto& line : lines) sum += line.parameters;
            return sum;
        };
        EXPECT_EQ(of_lines(csgn_generator_summary(s)), generator);
        EXPECT_EQ(of_lines(csgn_discriminator_summary(s)), discriminator);
    };
    using ingest::Representation;
    expect(settings(ntu, 1, 94), 3'229'225, 3'189'665);
    expect(settings(ntu, 1, 94, Representation::limb, Partition::none), 3'056'710, 3'016'641);
    expect(settings(ntu, 2, 26), 3'165'394, 3'157'729);
    expect(settings(smpl, 1, 120, Representation::rot6d), 3'255'634, 3'205'857);
    const std::vector<std::pair<std::int64_t, std::int64_t>> of_gta{
        {2'617'106, 2'620'641}, {2'618'555, 2'623'521}, {2'620'004, 2'626'401}, {2'621'453, 2'629'281}};
    for (std::uint32_t i = 0; i < of_gta.size(); ++i)
        expect(settings(gta, i + 2, 1, Representation::xyz), of_gta[i].first, of_gta[i].second);
}

TEST_F(CsgnNetworks, KeepTheNodesOfTheReference) {
    const auto of_ntu = skeleton_levels(ntu, Mirror::first), of_smpl = skeleton_levels(smpl, Mirror::first),
               of_gta = skeleton_levels(gta, Mirror::first);
    EXPECT_EQ(of_ntu.middle_kept, (Nodes{0, 3, 5, 7, 9, 11, 13, 15, 17, 19, 20}));
    EXPECT_EQ(coarse_nodes(of_ntu), (Nodes{7, 11, 13, 17, 20}));
    EXPECT_EQ(of_smpl.middle_kept, (Nodes{1, 2, 3, 7, 8, 9, 15, 16, 17, 20, 21, 24}));
    EXPECT_EQ(coarse_nodes(of_smpl), (Nodes{1, 8, 9, 20, 21}));
    EXPECT_EQ(of_gta.middle_kept, (Nodes{0, 1, 3, 5, 7, 9, 11, 13, 17, 20}));
    EXPECT_EQ(coarse_nodes(of_gta), (Nodes{0, 5, 9, 11}));
}

TEST_F(CsgnNetworks, BothPathsAgreeForwardAndBack) {
    for (const auto& s : all_kinds()) {
        CsgnGenerator fused(s, 1, at::kDouble), plain(s, 1, at::kDouble);
        CsgnDiscriminator critic(s, 2, at::kDouble), plain_critic(s, 2, at::kDouble);
        stir(fused);
        stir(critic);
        copy_all(fused, plain);
        copy_all(critic, plain_critic);
        plain.set_fused(false);
        plain_critic.set_fused(false);
        const auto labels = some_labels(4);
        const auto latent = random_latent(s, 4, 19);
        for (int step = 0; step < 2;
             ++step) {  // the second sees the vectors and statistics that the first moved
            const auto ours = fused.generate(latent, labels, 19), theirs = plain.generate(latent, labels, 19);
            expect_near(ours, theirs, 1e-9);
            const auto score = critic.forward(ours, labels), other = plain_critic.forward(theirs, labels);
            expect_near(score, other, 1e-9);
            score.square().sum().backward();
            other.square().sum().backward();
        }
        expect_same_gradients(fused, plain);
        expect_same_gradients(critic, plain_critic);
        fused.eval();
        plain.eval();
        const at::NoGradGuard no_gradients;
        expect_near(fused.generate(latent, labels, 19), plain.generate(latent, labels, 19), 1e-9);
    }
}

TEST_F(CsgnNetworks, GenerateWhatTheRepresentationDemands) {
    const at::NoGradGuard no_gradients;
    const auto s = small(settings(smpl, 2, 5, ingest::Representation::rot6d));
    const auto motion =
        CsgnGenerator(s, 1, at::kDouble).generate(random_latent(s, 3, 20), some_labels(3), 20);
    EXPECT_EQ(motion.sizes().vec(), (std::vector<std::int64_t>{3, 12, 20, 25}));
    const auto six = motion.view({3, 2, 6, 20, 25});
    const auto a = six.slice(2, 0, 3).slice(4, 0, 24), b = six.slice(2, 3, 6).slice(4, 0, 24);
    expect_near(a.norm(2, {2}), at::ones({3, 2, 20, 24}), 1e-9);
    expect_near((a * b).sum(2), at::zeros({3, 2, 20, 24}), 1e-9);
    EXPECT_EQ(six.slice(2, 3, 6).select(4, 24).abs().max().item<double>(), 0);
}

TEST_F(CsgnNetworks, RunningStatisticsOfAnEmaAreItsOwn) {
    const auto s = small(settings(ntu, 1, 5));
    CsgnGenerator network(s, 1);
    stir(network);
    const Prior prior(s.prior(), 3);
    const auto labels = some_labels(1024);
    network.recompute_buffers(prior, labels, 20);
    // Statistics over many batches more, moved slowly: those of the same weights.
    const at::NoGradGuard no_gradients;
    const auto found = network.named_buffers()["norm0.variance"].clone();
    for (std::uint64_t i = 0; i < 40; ++i) network.generate(prior.draw(i, 64, 2), some_labels(64), 20);
    const auto moved = network.named_buffers()["norm0.variance"];
    EXPECT_LT(((found - moved).abs() / moved).mean().item<double>(), 0.1);
    EXPECT_GT((moved - 1).abs().mean().item<double>(), 0.1) << "they start at 1";
    CsgnGenerator other(s, 1);
    copy_all(network, other);
    other.recompute_buffers(prior, labels, 20);
    EXPECT_TRUE(found.equal(other.named_buffers()["norm0.variance"])) << "whatever they were before";
}

TEST_F(CsgnNetworks, RefuseWhatTheyCannotTake) {
    const auto s = small(settings(ntu, 1, 5));
    CsgnGenerator g(s, 1, at::kDouble);
    CsgnDiscriminator d(s, 2, at::kDouble);
    EXPECT_THROW(g.generate(random_latent(s, 2, 17), some_labels(2), 16), Error) << "two latent frames";
    EXPECT_THROW(g.generate(random_latent(s, 2, 16), some_labels(3), 16), Error);
    EXPECT_THROW(d.forward(at::randn({2, 3, 15, 25}, at::kDouble), some_labels(2)), Error);
    EXPECT_THROW(d.forward(at::randn({2, 6, 16, 25}, at::kDouble), some_labels(2)), Error);
    EXPECT_NO_THROW(d.forward(at::randn({2, 3, 16, 25}, at::kDouble), some_labels(2)));
    for (const auto& change : std::vector<std::function<void(CsgnSettings&)>>{
             [](auto& c) { c.width = 0; }, [](auto& c) { c.latent = 0; }, [](auto& c) { c.parents = {-1}; },
             [](auto& c) { c.frames = 15; }, [](auto& c) { c.length_scale = 0; }}) {
        auto changed = s;
        change(changed);
        EXPECT_THROW(CsgnGenerator(changed, 0), Error);
    }
}

namespace {

/// What csgn.py wrote of one case.
struct Reference {
    hdf5::Reader weights, input, out;

    Reference(const TempDir& dir, const std::string& name)
        : weights(dir / (name + "-weights.h5")),
          input(dir / (name + "-input.h5")),
          out(dir / (name + "-out.h5")) {}

    static at::Tensor tensor(const hdf5::Reader& file, const std::string& name) {
        const auto values = file.read<double>(name);
        const auto shape = file.shape(name);
        return at::tensor(values, at::kDouble)
            .reshape(at::IntArrayRef(std::vector<std::int64_t>(shape.begin(), shape.end())));
    }
    at::Tensor result(const std::string& name) const { return tensor(out, name); }
    at::Tensor given(const std::string& name) const { return tensor(input, name); }
};

/// A weight of the reference (or its gradient) in the layout of ours. Levels that double the frames are (in, out, hops, 4) there:
/// an odd frame takes taps 2 and 0, an even one 3 and 1.
at::Tensor in_our_layout(const std::string& name, const at::Tensor& theirs) {
    if (name.starts_with("g.up")) {
        const auto in = theirs.size(0), out = theirs.size(1), hops = theirs.size(2);
        return theirs.permute({3, 1, 2, 0})
            .index_select(0, at::tensor({2, 0, 3, 1}, at::kLong))
            .view({2, 2, out, hops, in})
            .permute({0, 2, 3, 1, 4})
            .reshape({2 * out, hops, 2, in});
    }
    return theirs.dim() == 4 ? theirs.permute({0, 2, 3, 1}).contiguous() : theirs;
}

/// "g.cbn0.gamma" as "norm0.gain".
std::string our_name(const std::string& theirs) {
    auto name = theirs.substr(2);
    if (name == "embedding.weight") return "classes.weight";
    for (const auto& [from, to] : {std::pair{"cbn", "norm"}, {"gamma", "gain"}, {"beta", "shift"}})
        if (const auto at = name.find(from); at != std::string::npos)
            name.replace(at, std::string(from).size(), to);
    return name;
}

void take_weights(const Reference& reference, torch::nn::Module& g, torch::nn::Module& d) {
    const at::NoGradGuard no_gradients;
    const auto tensor = [&](const std::string& name) { return Reference::tensor(reference.weights, name); };
    for (const auto& name : reference.weights.names()) {
        if (!name.starts_with("g.") && !name.starts_with("d.")) continue;
        auto& network = name.starts_with("g.") ? g : d;
        network.named_parameters()[our_name(name)].copy_(in_our_layout(name, tensor(name)));
        if (name.starts_with("d.") && name.ends_with("weight"))
            d.named_buffers()[our_name(name) + "_u"].copy_(tensor("u/" + name));
    }
    for (int i = 0; i < 4; ++i)
        for (const auto& [theirs, ours] : {std::pair{"mean", "mean"}, {"var", "variance"}})
            g.named_buffers()[fmt::format("norm{}.{}", i, ours)].copy_(
                tensor(fmt::format("bn/cbn{}.{}", i, theirs)));
}

void expect_gradients(const Reference& reference, const std::string& prefix,
                      const torch::nn::Module& network) {
    for (const auto& name : reference.weights.names()) {
        if (!name.starts_with(prefix)) continue;
        const auto theirs = in_our_layout(name, reference.result("grad/" + name));
        const auto ours = network.named_parameters()[our_name(name)].grad();
        const auto scale = 1e-3 + theirs.abs().max().item<double>();
        EXPECT_LE((ours - theirs).abs().max().item<double>(), 1e-5 * scale) << name;
    }
}

struct Case {
    std::string name, options;
    CsgnSettings settings;
    Loss loss;
};

CsgnSettings of_reference(CsgnSettings s, std::uint32_t frames) {
    s.width = s.d_width = 8;
    s.latent = 16;
    s.frames = frames;
    return s;
}

void expect_agreement(const Case& one, const Reference& reference) {
    const auto& s = one.settings;
    CsgnGenerator g(s, 1, at::kDouble);
    CsgnDiscriminator d(s, 2, at::kDouble);
    take_weights(reference, g, d);
    // The prior in float, as it is used; the networks from the reference's own latents, in double.
    const auto eps = reference.given("eps").transpose(1, 2).unsqueeze(1).to(at::kFloat).contiguous();
    const auto z = reference.result("z").transpose(1, 2).unsqueeze(1).contiguous();
    expect_near(Prior(s.prior(), 0).correlated(eps), z, 1e-6, "z");
    const auto real = reference.given("real").transpose(2, 3).contiguous();
    const auto y_real = reference.given("y_real").to(at::kLong),
               y_fake = reference.given("y_fake").to(at::kLong);
    const auto motion = [&](const std::string& name) { return reference.result(name).transpose(2, 3); };
    {
        const at::NoGradGuard no_gradients;
        g.eval();
        expect_near(g.generate(z, y_fake, s.frames), motion("fake_eval"), 1e-5, "by running statistics");
        g.train();
    }
    const auto fake = g.generate(z, y_fake, s.frames);
    expect_near(fake, motion("fake"), 1e-5, "fake");
    for (int i = 0; i < 4; ++i)
        for (const auto& [theirs, ours] : {std::pair{"mean", "mean"}, {"var", "variance"}})
            expect_near(g.named_buffers()[fmt::format("norm{}.{}", i, ours)],
                        reference.result(fmt::format("bn/cbn{}.{}", i, theirs)), 1e-5, ours);

    CsgnDiscriminator again(s, 2, at::kDouble);  // with the vectors that the reference begins with
    copy_all(d, again);
    const auto score_real = d.forward(real, y_real), score_fake = d.forward(fake.detach(), y_fake);
    expect_near(score_real, reference.result("score_real"), 1e-5, "real scores");
    expect_near(score_fake, reference.result("score_fake"), 1e-5, "fake scores");
    const auto loss = one.loss == Loss::hinge
                          ? at::relu(1 - score_real).mean() + at::relu(1 + score_fake).mean()
                          : score_fake.mean() - score_real.mean();
    expect_near(loss, reference.result("loss/d").squeeze(), 1e-5, "discriminator's loss");
    loss.backward();
    expect_gradients(reference, "d.", d);

    const auto score = again.forward(fake, y_fake);
    expect_near(-score.mean(), reference.result("loss/g").squeeze(), 1e-5, "generator's loss");
    (-score.mean()).backward();
    expect_gradients(reference, "g.", g);
}

}  // namespace

TEST_F(CsgnNetworks, AgreeWithTheReferenceInPyTorch) {
    if (!std::filesystem::exists(shared("reference/csgn.py"))) GTEST_SKIP() << "no reference program csgn.py";
    if (!python_has("h5py, torch"))
        GTEST_SKIP() << "no Python with torch and h5py (Debian: python3-torch python3-h5py)";
    using ingest::Representation;
    const std::string sizes = ",base=8,latent=16,batch=3,classes=5";
    const std::vector<Case> cases{
        {"ntu", "skeleton=ntu,loss=hinge", of_reference(settings(ntu, 1, 5), 60), Loss::hinge},
        {"smpl", "skeleton=smpl,channels=6,loss=wasserstein",
         of_reference(settings(smpl, 1, 5, Representation::rot6d), 60), Loss::wasserstein},
        {"pairs", "skeleton=ntu,persons=2,partition=none,loss=hinge,frames=64",
         of_reference(settings(ntu, 2, 5, Representation::limb, Partition::none), 64), Loss::hinge},
        {"gta", "skeleton=gta,persons=3,loss=wasserstein,frames=53", of_reference(settings(gta, 3, 5), 53),
         Loss::wasserstein}};
    const TempDir dir;
    std::string line = "/usr/bin/python3 " + source("tests/model/generators/csgn/oracle.py") + " " +
                       shared("reference/csgn.py") + " " + dir.path().string();
    for (const auto& one : cases) line += " " + one.name + ":" + one.options + sizes;
    const auto run = run_command(line);
    ASSERT_EQ(run.exit, 0) << run.output;
    for (const auto& one : cases) {
        SCOPED_TRACE(one.name);
        expect_agreement(one, Reference(dir, one.name));
    }
}
