// ActFormer's networks: counts, coarsening, both paths against each other and against a computation in NumPy, every switch.
#include <ATen/core/grad_mode.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "model/generators/actformer/discriminator.hpp"
#include "model/generators/actformer/generator.hpp"
#include "model/generators/adversarial/prior.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/tensors.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;
namespace hdf5 = hdf5;

namespace {

const std::vector<int> ntu(ingest::ntu25_parents.begin(), ingest::ntu25_parents.end());

/// Eight joints: a trunk, two arms and a leg.
const std::vector<int> small_tree{-1, 0, 1, 1, 3, 1, 5, 0};

ActFormerGeneratorSettings tiny_generator(std::uint32_t persons) {
    ActFormerGeneratorSettings s;
    s.parents = small_tree;
    s.persons = persons;
    s.classes = 5;
    s.frames = 20;
    s.width = 24;
    s.heads = 4;
    s.depth = 2;
    s.prior.channels = 6;
    s.prior.streams = 1;
    return s;
}

ActFormerDiscriminatorSettings tiny_discriminator(std::uint32_t persons) {
    ActFormerDiscriminatorSettings s;
    s.parents = small_tree;
    s.persons = persons;
    s.classes = 5;
    s.width = 3;
    return s;
}

/// A generator and a discriminator for the same motions.
struct Networks {
    ActFormerGeneratorSettings g;
    ActFormerDiscriminatorSettings d;
};

/// The discriminator sees joints of bodies that no other has.
void show_joints(Networks& n, double gain) {
    n.d.joint_gain = gain;
    auto& motions = n.d.motions;
    motions.representation = n.g.representation;
    motions.where = "test";
    const auto joints = small_tree.size() - (n.g.representation == ingest::Representation::rot6d ? 1 : 0);
    for (std::size_t j = 0; j < joints; ++j) {
        motions.topology.names.push_back(fmt::format("joint{}", j));
        motions.topology.parents.push_back(small_tree[j]);
        motions.bone_length.push_back(0.1F + 0.05F * static_cast<float>(j));
        for (int axis = 0; axis < 3; ++axis)
            motions.rest.push_back(0.3F - 0.11F * static_cast<float>((3 * j + axis) % 7));
    }
}

/// Every value of every switch at least once, each with some others.
std::vector<Networks> switched() {
    std::vector<Networks> all;
    const auto add = [&](std::uint32_t persons, const auto& change) {
        Networks networks{tiny_generator(persons), tiny_discriminator(persons)};
        change(networks);
        networks.d.numbers = networks.g.numbers();
        all.push_back(networks);
    };
    add(1, [](Networks&) {});
    add(1, [](Networks& n) { n.g.positions = Positions::concat; });
    add(1, [](Networks& n) { n.g.positions = Positions::fixed; });
    add(1, [](Networks& n) { n.g.prior.kind = PriorKind::gaussian; });
    add(1, [](Networks& n) { n.g.body = Body::graphconv; });
    add(1, [](Networks& n) { n.g.representation = ingest::Representation::rot6d; });
    add(1, [](Networks& n) { n.g.representation = ingest::Representation::xyz; });
    add(2, [](Networks&) {});
    add(2, [](Networks& n) { n.g.representation = ingest::Representation::rot6d; });
    add(2, [](Networks& n) {
        n.g.representation = ingest::Representation::xyz;
        n.g.body = Body::graphconv;
    });
    add(2, [](Networks& n) {
        n.g.positions = Positions::concat;
        n.g.prior.streams = 2;
        n.d.persons_in = PersonsInD::avgpool;
    });
    add(3, [](Networks& n) {
        n.g.positions = Positions::independent;
        n.d.persons_in = PersonsInD::maxpool;
    });
    add(2, [](Networks& n) {
        n.g.positions = Positions::fixed;
        n.d.persons_in = PersonsInD::selfatt;
    });
    add(2, [](Networks& n) {
        n.g.interaction = Interaction::concat;
        n.g.prior.streams = 2;
    });
    add(3, [](Networks& n) {
        n.g.interaction = Interaction::concat;
        n.g.body = Body::graphconv;
    });
    add(2, [](Networks& n) {
        n.g.body = Body::graphconv;
        n.g.representation = ingest::Representation::rot6d;
    });
    add(2, [](Networks& n) {
        n.g.positions_start = PositionsStart::sinusoids;
        n.d.differences = 2;
        n.d.difference_gain = 3;
    });
    add(2, [](Networks& n) {
        n.g.positions = Positions::concat;
        n.g.positions_start = PositionsStart::sinusoids;
    });
    add(2, [](Networks& n) { n.g.smooth = 1.5; });
    add(2, [](Networks& n) {
        n.g.smooth_root = 2;
        n.d.differences = 2;
        n.d.pose_gain = 3;
        n.d.persons_in = PersonsInD::maxpool;
        show_joints(n, 5);
    });
    add(1, [](Networks& n) {
        n.g.smooth_root = 30;
        n.g.representation = ingest::Representation::rot6d;
        show_joints(n, 4);
    });
    add(2, [](Networks& n) {
        n.g.smooth_root = 1.5;
        n.g.representation = ingest::Representation::xyz;
        n.d.difference_gain = 2;
        show_joints(n, 3);
    });
    add(2, [](Networks& n) {
        n.g.smooth = 3;
        n.g.interaction = Interaction::concat;
        n.g.body = Body::graphconv;
        n.g.representation = ingest::Representation::rot6d;
    });
    return all;
}

at::Tensor random_latent(const ActFormerGeneratorSettings& s, std::int64_t samples, std::int64_t frames) {
    return at::randn({samples, s.prior.streams, frames, s.prior.channels});
}

at::Tensor random_motion(const ActFormerDiscriminatorSettings& s, std::int64_t samples, std::int64_t frames) {
    return at::randn({samples, s.persons * s.numbers, frames, s.nodes()});
}

at::Tensor some_labels(std::int64_t samples) {
    return at::arange(samples, at::kLong).remainder(5);
}

/// Norms and biases away from where they start, so that every one of them matters.
void stir(torch::nn::Module& network) {
    const at::NoGradGuard no_gradients;
    for (auto& weight : network.parameters())
        if (weight.dim() == 1) weight.add_(at::randn_like(weight), 0.2);
}

/// The same weights and vectors in both.
void copy_weights(const torch::nn::Module& from, torch::nn::Module& to) {
    const at::NoGradGuard no_gradients;
    for (const auto& item : from.named_parameters()) to.named_parameters()[item.key()].copy_(item.value());
    for (const auto& item : from.named_buffers()) to.named_buffers()[item.key()].copy_(item.value());
}

struct ActformerNetworks : testing::Test {
    ActformerNetworks() { at::manual_seed(11); }
};

ActFormerGeneratorSettings paper_generator() {
    ActFormerGeneratorSettings s;
    s.parents = ntu;
    s.persons = 2;
    s.classes = 26;
    s.frames = 64;
    return s;
}

ActFormerDiscriminatorSettings paper_discriminator() {
    ActFormerDiscriminatorSettings s;
    s.parents = ntu;
    s.persons = 2;
    s.classes = 26;
    return s;
}

}  // namespace

