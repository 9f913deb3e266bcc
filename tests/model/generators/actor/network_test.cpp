// ACTOR's networks: counts, both paths against each other, dropout included, and against PyTorch's.
#include "model/generators/actor/network.hpp"

#include <ATen/core/grad_mode.h>
#include <gtest/gtest.h>

#include <set>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "model/generators/actor/layers.hpp"
#include "model/generators/actor/losses.hpp"
#include "model/nn/fused_post_norm.hpp"
#include "tests/support/command.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/tensors.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;
using ingest::Representation;

namespace {

ActorSettings paper(Representation representation, std::uint32_t nodes, std::uint32_t persons,
                    std::uint32_t classes) {
    ActorSettings s;
    s.representation = representation;
    s.nodes = nodes;
    s.persons = persons;
    s.classes = classes;
    return s;
}

/// Widths that are no whole vectors.
ActorSettings tiny(Representation representation = Representation::limb, std::uint32_t persons = 1) {
    auto s = paper(representation, 9, persons, 5);
    s.width = 36;
    s.heads = 3;
    s.layers = 2;
    s.hidden = 50;
    return s;
}

at::Tensor motion_for(const ActorSettings& s, std::int64_t samples, std::int64_t frames) {
    return at::randn({samples, std::int64_t{s.persons} * s.representation.numbers(), frames, s.nodes},
                     at::kDouble);
}

at::Tensor some_labels(std::int64_t samples) {
    return at::arange(samples, at::kLong).remainder(5);
}

/// Norms and biases away from where they start, so that every one of them matters.
void stir(torch::nn::Module& network) {
    const at::NoGradGuard no_gradients;
    for (auto& weight : network.parameters()) weight.add_(at::randn_like(weight), 0.05);
}

/// Everything at once: encode, draw, decode.
at::Tensor through(const ActorNet& net, const at::Tensor& motion, const at::Tensor& noise,
                   const ActorDropout& dropout) {
    const auto labels = some_labels(motion.size(0));
    const auto latent = net.encode(motion, labels, dropout);
    return net.decode(latent.mean + noise * (latent.log_variance / 2).exp(), labels, motion.size(2), dropout);
}

struct ActorNetwork : testing::Test {
    ActorNetwork() { at::manual_seed(5); }
};

}  // namespace

TEST_F(ActorNetwork, CountsTheParametersOfThePapersModel) {
    struct Row {
        ActorSettings settings;
        std::int64_t encoder, total;
    };
    const Row rows[] = {{paper(Representation::rot6d, 25, 1, 13), 6'363'392, 14'832'790},
                        {paper(Representation::rot6d, 25, 1, 12), 0, 14'832'022},
                        {paper(Representation::rot6d, 25, 1, 40), 0, 14'853'526},
                        {paper(Representation::rot6d, 25, 1, 94), 0, 14'894'998},
                        {paper(Representation::rot6d, 25, 1, 120), 0, 14'914'966},
                        {paper(Representation::limb, 25, 2, 26), 0, 14'842'774},
                        {paper(Representation::limb, 25, 1, 94), 6'385'664, 14'856'523},
                        {paper(Representation::rot6d, 22, 1, 1), 0, 14'814'340}};
    for (const auto& row : rows) {
        const auto weights = actor_weights(row.settings);
        EXPECT_EQ(trained_count(weights), row.total);
        if (row.encoder > 0) {
            EXPECT_EQ(trained_count(weights, "encoder."), row.encoder);
        }
        std::int64_t told = 0;
        for (const auto& network : actor_summary(row.settings, 60))
            for (const auto& line : network.lines) told += line.parameters;
        EXPECT_EQ(told, row.total);
    }
    std::int64_t held = 0;
    for (const auto& weight : ActorNet(rows[6].settings, 0).parameters()) held += weight.numel();
    EXPECT_EQ(held, rows[6].total);
}

