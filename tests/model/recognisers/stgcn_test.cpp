// The network: names and counts, forward against plain loops in double and against the oracle, gradients of the two paths.
#include "model/recognisers/stgcn_net.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "model/recognisers/stgcn_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;
namespace hdf5 = hdf5;

namespace {

const std::string oracle = shared("reference/stgcn.py");

bool has_oracle() {
    return std::filesystem::exists(oracle) && has_eager_pytorch();
}

StgcnSettings tiny() {
    return {6, 5, {{-1, 0, 1, 1, 3, 0}, 1}, 0.25, 0};
}

at::Tensor random_input(const StgcnSettings& s, std::int64_t samples, std::int64_t frames) {
    return at::randn({samples, s.channels, frames, s.graph.joints()}, at::kDouble);
}

/// Weights away from their starting points, so that every one of them matters.
void stir(StgcnNet& net) {
    const at::NoGradGuard no_gradients;
    for (const auto& info : net.declared()) {
        auto& weight = net.weight(info.name);
        if (info.name.ends_with("running_var"))
            weight.uniform_(0.5, 1.5);
        else if (info.init == Init::ones)
            weight.normal_(1, 0.1);
        else if (info.init == Init::zeros)
            weight.normal_(0, 0.1);
    }
}

using Volume = std::vector<double>;

/// The network as the oracle spells it, (C, T, K) loops in double for one sample.
struct PlainNet {
    const StgcnNet& net;
    std::int64_t k = net.settings().graph.joints();

    double w(const std::string& name, std::int64_t i) const { return net.weight(name).data_ptr<double>()[i]; }
    double normal(double v, const std::string& name, std::int64_t c) const {
        return (v - w(name + ".running_mean", c)) / std::sqrt(w(name + ".running_var", c) + 1e-5) *
                   w(name + ".weight", c) +
               w(name + ".bias", c);
    }
    Volume convolve(const Volume& x, std::int64_t in, std::int64_t t, const std::string& name,
                    std::int64_t stride) const {
        const auto out = net.weight(name + ".weight").size(0), taps = net.weight(name + ".weight").size(2);
        const auto frames = (t + stride - 1) / stride;
        Volume y(static_cast<std::size_t>(out * frames * k));
        for (std::int64_t o = 0; o < out; ++o)
            for (std::int64_t f = 0; f < frames; ++f)
                for (std::int64_t j = 0; j < k; ++j) {
                    double sum = w(name + ".bias", o);
                    for (std::int64_t i = 0; i < in; ++i)
                        for (std::int64_t tap = 0; tap < taps; ++tap) {
                            const auto from = f * stride + tap - taps / 2;
                            if (from >= 0 && from < t)
                                sum += w(name + ".weight", (o * in + i) * taps + tap) *
                                       x[(i * t + from) * k + j];
                        }
                    y[(o * frames + f) * k + j] = sum;
                }
        return y;
    }
    Volume layer(const Volume& x, std::size_t i, std::int64_t& t) const {
        const auto layer = eval::stgcn_layer(shape_of(net.settings()), i);
        const auto prefix = "st_gcn_networks." + std::to_string(i) + ".";
        const std::int64_t out = layer.out;
        const auto parts = convolve(x, layer.in, t, prefix + "gcn.conv", 1);
        const auto partition = eval::partition(net.settings().graph);
        Volume y(static_cast<std::size_t>(out * t * k), 0);
        for (std::int64_t p = 0; p < 3; ++p)
            for (std::int64_t c = 0; c < out; ++c)
                for (std::int64_t f = 0; f < t; ++f)
                    for (std::int64_t v = 0; v < k; ++v)
                        for (std::int64_t u = 0; u < k; ++u) {
                            const auto edge = (p * k + v) * k + u;
                            const double share = static_cast<float>(partition[p][v * k + u]);
                            y[(c * t + f) * k + u] += parts[((p * out + c) * t + f) * k + v] * share *
                                                      w("edge_importance." + std::to_string(i), edge);
                        }
        for (std::size_t n = 0; n < y.size(); ++n)
            y[n] = std::max(0.0, normal(y[n], prefix + "tcn.0", static_cast<std::int64_t>(n) / (t * k)));
        y = convolve(y, out, t, prefix + "tcn.2", layer.stride);
        Volume shortcut(y.size(), 0);
        const auto frames = (t + layer.stride - 1) / layer.stride;
        if (layer.residual == eval::StgcnLayer::Residual::identity) shortcut = x;
        if (layer.residual == eval::StgcnLayer::Residual::convolution) {
            shortcut = convolve(x, layer.in, t, prefix + "residual.0", layer.stride);
            for (std::size_t n = 0; n < y.size(); ++n)
                shortcut[n] =
                    normal(shortcut[n], prefix + "residual.1", static_cast<std::int64_t>(n) / (frames * k));
        }
        t = frames;
        for (std::size_t n = 0; n < y.size(); ++n)
            y[n] = std::max(
                0.0, normal(y[n], prefix + "tcn.3", static_cast<std::int64_t>(n) / (t * k)) + shortcut[n]);
        return y;
    }
    std::vector<double> logits(const at::Tensor& sample) const {
        const auto c = sample.size(0);
        auto t = sample.size(1);
        const auto input = sample.contiguous();
        Volume x(input.data_ptr<double>(), input.data_ptr<double>() + input.numel());
        for (std::int64_t i = 0; i < c; ++i)
            for (std::int64_t f = 0; f < t; ++f)
                for (std::int64_t j = 0; j < k; ++j)
                    x[(i * t + f) * k + j] = normal(x[(i * t + f) * k + j], "data_bn", j * c + i);
        const std::int64_t features = shape_of(net.settings()).features();
        for (std::size_t i = 0; i < eval::stgcn_layers; ++i) x = layer(x, i, t);
        std::vector<double> out;
        for (std::int64_t o = 0; o < net.settings().classes; ++o) {
            double sum = w("fcn.bias", o);
            for (std::int64_t i = 0; i < features; ++i) {
                double mean = 0;
                for (std::int64_t n = 0; n < t * k; ++n) mean += x[i * t * k + n];
                sum += w("fcn.weight", o * features + i) * mean / static_cast<double>(t * k);
            }
            out.push_back(sum);
        }
        return out;
    }
};

}  // namespace