TEST_F(ActformerNetworks, CountTheParametersOfTable6) {
    EXPECT_EQ(trained_count(actformer_generator_weights(paper_generator())), 1'359'675);
    EXPECT_EQ(trained_count(actformer_discriminator_weights(paper_discriminator())), 5'174'593);
    const auto trained = [](const torch::nn::Module& network) {
        std::int64_t sum = 0;
        for (const auto& weight : network.parameters()) sum += weight.numel();
        return sum;
    };
    EXPECT_EQ(trained(ActFormerGenerator(paper_generator(), 0)), 1'359'675);
    EXPECT_EQ(trained(ActFormerDiscriminator(paper_discriminator(), 0)), 5'174'593);
    const auto of_lines = [](const std::vector<SummaryLine>& lines) {
        std::int64_t sum = 0;
        for (const auto& line : lines) sum += line.parameters;
        return sum;
    };
    for (const auto& networks : switched()) {
        EXPECT_EQ(of_lines(actformer_generator_summary(networks.g, 20)),
                  trained(ActFormerGenerator(networks.g, 0)));
        EXPECT_EQ(of_lines(actformer_discriminator_summary(networks.d, 20)),
                  trained(ActFormerDiscriminator(networks.d, 0)));
    }
}

TEST_F(ActformerNetworks, StartAlikeForASeedAndNotForAnother) {
    const ActFormerGenerator one(tiny_generator(2), 3), same(tiny_generator(2), 3),
        other(tiny_generator(2), 4);
    for (const auto& item : one.named_parameters()) {
        EXPECT_TRUE(item.value().equal(same.named_parameters()[item.key()])) << item.key();
        if (item.key().ends_with("bias") || item.key().find("norm") != std::string::npos) continue;
        EXPECT_FALSE(item.value().equal(other.named_parameters()[item.key()])) << item.key();
    }
    const auto classes = one.named_parameters()["classes.weight"];
    expect_near(classes.mm(classes.t()), at::eye(5), 1e-6);  // orthogonal
}