TEST_F(ActorNetwork, StartsAsThePublicCodeDoes) {
    const ActorNet one(tiny(), 3), same(tiny(), 3), other(tiny(), 4);
    const auto weights = one.named_parameters();
    for (const auto& item : weights)
        EXPECT_TRUE(item.value().equal(same.named_parameters()[item.key()])) << item.key();
    EXPECT_FALSE(weights["encoder.muQuery"].equal(other.named_parameters()["encoder.muQuery"]));
    const std::string layers = "decoder.seqTransDecoder.layers.";
    for (const auto* name : {"self_attn.in_proj_weight", "multihead_attn.out_proj.weight", "linear2.bias"})
        EXPECT_TRUE(weights[layers + "0." + name].equal(weights[layers + "1." + name])) << name;
    EXPECT_EQ(weights[layers + "0.self_attn.in_proj_bias"].abs().max().item<float>(), 0);
    const auto most = weights[layers + "0.self_attn.in_proj_weight"].abs().max().item<double>();
    const double xavier = std::sqrt(6.0 / (4 * 36));
    EXPECT_LE(most, xavier);
    EXPECT_GT(most, 0.99 * xavier);                                        // of 3888 numbers
    EXPECT_NEAR(weights["encoder.muQuery"].std().item<double>(), 1, 0.2);  // of 180 numbers
}

TEST_F(ActorNetwork, BothPathsAgreeForwardAndBackWithAndWithoutDropout) {
    for (const auto& settings : {tiny(), tiny(Representation::rot6d, 2)})
        for (const double rate : {0.0, 0.3}) {
            ActorNet fused(settings, 1, at::kDouble), plain(settings, 1, at::kDouble);
            at::manual_seed(6);
            stir(fused);
            at::manual_seed(6);
            stir(plain);
            plain.set_fused(false);
            const ActorDropout dropout{rate, 9, 4, 2};
            const auto motion = motion_for(settings, 3, 21),
                       noise = at::randn({3, settings.width}, at::kDouble);
            const auto ours = through(fused, motion, noise, dropout),
                       theirs = through(plain, motion, noise, dropout);
            expect_near(ours, theirs, 1e-10);
            const auto probe = at::randn_like(ours);
            (ours * probe).sum().backward();
            (theirs * probe).sum().backward();
            const auto others = plain.named_parameters();
            for (const auto& item : fused.named_parameters()) {
                const auto &g = item.value().grad(), &h = others[item.key()].grad();
                ASSERT_TRUE(g.defined() && h.defined()) << item.key();
                expect_near(g, h, 1e-9);
            }
            const at::NoGradGuard no_gradients;
            expect_near(through(fused, motion, noise, dropout), ours,
                        1e-12);  // nothing kept for the backward pass
        }
}

TEST_F(ActorNetwork, DropsOtherNumbersInOtherStepsAndTheirShare) {
    const auto x = at::ones({4, 30, 100});
    const auto kept = [&](std::uint64_t step, std::uint64_t first) {
        return kept_numbers(x, ActorDropout{0.1, 1, step, first}.at(7));
    };
    const auto now = kept(3, 0);
    EXPECT_TRUE(now.equal(kept(3, 0)));
    EXPECT_FALSE(now.equal(kept(4, 0)));
    EXPECT_TRUE(now.slice(0, 2).equal(kept(3, 2).slice(0, 0, 2))) << "a process's part of a batch";
    // 12,000 numbers: the share has a deviation of 0.0027.
    EXPECT_NEAR((now == 0).to(at::kDouble).mean().item<double>(), 0.1, 0.012);
    EXPECT_NEAR(now.max().item<double>(), 1 / 0.9, 1e-4);  // rates are in steps of 2^-16
}