TEST(Stgcn, CountsThePublicNetworksParameters) {
    std::int64_t trained = 0;
    for (const auto& weight : stgcn_weights({3, 60, eval::ntu_graph(), 1, 0.5}))
        trained += weight.trained ? weight.count() : 0;
    std::int64_t summed = 0;
    for (const auto& line : stgcn_summary({3, 60, eval::ntu_graph(), 1, 0.5}, 300)) summed += line.parameters;
    EXPECT_EQ(summed, trained);
    // By hand: data_bn 150; three parts' 1x1 kernels, 9-frame kernels, two norms a layer, two shortcuts, importances, classes.
    const std::int64_t graph = 3 * (64 * 3 + 64) + 3 * 3 * (64 * 64 + 64) + 3 * (128 * 64 + 128) +
                               2 * 3 * (128 * 128 + 128) + 3 * (256 * 128 + 256) + 2 * 3 * (256 * 256 + 256);
    const std::int64_t temporal =
        4 * (9 * 64 * 64 + 64 * 5) + 3 * (9 * 128 * 128 + 128 * 5) + 3 * (9 * 256 * 256 + 256 * 5);
    const std::int64_t shortcuts = 128 * 64 + 3 * 128 + 256 * 128 + 3 * 256;
    EXPECT_EQ(trained, 150 + graph + temporal + shortcuts + 10 * 3 * 25 * 25 + 60 * 256 + 60);
}

TEST(Stgcn, ForwardIsThePlainLoops) {
    at::manual_seed(1);
    StgcnNet net(tiny(), 5, at::kCPU, at::kDouble);
    stir(net);
    for (const std::int64_t frames : {1, 7, 12}) {
        const auto x = random_input(tiny(), 3, frames);
        std::vector<std::vector<double>> expected;
        for (std::int64_t n = 0; n < 3; ++n) expected.push_back(PlainNet{net}.logits(x[n]));
        for (const bool fused : {true, false}) {
            net.fused = fused;
            const auto logits = net.eval_forward(x).logits;
            for (std::int64_t n = 0; n < 3; ++n)
                for (std::int64_t c = 0; c < 5; ++c)
                    EXPECT_NEAR(logits[n][c].item<double>(),
                                expected[static_cast<std::size_t>(n)][static_cast<std::size_t>(c)], 1e-9)
                        << frames << fused;
        }
    }
}

