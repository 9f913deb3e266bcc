// The GRU recogniser against an independent computation in PyTorch, against a plain one here, and what it does with bad files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numeric>
#include <random>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "eval/gru/weights.hpp"
#include "eval/recogniser.hpp"
#include "eval/scoring/feature_extractor.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::eval;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

using Tensors = std::map<std::string, std::vector<float>>;

/// A chain of joints.
std::vector<std::int64_t> chain(std::int64_t joints) {
    std::vector<std::int64_t> parents(static_cast<std::size_t>(joints));
    std::iota(parents.begin(), parents.end(), -1);
    return parents;
}

Tensors random_tensors(const GruNetwork& network) {
    std::mt19937 random(3);
    Tensors tensors;
    for (const auto& tensor : gru_tensors(network)) {
        std::uniform_real_distribution<float> reach(-1, 1);
        auto& values = tensors[tensor.name];
        values.resize(tensor.count());
        for (auto& value : values) value = 2 * reach(random) / std::sqrt(static_cast<float>(tensor.fan_in));
    }
    return tensors;
}

struct FileOptions {
    std::string representation = "xyz";
    std::int64_t channels = 3, joints = 18;
    std::string without;  ///< a tensor left out
    std::string bad;      ///< a tensor that holds no number
    std::string extra;    ///< one that belongs to nothing
};

void write_gru(const fs::path& path, const GruNetwork& network, Tensors tensors, const FileOptions& options) {
    hdf5::Writer file(path);
    for (const auto& tensor : gru_tensors(network)) {
        auto& values = tensors.at(tensor.name);
        if (tensor.name == options.without) continue;
        if (tensor.name == options.bad) values[1] = std::nanf("");
        file.write<float>(tensor.name, {tensor.shape.begin(), tensor.shape.end()}, values);
    }
    if (!options.extra.empty()) file.write<float>(options.extra, {1}, std::vector<float>{0});
    file.attribute("kind", std::string("gru"));
    file.attribute("representation", options.representation);
    file.attribute("channels", options.channels);
    file.attribute("classes", std::int64_t{network.classes});
    file.attribute("parents", chain(options.joints));
    file.finish();
}

double sigmoid(double x) {
    return 1 / (1 + std::exp(-x));
}

/// Features of poses (frames, inputs), in double, step by step.
std::vector<double> plain_features(const GruNetwork& network, const Tensors& tensors,
                                   std::vector<std::vector<double>> poses) {
    const auto times = [](const std::vector<float>& w, const std::vector<float>& b,
                          const std::vector<double>& x) {
        std::vector<double> out(b.begin(), b.end());
        for (std::size_t r = 0; r < out.size(); ++r)
            for (std::size_t c = 0; c < x.size(); ++c) out[r] += double{w[r * x.size() + c]} * x[c];
        return out;
    };
    for (std::size_t l = 0; l < gru_layers; ++l) {
        const auto of = [&](const char* name) {
            return tensors.at(fmt::format("recurrent.{}_l{}", name, l));
        };
        const std::size_t hidden = network.hidden;
        std::vector<double> state(hidden, 0.0);
        for (auto& pose : poses) {
            const auto in = times(of("weight_ih"), of("bias_ih"), pose),
                       own = times(of("weight_hh"), of("bias_hh"), state);
            for (std::size_t i = 0; i < hidden; ++i) {
                const double r = sigmoid(in[i] + own[i]), z = sigmoid(in[hidden + i] + own[hidden + i]),
                             n = std::tanh(in[2 * hidden + i] + r * own[2 * hidden + i]);
                state[i] = (1 - z) * n + z * state[i];
            }
            pose = state;
        }
    }
    auto features = times(tensors.at("linear1.weight"), tensors.at("linear1.bias"), poses.back());
    for (auto& f : features) f = std::tanh(f);
    return features;
}

struct GruTest : testing::Test {
    kernels::Device device{""};
    TempDir dir;
};

std::uint64_t count(const GruNetwork& network) {
    std::uint64_t sum = 0;
    for (const auto& tensor : gru_tensors(network)) sum += tensor.count();
    return sum;
}

}  // namespace