TEST_F(ActorNetwork, DropsOtherNumbersInEveryProcessStepAndTrainingOnGpus) {
    std::set<std::uint64_t> seeds;
    for (std::uint64_t seed = 0; seed < 10; ++seed)
        for (std::uint64_t step = 0; step < 10; ++step)
            for (std::uint64_t site = 0; site < 10; ++site)
                for (const std::uint64_t first_sample : {0, 64, 128})
                    seeds.insert(ActorDropout{0.1, seed, step, first_sample}.at(site).seed());
    EXPECT_EQ(seeds.size(), 3000U);
}

TEST_F(ActorNetwork, AgreesWithPyTorch) {
    const auto oracle = shared("reference/actor.py");
    if (!has_eager_pytorch() || !std::filesystem::exists(oracle))
        GTEST_SKIP()
            << "no Python with torch and h5py (Debian: python3-torch python3-h5py), or no reference programs";
    struct Case {
        const char *name, *sizes, *options;
        ActorSettings settings;
        double kl_factor;
        bool points;
    };
    auto limbs = paper(Representation::limb, 25, 1, 7), rotations = paper(Representation::rot6d, 25, 1, 4),
         pairs = paper(Representation::limb, 25, 2, 6);
    for (auto* s : {&limbs, &rotations, &pairs}) s->layers = 2;
    const Case cases[] = {{"limbs", "--feats 3 --classes 7", "", limbs, 1e-5, false},
                          {"rotations", "--feats 6 --classes 4", "--xyz fk", rotations, 1e-5, true},
                          {"pairs", "--feats 6 --classes 6", "--lambda-kl 3e-4", pairs, 3e-4, false}};
    const TempDir dir;
    std::string script = "import runpy, sys\n";  // torch is imported once
    for (const auto& one : cases)
        for (const auto& line :
             {fmt::format("weights {0}-w.h5 {1} --layers 2 --frames 20 --seed 1", one.name, one.sizes),
              fmt::format("input {0}-x.h5 {1} --frames 20 --batch 3 --seed 2", one.name, one.sizes),
              fmt::format("forward {0}-w.h5 {0}-x.h5 {0}-y.h5 --double {1}", one.name, one.options)})
            script += fmt::format(
                "sys.argv = ['actor.py'] + '{}'.split()\nrunpy.run_path('{}', run_name='__main__')\n", line,
                oracle);
    write_file(dir / "run.py", script);
    const auto run = run_command("cd " + dir.path().string() + " && /usr/bin/python3 run.py");
    ASSERT_EQ(run.exit, 0) << run.output;
    for (const auto& one : cases) {
        SCOPED_TRACE(one.name);
        const auto file = [&](const char* what) {
            return hdf5::Reader(dir / fmt::format("{}-{}.h5", one.name, what));
        };
        const auto weights = file("w"), input = file("x"), wanted = file("y");
        const auto read = [](const hdf5::Reader& from, const std::string& name) {
            const auto shape = from.shape(name);
            auto values = from.read<double>(name);
            return at::from_blob(values.data(), std::vector<std::int64_t>(shape.begin(), shape.end()),
                                 at::kDouble)
                .clone();
        };
        ActorNet net(one.settings, 0, at::kDouble);
        {
            const at::NoGradGuard no_gradients;
            for (auto& item : net.named_parameters()) item.value().copy_(read(weights, item.key()));
        }
        // x (B,K,F,T), as the oracle has it
        const auto real = read(input, "x").permute({0, 2, 3, 1}).contiguous();
        const auto labels = read(input, "y").to(at::kLong);
        std::optional<RestJoints> joints;
        if (one.points) {
            const auto all = read(weights, "smpl/J_regressor").matmul(read(weights, "smpl/v_template"));
            std::vector<float> rest;
            const auto& topology = ingest::smpl24();
            for (std::size_t j = 0; j < 24; ++j) {
                const auto parent = topology.parents[j];
                const auto offset = parent < 0 ? all[0] : all[static_cast<std::int64_t>(j)] - all[parent];
                for (int d = 0; d < 3; ++d) rest.push_back(offset[d].item<float>());
            }
            joints.emplace(topology, rest, "test", "");
        }
        for (const bool fused : {true, false}) {
            net.set_fused(fused);
            net.zero_grad();
            const auto latent = net.encode(real, labels);
            const auto drawn = latent.mean + read(input, "eps") * (latent.log_variance / 2).exp();
            const auto made = net.decode(drawn, labels, real.size(2));
            const auto losses = actor_losses(real, made, latent, one.kl_factor, joints ? &*joints : nullptr);
            losses.total.backward();
            // Double on both sides, but for sinusoids and rest joints, which are float32 in both.
            expect_near(latent.mean, read(wanted, "mu"), 1e-7);
            expect_near(latent.log_variance, read(wanted, "logvar"), 1e-7);
            expect_near(made.permute({0, 3, 1, 2}), read(wanted, "output"), 1e-7);
            const auto told = [&](const char* name) {
                return read(wanted, std::string("loss/") + name).item<double>();
            };
            EXPECT_NEAR(losses.rc.item<double>(), told("rc"), 1e-6);
            EXPECT_NEAR(losses.kl.item<double>(), told("kl"), 1e-6 * told("kl"));
            EXPECT_NEAR(losses.total.item<double>(), told("mixed"), 1e-6);
            if (one.points) {
                EXPECT_NEAR(losses.rcxyz.item<double>(), told("rcxyz"), 1e-6);
            }
            for (const auto& item : net.named_parameters()) {
                const auto theirs = read(wanted, "grad_norm/" + item.key()).item<double>();
                const auto& grad = item.value().grad();
                EXPECT_NEAR(grad.defined() ? grad.norm().item<double>() : 0, theirs, 1e-5 * theirs + 1e-12)
                    << item.key();
            }
            // As for generation: other lengths need no other weights, and a motion begins as a shorter one does not.
            const at::NoGradGuard no_gradients;
            expect_near(net.decode(drawn, labels, real.size(2)), made, 1e-10);
        }
    }
}