TEST(Stgcn, BothPathsTrainAlike) {
    StgcnNet fused(tiny(), 5, at::kCPU, at::kDouble), plain(tiny(), 5, at::kCPU, at::kDouble);
    at::manual_seed(2);
    stir(fused);
    at::manual_seed(2);
    stir(plain);
    plain.fused = false;
    const auto x = random_input(tiny(), 4, 9);
    const auto labels = at::arange(4, at::kLong);
    for (auto* net : {&fused, &plain})
        at::cross_entropy_loss(net->train_forward(x, 1).logits, labels).backward();
    for (const auto& info : fused.declared()) {
        const auto &ours = fused.weight(info.name), &torchs = plain.weight(info.name);
        if (info.trained)
            EXPECT_TRUE(at::allclose(ours.grad(), torchs.grad(), 1e-7, 1e-9)) << info.name;
        else
            EXPECT_TRUE(at::allclose(ours, torchs, 1e-9, 1e-11)) << info.name;
    }
}

TEST(Stgcn, DropsOutByTheSeedAlone) {
    auto settings = tiny();
    settings.dropout = 0.5;
    StgcnNet net(settings, 5);
    const auto x = random_input(settings, 4, 9).to(at::kFloat);
    for (const bool fused : {true, false}) {
        net.fused = fused;
        const auto once = net.train_forward(x, 7).logits;
        EXPECT_TRUE(once.equal(net.train_forward(x, 7).logits));
        EXPECT_FALSE(once.equal(net.train_forward(x, 8).logits));
    }
}

TEST(Stgcn, RefusesOtherChannelsAndJoints) {
    StgcnNet net(tiny(), 5);
    EXPECT_THROW(net.eval_forward(at::zeros({1, 3, 9, 6})), Error);
    EXPECT_THROW(net.eval_forward(at::zeros({1, 6, 9, 7})), Error);
    auto arrays = net.arrays();
    arrays[0].shape = {1, 36};
    EXPECT_THROW(net.load(arrays, "w.h5"), Error);
    arrays.erase(arrays.begin());
    EXPECT_THROW(net.load(arrays, "w.h5"), Error);
}

TEST(Stgcn, AgreesWithTheOracleBothWays) {
    if (!has_oracle())
        GTEST_SKIP()
            << "no reference/stgcn.py, or no Python with torch and h5py (Debian: python3-torch python3-h5py)";
    TempDir dir;
    const auto path = [&](const std::string& name) { return (dir / name).string(); };
    const auto python = "/usr/bin/python3 " + oracle + " ";
    ASSERT_EQ(run_command(python + "weights " + path("w.h5") + " --channels 6 --classes 26").exit, 0);
    const StgcnSettings settings{6, 26, eval::ntu_graph(), 1, 0.5};
    StgcnNet net(settings, 0);
    const hdf5::Reader file(dir / "w.h5");
    std::vector<Array> arrays;
    for (const auto& info : net.declared()) {
        const auto shape = file.shape(info.name);
        arrays.push_back({info.name, {shape.begin(), shape.end()}, file.read<float>(info.name)});
    }
    net.load(arrays, "w.h5");
    save_stgcn_weights(dir / "ours.h5", settings, net.arrays(), {{"program", "test"}});

    at::manual_seed(4);
    const auto x = at::randn({3, 2, 3, 64, 25});  // persons apart, as a motions file takes them
    ingest::MotionsWriter clips(dir / "clips.h5");
    for (std::int64_t n = 0; n < 3; ++n) {
        const auto values = x[n].permute({2, 0, 3, 1}).contiguous();  // (T, P, K, 3)
        clips.add("c" + std::to_string(n),
                  {"", 64, 2, 25, 3, {values.data_ptr<float>(), values.data_ptr<float>() + values.numel()}});
    }
    clips.finish();
    for (const std::string weights : {"w.h5", "ours.h5"}) {
        const auto run =
            run_command(python + "features " + path(weights) + " " + path("clips.h5") + " " + path("out.h5"));
        ASSERT_EQ(run.exit, 0) << run.output;
        auto logits = hdf5::Reader(dir / "out.h5").read<float>("logits");
        const auto ours = net.eval_forward(x.view({3, 6, 64, 25})).logits;
        const auto theirs = at::from_blob(logits.data(), {3, 26}, at::kFloat);
        EXPECT_LT((ours - theirs).abs().max().item<float>(), 2e-4F * theirs.abs().max().item<float>())
            << weights;
    }
}
