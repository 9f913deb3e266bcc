// `actformer import`: files that PyTorch itself wrote, and what their users get wrong.
#include <ATen/core/grad_mode.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"
#include "model/generators/actor/network.hpp"
#include "model/generators/generator_file.hpp"
#include "model/generators/import_generator.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/recognisers/import_recogniser.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer;
using namespace actformer::test;
using namespace actformer::model;

namespace {

/// Makes every file of the tests in the current folder, in one run of Python. K: nodes of limbs.
constexpr const char* script = R"(
import h5py, sys, torch
from torch import nn
K, D, H, F, C, L = int(sys.argv[1]), 32, 4, 48, 3, 2
torch.manual_seed(1)

class Positions(nn.Module):
    def __init__(self):
        super().__init__()
        self.register_buffer('pe', torch.zeros(100, 1, D))

class Encoder(nn.Module):
    def __init__(self, classes):
        super().__init__()
        self.muQuery, self.sigmaQuery = nn.Parameter(torch.randn(classes, D)), nn.Parameter(torch.randn(classes, D))
        self.skelEmbedding, self.sequence_pos_encoder = nn.Linear(3 * K, D), Positions()
        self.seqTransEncoder = nn.TransformerEncoder(nn.TransformerEncoderLayer(D, H, F, activation='gelu'), L)

class Decoder(nn.Module):
    def __init__(self, classes):
        super().__init__()
        self.actionBiases, self.sequence_pos_encoder = nn.Parameter(torch.randn(classes, D)), Positions()
        self.seqTransDecoder = nn.TransformerDecoder(nn.TransformerDecoderLayer(D, H, F, activation='gelu'), L)
        self.finallayer = nn.Linear(D, 3 * K)
    def forward(self, z, y, T):
        i, j = torch.arange(T)[:, None].float(), torch.arange(0, D, 2).float()
        angle = i * 10000 ** (-j / D)
        pe = torch.stack((angle.sin(), angle.cos()), 2).reshape(T, 1, D)
        h = self.seqTransDecoder(pe.expand(T, len(y), D), (z + self.actionBiases[y])[None])
        return self.finallayer(h).reshape(T, len(y), K, 3).permute(1, 3, 0, 2)

class Cvae(nn.Module):
    def __init__(self, classes=C):
        super().__init__()
        self.encoder, self.decoder = Encoder(classes), Decoder(classes)

net = Cvae().eval()
torch.save(net.state_dict(), 'actor.pt')
optimiser = torch.optim.AdamW(net.parameters(), lr=0)
net.decoder(torch.randn(3, D), torch.tensor([0, 2, 1]), 20).sum().backward()
optimiser.step()
torch.save({'epoch': 5, 'model': net.state_dict(), 'optimiser': optimiser.state_dict()}, 'actor-old.pt',
           _use_new_zipfile_serialization=False)
torch.save(Cvae(4).state_dict(), 'four.pt')
torch.save({**net.state_dict(), 'encoder.skelEmbedding.weight': torch.zeros(D, 6 * K)}, 'wide.pt')
torch.save({**net.state_dict(), 'encoder.mu_layer.weight': torch.zeros(D, D)}, 'variant.pt')
torch.save({k: v.half() if v.is_floating_point() else v for k, v in net.state_dict().items()}, 'half.pt')
class Runs:
    def __reduce__(self): return (print, ('run',))
torch.save({'model': net.state_dict(), 'more': Runs()}, 'runs.pt')
z, y = torch.randn(3, D), torch.tensor([0, 2, 1])
with torch.no_grad(), h5py.File('expected.h5', 'w') as f: f['z'], f['motion'] = z.numpy(), net.decoder(z, y, 20).numpy()

def linear(i, o): return nn.Linear(i, o)
def cell(n): return nn.ModuleList(nn.GRUCell(16, 16) for _ in range(n))
def gaussian():
    m = nn.Module(); m.embed, m.gru, m.mu_net, m.logvar_net = linear(3 * K + C + 1, 16), cell(1), linear(16, 6), linear(16, 6); return m
decoder = nn.Module()
decoder.embed, decoder.gru, decoder.output = linear(3 * K + C + 1 + 6, 16), cell(2), linear(16, 3 * K)
torch.save({'prior_net': gaussian().state_dict(), 'posterior_net': gaussian().state_dict(), 'decoder': decoder.state_dict(), 'iterations': 7}, 'a2m.tar')

gru = nn.Module()
gru.recurrent, gru.linear1, gru.linear2 = nn.GRU(3 * K, 32, 2), linear(32, 30), linear(30, C)
torch.save({'model': gru.state_dict()}, 'gru.tar')
with h5py.File('gru.h5', 'w') as f:
    for k, v in gru.state_dict().items(): f[k] = v.numpy()
torch.save({**gru.state_dict(), 'recurrent.weight_ih_l0': torch.zeros(96, 6 * K)}, 'wide.tar')
gru.linear2 = linear(30, 9)
torch.save({'model': gru.state_dict()}, 'gru9.tar')
with h5py.File('stgcn.h5') as f: state = {k: torch.tensor(f[k][()]) for k in f}
torch.save({**state, 'A': torch.zeros(3, K, K), 'data_bn.num_batches_tracked': torch.tensor(4)}, 'stgcn.pt')
)";