TEST_F(GruTest, CountsThePublishedParameters) {
    EXPECT_EQ(count({54, 128, 30, 13}), 174'001U);
    EXPECT_EQ(count({72, 128, 30, 12}), 180'882U);
}

TEST_F(GruTest, AgreesWithAPlainPassInEveryRepresentation) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (const auto how : ingest::Representation::all())
        for (const std::uint32_t persons : {1U, 2U}) {
            const std::uint32_t nodes = 5, channels = how.numbers() * persons, frames = 7, sequences = 3;
            const GruNetwork network{nodes * channels, 32, 6, 4};
            const auto tensors = random_tensors(network);
            const auto path = dir / (how.name() + std::to_string(persons) + ".h5");
            write_gru(path, network, tensors, {how.name(), channels, nodes, {}, {}, {}});
            std::vector<float> motions(std::size_t{sequences} * channels * frames * nodes);
            for (auto& value : motions) value = normal(random);
            const auto recogniser = open_recogniser(device, path, 2);  // two turns
            EXPECT_EQ(recogniser->info().features, 6U);
            const auto seen = recogniser->recognise(motions, sequences, frames);
            ASSERT_EQ(seen.logits.size(), 4U * sequences);
            const auto moving = how.moving(nodes);
            for (std::uint32_t s = 0; s < sequences; ++s) {
                const auto at = [&](std::uint32_t c, std::uint32_t t, std::uint32_t k) {
                    return double{motions[((s * channels + c) * frames + t) * nodes + k]};
                };
                std::vector<std::vector<double>> poses;
                for (std::uint32_t t = 0; t < frames; ++t) {
                    std::vector<double> pose;
                    for (std::uint32_t k = 0; k < nodes; ++k)
                        for (std::uint32_t c = 0; c < channels; ++c) {
                            const auto axis = c % how.numbers();
                            const bool moves =
                                axis < 3 && k >= moving.first && k < moving.first + moving.count;
                            double root = 0;
                            for (std::uint32_t p = 0; p < persons; ++p)
                                root += at(p * how.numbers() + axis, 0, moving.root) / persons;
                            pose.push_back(at(c, t, k) - (moves ? root : 0));
                        }
                    poses.push_back(pose);
                }
                const auto plain = plain_features(network, tensors, poses);
                for (std::size_t i = 0; i < 6; ++i)
                    EXPECT_NEAR(seen.features[s * 6 + i], plain[i], 1e-5) << how.name() << persons;
            }
        }
}

TEST_F(GruTest, NoiseIsASeedsAndZeroWithout) {
    const GruNetwork network{54, 128, 30, 13};
    write_gru(dir / "gru.h5", network, random_tensors(network), {});
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::vector<float> motions(2UL * 3 * 5 * 18);
    for (auto& value : motions) value = normal(random);
    const auto features = [&](std::optional<std::uint64_t> noise) {
        return open_recogniser(device, dir / "gru.h5", 64, noise)->recognise(motions, 2, 5).features;
    };
    EXPECT_EQ(features({}), features({}));
    EXPECT_EQ(features(1), features(1));
    EXPECT_NE(features(1), features({}));
    EXPECT_NE(features(1), features(2));
    const FeatureExtractor plain(device, dir / "gru.h5"),
        noisy(device, dir / "gru.h5", 64, FeatureExtractor::Persons::together, 1);
    EXPECT_NE(plain.checksum(), noisy.checksum()) << "features kept on disk are told apart by it";
    // Noise of many: the deviation 1 of normal numbers.
    const auto recogniser = open_recogniser(device, dir / "gru.h5", 64, 1);
    const auto first = recogniser->recognise(motions, 2, 5).features,
               again = recogniser->recognise(motions, 2, 5).features;
    EXPECT_NE(first, again) << "drawn at every call";
    const auto of_set = [&](const char* name) {
        recogniser->begin_set(name);
        return recogniser->recognise(motions, 2, 5).features;
    };
    const auto real = of_set("real"), generated = of_set("generated");
    EXPECT_NE(real, generated);
    EXPECT_EQ(of_set("generated"), generated)
        << "whatever was seen before, as where features of real motions are kept";
    EXPECT_EQ(of_set("real"), real);
    // In parts, as where memory is small.
    recogniser->begin_set("real");
    auto parts = recogniser->recognise(std::span(motions).first(motions.size() / 2), 1, 5).features;
    const auto rest = recogniser->recognise(std::span(motions).subspan(motions.size() / 2), 1, 5).features;
    parts.insert(parts.end(), rest.begin(), rest.end());
    EXPECT_EQ(parts, real);
}

TEST_F(GruTest, RefusesBadFiles) {
    const GruNetwork network{54, 128, 30, 13};
    const auto tensors = random_tensors(network);
    const auto refused = [&](const FileOptions& options, const std::string& word) {
        write_gru(dir / "bad.h5", network, tensors, options);
        try {
            open_recogniser(device, dir / "bad.h5");
            ADD_FAILURE() << "taken: " << word;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
            EXPECT_NE(std::string(e.what()).find("bad.h5"), std::string::npos) << e.what();
        }
    };
    refused({"xyz", 3, 18, "linear1.bias", {}, {}}, "linear1.bias");
    refused({"xyz", 3, 18, "recurrent.weight_hh_l0", {}, {}}, "recurrent.weight_hh_l0");
    refused({"xyz", 3, 18, {}, "recurrent.bias_ih_l1", {}}, "recurrent.bias_ih_l1");
    refused({"xyz", 3, 18, {}, {}, "fcn.weight"}, "fcn.weight");
    refused({"xyz", 3, 24, {}, {}, {}}, "recurrent.weight_ih_l0");
    refused({"xyz", 4, 18, {}, {}, {}}, "channels");
    refused({"euler", 3, 18, {}, {}, {}}, "euler");
    write_gru(dir / "bad.h5", {54, 16, 1, 4097}, random_tensors({54, 16, 1, 4097}), {});
    try {
        read_gru_weights(dir / "bad.h5");
        ADD_FAILURE() << "taken";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("bad.h5: 4097 classes"), std::string::npos) << e.what();
    }
}

