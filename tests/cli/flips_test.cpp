// A byte flipped in what the program wrote: the command that reads it tells, makes it anew, or makes the same of it.
// ACTFORMER_FLIPS=200 flips that many bytes of each kind in place of a few.
#include <gtest/gtest.h>

#include "eval/recogniser.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/flips.hpp"
#include "tests/support/made_dataset.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t few = 3;

/// A dataset, motions, a recogniser's weights and features, made once.
struct Artefacts {
    TempDir dir;
    Artefacts() {
        fs::copy(arms_in(ingest::Representation::limb), dir / "data");
        eval::Graph graph{ArmsClip::topology().parents, 0};
        write_stgcn_weights(dir / "w.h5", eval::random_stgcn_weights(3, 3, graph, 0.0625, 5));
        ingest::MotionsWriter writer(dir / "m.h5");
        for (std::uint32_t label = 0; label < 3; ++label)
            for (std::uint32_t i = 0; i < 4; ++i)
                writer.add(fmt::format("A{:03}_{}", label + 1, i),
                           ArmsClip(label, i, 30).in(ingest::Representation::limb), {label, {}});
        writer.finish();
        EXPECT_EQ(run("features --recogniser " + at("w.h5") + " " + at("m.h5") + " -o " + at("f.h5")).exit,
                  0);
    }
    std::string at(const std::string& name) const { return (dir / name).string(); }
    std::string cache() const { return "XDG_CACHE_HOME=" + at("cache"); }
    CommandResult run(const std::string& arguments) const {
        return run_command(cache() + " " + program() + " " + arguments);
    }
};

const Artefacts& made() {
    static const Artefacts all;
    return all;
}

void flip(const std::string& what, const std::string& file, const std::string& arguments,
          const std::string& output, const std::vector<std::string>& named) {
    const auto& all = made();
    flip_and_read(what, all.dir / file, flips_to_make(few), named,
                  [&] { return outcome_of(all.cache(), arguments, all.dir / output); });
}

}  // namespace

TEST(Flips, InADatasetsDescription) {
    flip("dataset.json", "data/dataset.json", "export " + made().at("data") + " -o " + made().at("x.h5"),
         "x.h5", {"dataset.json"});
}

TEST(Flips, InAShard) {
    flip("shard", "data/shard-00000.h5", "export " + made().at("data") + " -o " + made().at("x.h5"), "x.h5",
         {"shard-00000.h5"});
}

TEST(Flips, InMotions) {
    flip("motions", "m.h5",
         "features --recogniser " + made().at("w.h5") + " " + made().at("m.h5") + " -o " + made().at("g.h5"),
         "g.h5", {"m.h5"});
}

TEST(Flips, InARecognisersWeights) {
    flip("recogniser's weights", "w.h5",
         "features --recogniser " + made().at("w.h5") + " " + made().at("m.h5") + " -o " + made().at("g.h5"),
         "g.h5", {"w.h5"});
}

TEST(Flips, InFeatures) {
    const auto f = made().at("f.h5");
    flip("features", "f.h5",
         "score --real-features " + f + " --generated-features " + f + " -o " + made().at("s.json"), "s.json",
         {"f.h5"});
}

TEST(Flips, InCachedFeatures) {
    const auto score = "score --recogniser " + made().at("w.h5") + " --real " + made().at("data") +
                       " --window 20 --generated " + made().at("m.h5") + " -o " + made().at("s.json");
    ASSERT_EQ(made().run(score).exit, 0);
    fs::path cached;
    for (const auto& entry : fs::directory_iterator(made().dir / "cache/actformer/features"))
        if (entry.path().extension() == ".h5") cached = entry.path();
    ASSERT_FALSE(cached.empty());
    flip("cached features", fs::relative(cached, made().dir.path()).string(), score, "s.json",
         {cached.string()});
    auto bytes = read_file(cached);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_file(cached, bytes);
    EXPECT_NE(
        made().run(score).output.find(cached.string() + ": damaged, or of an earlier version; made anew"),
        std::string::npos);
}

TEST(Flips, AreFoundInALabelByEveryCommandThatReadsTheShard) {
    const auto& all = made();
    const auto shard = all.dir / "data/shard-00000.h5";
    const auto whole = read_file(shard);
    const std::uint32_t labels[] = {0, 0, 1, 1};  // as they stand between two classes
    auto bytes = whole;
    const auto at = bytes.find(std::string_view(reinterpret_cast<const char*>(labels), sizeof labels));
    ASSERT_NE(at, std::string::npos);
    bytes[at] = 2;
    write_file(shard, bytes);
    const auto data = all.at("data"), w = all.at("w.h5");
    for (const auto& arguments :
         {"export " + data + " -o " + all.at("x.h5"),
          "features --recogniser " + w + " " + data + " -o " + all.at("g.h5"),
          "classify --recogniser " + w + " " + data, "inspect " + data,
          "score --recogniser " + w + " --real " + data + " --generated " + all.at("m.h5")}) {
        const auto result = all.run(arguments);
        expect_refused(result, {"shard-00000.h5", "labels", "ingest the raw data again"});
    }
    write_file(shard, whole);
}