struct Import : testing::Test {
    static void SetUpTestSuite() {
        if (!has_eager_pytorch()) return;
        folder = std::make_unique<TempDir>();
        const auto topology = ingest::Dataset(toy()).header().topology;
        eval::write_stgcn_weights(
            *folder / "stgcn.h5",
            eval::random_stgcn_weights(3, 3, eval::recogniser_graph(topology.parents), 0.125, 5));
        write_file(*folder / "make.py", script);
        const auto made = run_command(
            fmt::format("cd {} && /usr/bin/python3 make.py {}", folder->path().string(), topology.joints()));
        ASSERT_EQ(made.exit, 0) << made.output;
    }
    static void TearDownTestSuite() { folder.reset(); }
    void SetUp() override {
        if (!folder) GTEST_SKIP() << "no Python with torch and h5py (Debian: python3-torch python3-h5py)";
    }

    static std::string at(const std::string& name) { return (*folder / name).string(); }
    static CommandResult run_import(const std::string& what, const std::string& file,
                                    const std::string& more = "") {
        return run_actformer("import " + what + " " + at(file) + " --data " + toy().string() + " -o " +
                             at("out.h5") + " " + more);
    }
    /// The same without the program: what is wrong, or nothing.
    static std::string fault(const std::string& what, const std::string& file,
                             const std::vector<std::string>& overrides = {},
                             const std::filesystem::path& data = toy()) {
        try {
            if (what == "generator")
                import_generator({at(file), data, at("out.h5"), overrides});
            else
                import_recogniser({at(file), data, at("out.h5")});
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }
    static std::unique_ptr<TempDir> folder;
};

void expect_words(const std::string& fault, const std::vector<std::string>& words) {
    EXPECT_EQ(lines_in(fault), 0) << fault;
    for (const auto& word : words) EXPECT_NE(fault.find(word), std::string::npos) << word << ": " << fault;
}

std::unique_ptr<TempDir> Import::folder;

at::Tensor tensor_of(const hdf5::Reader& file, const std::string& name) {
    const auto shape = file.shape(name);
    auto values = file.read<float>(name);
    return at::from_blob(values.data(), std::vector<std::int64_t>(shape.begin(), shape.end()), at::kFloat)
        .clone();
}

}  // namespace

TEST_F(Import, ActorGeneratesAsPyTorchsOwnModulesDo) {
    const hdf5::Reader expected(at("expected.h5"));
    for (const auto& [file, tolerance] :
         {std::pair{"actor.pt", 1e-5}, {"actor-old.pt", 1e-5}, {"half.pt", 2e-2}}) {
        ASSERT_EQ(fault("generator", file), "");
        const auto imported = load_generator(at("out.h5"));
        EXPECT_EQ(imported.method().name, "actor");
        auto settings = ActorSettings{};
        settings.nodes = imported.subjects.topology.joints();
        settings.classes = 3;
        settings.width = 32;
        settings.hidden = 48;
        settings.layers = 2;
        ActorNet net(settings, 0);
        load_arrays(net, "", imported.weights, file);
        const at::NoGradGuard no_gradients;
        const auto motion = net.decode(tensor_of(expected, "z"), at::tensor({0, 2, 1}, at::kLong), 20);
        EXPECT_LE((motion - tensor_of(expected, "motion")).abs().max().item<double>(), tolerance) << file;
        std::filesystem::remove(at("out.h5"));
    }
    ASSERT_EQ(run_import("generator", "actor.pt").exit, 0);
    const auto made = run_actformer("generate --generator " + at("out.h5") + " -o " + at("m.h5") +
                                    " --per-class 2 --frames 70");
    EXPECT_EQ(made.exit, 0) << made.output;
}