TEST_F(ActformerNetworks, LearntPositionsMayBeginAtTheFixedOnes) {
    for (const auto persons : {1U, 2U}) {
        auto settings = tiny_generator(persons);
        settings.positions = Positions::fixed;
        const auto fixed = ActFormerGenerator(settings, 1).named_buffers()["positions"].clone();
        settings.positions_start = PositionsStart::sinusoids;
        settings.positions = Positions::tiled;
        EXPECT_TRUE(ActFormerGenerator(settings, 1).named_parameters()["positions"].equal(fixed)) << persons;
        settings.positions = Positions::independent;
        EXPECT_FALSE(ActFormerGenerator(settings, 1).named_parameters()["positions"].equal(fixed))
            << "its numbers each start on their own";
    }
    auto settings = tiny_generator(2);
    settings.positions = Positions::fixed;
    const auto fixed = ActFormerGenerator(settings, 1).named_buffers()["positions"].clone();  // (T + 1, P, W)
    settings.positions = Positions::concat;
    settings.positions_start = PositionsStart::sinusoids;
    const ActFormerGenerator parted(settings, 1);
    const auto half = std::int64_t{settings.width} / 2;
    EXPECT_TRUE(parted.named_parameters()["frame_positions"].equal(fixed.select(1, 0).slice(1, 0, half)));
    EXPECT_TRUE(parted.named_parameters()["person_positions"].equal(fixed[1].slice(1, half)));
}

TEST_F(ActformerNetworks, BothPathsAgreeForwardAndBack) {
    for (const auto& networks : switched()) {
        ActFormerGenerator fused(networks.g, 1, at::kDouble), plain(networks.g, 1, at::kDouble);
        ActFormerDiscriminator judge(networks.d, 2, at::kDouble), plain_judge(networks.d, 2, at::kDouble);
        stir(fused);
        stir(judge);
        copy_weights(fused, plain);
        copy_weights(judge, plain_judge);
        plain.set_fused(false);
        plain_judge.set_fused(false);
        const auto latent = random_latent(networks.g, 4, 17).to(at::kDouble);
        const auto labels = some_labels(4);
        for (int step = 0; step < 2; ++step) {  // the second sees the vectors that the first moved
            const auto ours = fused.forward(latent, labels), theirs = plain.forward(latent, labels);
            expect_near(ours, theirs, 1e-9);
            const auto score = judge.forward(ours, labels), plain_score = plain_judge.forward(theirs, labels);
            expect_near(score, plain_score, 1e-9);
            score.square().sum().backward();
            plain_score.square().sum().backward();
        }
        const auto compare = [](const torch::nn::Module& a, const torch::nn::Module& b) {
            const auto theirs = b.named_parameters();
            for (const auto& item : a.named_parameters()) {
                const auto &g = item.value().grad(), &h = theirs[item.key()].grad();
                ASSERT_TRUE(g.defined() && h.defined()) << item.key();
                EXPECT_TRUE(at::allclose(g, h, 1e-6, 1e-9 * (1 + h.abs().max().item<double>())))
                    << item.key();
            }
            const auto buffers = b.named_buffers();
            for (const auto& item : a.named_buffers()) expect_near(item.value(), buffers[item.key()], 1e-9);
        };
        compare(fused, plain);
        compare(judge, plain_judge);
    }
}