TEST_F(ActorNetwork, RefusesWhatItCannotTake) {
    const ActorNet net(tiny(), 1);
    EXPECT_THROW(net.decode(at::randn({2, 35}), some_labels(2), 10), Error);
    EXPECT_THROW(net.decode(at::randn({2, 36}), some_labels(3), 10), Error);
    EXPECT_THROW(net.decode(at::randn({2, 36}), some_labels(2), 0), Error);
    EXPECT_THROW(net.decode(at::randn({2, 36}), some_labels(2), most_actor_frames + 1), Error);
    EXPECT_EQ(error_of([] { RestJoints(ingest::smpl24(), {}, "data", "rcxyz=none"); }),
              "data: rotations without a rest skeleton; ingest it anew, or do without joints (rcxyz=none)");
}

TEST_F(ActorNetwork, RefusesConfigurationsThatFitNoMotions) {
    const auto refused = [](const std::vector<std::string>& keys, Representation representation) {
        auto config = generator_config(method_named("actor", "test"));
        for (const auto& key : keys) config.override_with(key);
        try {
            actor_settings(config, {representation, ingest::ntu25(), 1, 94, "ntu"});
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_EQ(refused({"rcxyz=joints"}, Representation::limb),
              "ntu: rcxyz: joints is for rotations, and its motions are limb; take rcxyz: auto");
    EXPECT_EQ(refused({"rcxyz=joints"}, Representation::rot6d), "");
    EXPECT_EQ(refused({"heads=3"}, Representation::limb),
              "actor: heads: 3 do not divide width: 256; as in width: 255");
    EXPECT_EQ(refused({"classes=13"}, Representation::limb),
              "ntu: 94 classes, but the configuration says classes: 13");
    EXPECT_EQ(refused({"persons=2"}, Representation::xyz),
              "ntu: 1 person a clip, but the configuration says persons: 2");
}