TEST_F(Import, Action2MotionGenerates) {
    const auto result = run_import("generator", "a2m.tar");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("action2motion"), std::string::npos) << result.output;
    const auto made =
        run_actformer("generate --generator " + at("out.h5") + " -o " + at("a.h5") + " --per-class 2");
    EXPECT_EQ(made.exit, 0) << made.output;
}

TEST_F(Import, ReplacesWhatItImportedAndNothingElse) {
    for (const auto& [what, file] : {std::pair{"generator", "actor.pt"}, {"recogniser", "gru.tar"}}) {
        const auto import = [&](const std::string& out, const std::string& more = "") {
            return run_actformer(fmt::format("import {} {} --data {} -o {} {}", what, at(file),
                                             toy().string(), at(out), more));
        };
        const auto before = read_file(at(file));
        expect_refused(import(file), {file, "is there", "--force"});
        EXPECT_TRUE(read_file(at(file)) == before) << "its own input is as it was";
        expect_refused(import("stgcn.h5"), {"stgcn.h5", "holds no weights that import wrote", "--force"});
        write_file(at("foreign.h5"), "someone's");
        EXPECT_EQ(import("foreign.h5", "--force").exit, 0);
        EXPECT_EQ(import("foreign.h5").exit, 0) << "imported weights, now";
    }
}

TEST_F(Import, RecognisersKeepTheirNumbers) {
    for (const auto& [file, numbers, kind] :
         {std::tuple{"gru.tar", "gru.h5", "gru"}, {"stgcn.pt", "stgcn.h5", "stgcn"}}) {
        const auto result = run_import("recogniser", file);
        ASSERT_EQ(result.exit, 0) << result.output;
        const hdf5::Reader out(at("out.h5")), in(at(numbers));
        EXPECT_EQ(out.attribute_texts("kind"), std::vector<std::string>{kind});
        EXPECT_EQ(out.attribute_texts("class_names").size(), 3U);
        auto names = in.names();
        std::ranges::sort(names);
        auto made = out.names();
        std::ranges::sort(made);
        EXPECT_EQ(made, names);
        for (const auto& name : names) EXPECT_EQ(out.read<float>(name), in.read<float>(name)) << name;
    }
    EXPECT_EQ(eval::read_stgcn_weights(at("out.h5")).classes, 3U);
    const auto features =
        run_actformer("features --recogniser " + at("out.h5") + " " + toy().string() + " -o " + at("f.h5"));
    EXPECT_EQ(features.exit, 0) << features.output;
}

TEST_F(Import, RefusesWhatDoesNotFit) {
    std::filesystem::remove(at("out.h5"));
    expect_words(fault("generator", "four.pt"), {"four.pt", "weights for 4 classes", "the dataset has 3"});
    expect_words(fault("generator", "variant.pt"), {"variant.pt", "'encoder.mu_layer.weight'", "variants"});
    expect_words(fault("generator", "gru.tar"), {"gru.tar", "holds no released weights of", "actor"});
    expect_words(fault("generator", "actor.pt", {"heads=5"}), {"heads: 5 do not divide width: 32"});
    expect_words(fault("generator", "actor.pt", {"layers=3"}), {"actor.pt", "layers.2"});
    expect_words(fault("generator", "wide.pt"), {"wide.pt", "numbers a frame", "(limb)"});
    expect_words(fault("recogniser", "actor.pt"), {"actor.pt", "neither an ST-GCN nor a GRU classifier"});
    expect_words(fault("recogniser", "gru9.tar"), {"gru9.tar", "weights for 9 classes"});
    expect_words(fault("recogniser", "wide.tar"), {"wide.tar", "'recurrent.weight_ih_l0'", "is expected"});
    EXPECT_FALSE(std::filesystem::exists(at("out.h5")));
}

TEST_F(Import, RunsNothingAndReadsNothingBeyondTheEnd) {
    const auto runs = run_import("generator", "runs.pt");
    expect_refused(runs, {"runs.pt", "data.pkl", "__builtin__ print at byte", "nothing was run"});
    EXPECT_EQ(lines_in(runs.output), 1) << runs.output;
    for (const std::string name : {"actor.pt", "actor-old.pt"}) {
        const auto whole = read_file(at(name));
        write_file(at("cut.pt"), whole.substr(0, whole.size() - 100));
        expect_words(fault("generator", "cut.pt"), {"cut.pt", "cut short"});
    }
}