TEST_F(ActformerNetworks, ThePapersSizeAgreesInFloat) {
    ActFormerGenerator fused(paper_generator(), 1), plain(paper_generator(), 1);
    ActFormerDiscriminator judge(paper_discriminator(), 2), plain_judge(paper_discriminator(), 2);
    plain.set_fused(false);
    plain_judge.set_fused(false);
    const auto latent = random_latent(paper_generator(), 3, 60);
    const auto labels = some_labels(3);
    // Two libraries' orders of float sums over some thousand products, through four blocks and five convolutions.
    const auto ours = fused.forward(latent, labels), theirs = plain.forward(latent, labels);
    expect_near(ours, theirs, 2e-4);
    expect_near(judge.forward(ours, labels), plain_judge.forward(theirs, labels), 1e-3);
    const at::NoGradGuard no_gradients;
    fused.eval();
    const auto kept = fused.forward(latent, labels);
    expect_near(kept, fused.forward(latent, labels), 0);
    at::GradMode::set_enabled(true);
    expect_near(kept, fused.forward(latent, labels),
                1e-6);  // in place, and with what is kept for the backward pass
}

TEST_F(ActformerNetworks, GeneratedLimbsAndRotationsAreUnitVectors) {
    auto settings = tiny_generator(2);
    const at::NoGradGuard no_gradients;
    const auto limbs = ActFormerGenerator(settings, 1).forward(random_latent(settings, 3, 9), some_labels(3));
    EXPECT_EQ(limbs.sizes().vec(), (std::vector<std::int64_t>{3, 6, 9, 8}));
    const auto lengths = limbs.view({3, 2, 3, 9, 8}).norm(2, {2}).slice(3, 1);
    EXPECT_GT(lengths.min().item<double>(), 0.9);
    EXPECT_LE(lengths.max().item<double>(), 1 + 1e-6);

    settings.representation = ingest::Representation::rot6d;
    const auto rotations =
        ActFormerGenerator(settings, 1).forward(random_latent(settings, 3, 9), some_labels(3));
    const auto six = rotations.view({3, 2, 6, 9, 8}).slice(4, 0, 7);
    const auto a = six.slice(2, 0, 3), b = six.slice(2, 3, 6);
    expect_near(a.norm(2, {2}), at::ones({3, 2, 9, 7}), 1e-5);
    expect_near(b.norm(2, {2}), at::ones({3, 2, 9, 7}), 1e-5);
    expect_near((a * b).sum(2), at::zeros({3, 2, 9, 7}), 1e-5);
    const auto translation = rotations.view({3, 2, 6, 9, 8}).select(4, 7);
    expect_near(translation.slice(2, 3), at::zeros({3, 2, 3, 9}), 0);
    EXPECT_GT(translation.slice(2, 0, 3).abs().max().item<double>(), 0);
}