TEST_F(GruTest, AgreesWithPyTorch) {
    const auto oracle = shared("reference/action2motion.py");
    if (!fs::exists(oracle)) GTEST_SKIP() << oracle << " is not at hand";
    if (!python_has("h5py, torch"))
        GTEST_SKIP() << "no Python with torch and h5py (Debian: python3-torch python3-h5py)";
    // Its classifier on motions whose root begins at the origin.
    write_file(dir / "case.py", fmt::format(R"(import argparse, h5py, runpy, torch
reference = runpy.run_path('{}')
c = argparse.Namespace(dim=54, classes=13)
weights = reference['draw'](reference['classifier_spec'](c), 1)
x = torch.randn(4, 20, 18, 3) + torch.arange(3)
seen = (x - x[:, :1, :1]).view(4, 20, 54)
features, logits = reference['classify'](weights, seen, torch.zeros(2, 4, 128), torch.full((4,), 20))
with h5py.File('{}', 'w') as f:
    for k, v in weights.items(): f[k] = v.numpy()
    f['in/x'], f['out/features'], f['out/logits'] = x.permute(0, 3, 1, 2).contiguous().numpy(), features.numpy(), logits.numpy()
)",
                                            oracle, (dir / "case.h5").string()));
    const auto made = run_command("OMP_WAIT_POLICY=passive /usr/bin/python3 " + (dir / "case.py").string());
    ASSERT_EQ(made.exit, 0) << made.output;
    const hdf5::Reader file(dir / "case.h5");
    const GruNetwork network{54, 128, 30, 13};
    Tensors tensors;
    for (const auto& tensor : gru_tensors(network)) tensors[tensor.name] = file.read<float>(tensor.name);
    write_gru(dir / "gru.h5", network, tensors, {});
    const auto seen = open_recogniser(device, dir / "gru.h5")->recognise(file.read<float>("in/x"), 4, 20);
    const auto features = file.read<float>("out/features"), logits = file.read<float>("out/logits");
    ASSERT_EQ(seen.features.size(), features.size());
    for (std::size_t i = 0; i < features.size(); ++i) EXPECT_NEAR(seen.features[i], features[i], 1e-5);
    for (std::size_t i = 0; i < logits.size(); ++i) EXPECT_NEAR(seen.logits[i], logits[i], 1e-5);
}