TEST_F(ActformerNetworks, SpectralNormsAreTheSvdsAfterManySteps) {
    ActFormerGenerator g(tiny_generator(2), 1);
    ActFormerDiscriminator d(tiny_discriminator(2), 2);
    const at::NoGradGuard no_gradients;
    const auto latent = random_latent(g.settings(), 2, 16);
    // Power iterations take their time where the two largest singular values are near each other.
    for (int i = 0; i < 400; ++i) d.forward(g.forward(latent, some_labels(2)), some_labels(2));
    const auto check = [](const WeightStore& store, const std::vector<NetworkWeight>& weights) {
        int spectral = 0;
        for (const auto& weight : weights) {
            if (!weight.spectral) continue;
            const auto matrix = store.at(weight.name).view({weight.rows, -1});
            const auto largest = std::get<1>(at::linalg_svd(matrix, false)).max().item<double>();
            EXPECT_NEAR(store.spectral_norm(weight.name).item<double>(), largest, 1e-4 * largest)
                << weight.name;
            const auto normal = store.normalised(weight.name, false).view({weight.rows, -1});
            EXPECT_NEAR(std::get<1>(at::linalg_svd(normal, false)).max().item<double>(), 1, 1e-4)
                << weight.name;
            ++spectral;
        }
        return spectral;
    };
    EXPECT_EQ(check(g.weights(), actformer_generator_weights(g.settings())), 1 + 4 * 4 + 2);
    EXPECT_EQ(check(d.weights(), actformer_discriminator_weights(d.settings())), 5 + 2);
}

TEST_F(ActformerNetworks, EvaluationMovesNothing) {
    ActFormerGenerator g(tiny_generator(2), 1);
    ActFormerDiscriminator d(tiny_discriminator(2), 2);
    g.eval();
    d.eval();
    std::vector<at::Tensor> before;
    for (const auto* network : {static_cast<torch::nn::Module*>(&g), static_cast<torch::nn::Module*>(&d)})
        for (const auto& buffer : network->buffers()) before.push_back(buffer.clone());
    const at::NoGradGuard no_gradients;
    d.forward(g.forward(random_latent(g.settings(), 2, 16), some_labels(2)), some_labels(2));
    std::size_t i = 0;
    for (const auto* network : {static_cast<torch::nn::Module*>(&g), static_cast<torch::nn::Module*>(&d)})
        for (const auto& buffer : network->buffers()) EXPECT_TRUE(buffer.equal(before[i++]));
}

TEST_F(ActformerNetworks, RefuseWhatTheyCannotTake) {
    ActFormerGenerator g(tiny_generator(2), 1);
    ActFormerDiscriminator d(tiny_discriminator(2), 2);
    EXPECT_THROW(g.forward(random_latent(g.settings(), 2, 21), some_labels(2)), Error);
    EXPECT_THROW(g.forward(at::randn({2, 1, 16, 5}), some_labels(2)), Error);
    EXPECT_THROW(g.forward(random_latent(g.settings(), 2, 16), some_labels(3)), Error);
    EXPECT_THROW(g.forward(random_latent(g.settings(), 2, 16), at::full({2}, 5, at::kLong)), c10::Error);
    EXPECT_THROW(d.forward(random_motion(d.settings(), 2, 15), some_labels(2)), Error);
    EXPECT_THROW(d.forward(at::randn({2, 6, 16, 7}), some_labels(2)), Error);
    EXPECT_NO_THROW(d.forward(random_motion(d.settings(), 2, 16), some_labels(2)));
    for (const auto& change : std::vector<std::function<void(ActFormerGeneratorSettings&)>>{
             [](auto& s) { s.heads = 5; }, [](auto& s) { s.width = 0; }, [](auto& s) { s.parents = {-1}; },
             [](auto& s) { s.classes = 0; }, [](auto& s) { s.prior.streams = 3; },
             [](auto& s) { s.prior.length_scale = 0; }}) {
        auto settings = tiny_generator(2);
        change(settings);
        EXPECT_THROW(ActFormerGenerator(settings, 0), Error);
    }
}

TEST_F(ActformerNetworks, AgreeWithNumPy) {
    const std::string oracle = source("tests/model/generators/actformer/oracle.py");
    if (!python_has("h5py, numpy"))
        GTEST_SKIP() << "no Python with numpy and h5py (Debian: python3-numpy python3-h5py)";
    TempDir dir;
    auto cases = switched();
    cases.push_back({paper_generator(), paper_discriminator()});
    const char* interactions[] = {"iformer", "concat"};
    const char* bodies[] = {"transformer", "graphconv"};
    const char* persons_in[] = {"concat", "avgpool", "maxpool", "selfatt"};
    for (const auto& [gs, ds] : cases) {
        ActFormerGenerator g(gs, 7);
        ActFormerDiscriminator d(ds, 8);
        stir(g);
        stir(d);
        g.eval();
        d.eval();
        const at::NoGradGuard no_gradients;
        const std::int64_t samples = 2, frames = 17;
        const auto latent = random_latent(gs, samples, frames),
                   motion = random_motion(ds, samples, frames + 2), labels = some_labels(samples);
        const bool is_ntu = gs.parents == ntu;
        const auto levels = skeleton_levels(gs.parents);
        const nlohmann::json about{
            {"parents", gs.parents},
            {"persons", gs.persons},
            {"numbers", gs.numbers()},
            {"representation", gs.representation.name()},
            {"width", gs.width},
            {"heads", gs.heads},
            {"depth", gs.depth},
            {"interaction", interactions[static_cast<int>(gs.interaction)]},
            {"body", bodies[static_cast<int>(gs.body)]},
            {"smooth", gs.smooth},
            {"smooth_root", gs.smooth_root},
            {"differences", ds.differences},
            {"pose_gain", ds.pose_gain},
            {"gain", ds.difference_gain},
            {"joint_gain", ds.joint_gain},
            {"bone_length", ds.motions.bone_length},
            {"rest", ds.motions.rest},
            {"d_persons", persons_in[static_cast<int>(ds.persons_in)]},
            {"middle",
             is_ntu ? std::vector<std::uint32_t>{0, 3, 5, 7, 9, 11, 13, 15, 17, 19, 20} : levels.middle_kept},
            {"coarse", is_ntu ? std::vector<std::uint32_t>{3, 5, 6, 8, 10} : levels.coarse_kept}};
        {
            hdf5::Writer file(dir / "case.h5");
            file.attribute("case", about.dump());
            const auto write = [&](const std::string& name, const at::Tensor& tensor) {
                const auto values = tensor.detach().to(at::kFloat).contiguous();
                const auto sizes = values.sizes();
                file.write<float>(name, {sizes.begin(), sizes.end()},
                                  {values.data_ptr<float>(), static_cast<std::size_t>(values.numel())});
            };
            const auto write_all = [&](const std::string& prefix, const torch::nn::Module& network) {
                for (const auto& item : network.named_parameters()) write(prefix + item.key(), item.value());
                for (const auto& item : network.named_buffers()) write(prefix + item.key(), item.value());
            };
            write_all("generator.", g);
            write_all("discriminator.", d);
            write("latent", latent);
            write("motion", motion);
            write("labels", labels);
            file.finish();
        }
        const auto run = run_command("/usr/bin/python3 " + oracle + " " + (dir / "case.h5").string() + " " +
                                     (dir / "out.h5").string());
        ASSERT_EQ(run.exit, 0) << run.output;
        const hdf5::Reader out(dir / "out.h5");
        auto generated = out.read<float>("motion"), scores = out.read<float>("scores");
        for (const bool fused : {true, false}) {
            g.set_fused(fused);
            d.set_fused(fused);
            const auto ours = g.forward(latent, labels);
            // Floats against doubles, through as many layers as the network has.
            expect_near(ours, at::from_blob(generated.data(), ours.sizes(), at::kFloat), 2e-4);
            expect_near(d.forward(motion, labels), at::from_blob(scores.data(), {samples}, at::kFloat), 2e-4);
        }
        std::filesystem::remove(dir / "out.h5");
    }
}
