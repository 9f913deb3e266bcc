// A byte flipped in what the program wrote: the command that reads it tells, makes it anew, or makes the same of it.
// ACTFORMER_FLIPS=200 flips that many bytes of each kind in place of a few.
#include <gtest/gtest.h>
#include <stdlib.h>

#include "eval/recogniser.hpp"
#include "eval/stgcn/tuning.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "kernels/device.hpp"
#include "tests/support/flips.hpp"
#include "tests/support/made_dataset.hpp"
#include "tests/support/sweep.hpp"

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
          const std::string& output, const std::vector<std::string>& named, bool may_be_unread = false) {
    const auto& all = made();
    flip_and_read(
        what, all.dir / file, flips_to_make(few), named,
        [&] { return outcome_of(all.cache(), arguments, all.dir / output); }, may_be_unread);
}

/// Scores the motions beside the dataset.
std::string score_into(const std::string& file) {
    return "score --recogniser " + made().at("w.h5") + " --real " + made().at("data") +
           " --window 20 --generated " + made().at("m.h5") + " -o " + made().at(file);
}

/// A sweep that scores the motions, and its report.
struct ScoredSweep {
    std::string out = made().at("scored");
    ScoredSweep() {
        write_file(out + ".yaml", fmt::format("name: flips\n"
                                              "datasets:\n"
                                              "  one: {{path: {}}}\n"
                                              "recognisers:\n"
                                              "  one: {{weights: {}}}\n"
                                              "base: {{data: one, recogniser: one, motions: [{}], split: "
                                              "s/train, window: 20}}\n"
                                              "rows:\n"
                                              "  a: {{fills: [table3/full/NTU-1P]}}\n",
                                              made().at("data"), made().at("w.h5"), made().at("m.h5")));
        const auto swept = made().run("sweep " + out + ".yaml -o " + out);
        EXPECT_EQ(swept.exit, 0) << swept.output;
    }
    fs::path scores() const {
        for (const auto& entry : fs::recursive_directory_iterator(out))
            if (entry.path().filename() == "scores.json") return entry.path();
        return {};
    }
};

const ScoredSweep& scored() {
    static const ScoredSweep once;
    return once;
}

void flip_and_report(const std::string& what, const fs::path& file, bool may_be_unread = false) {
    const auto page = made().dir / "report.html";
    flip_and_read(
        what, file, flips_to_make(few), {file.filename().string()},
        [&] {
            return outcome_of(made().cache(), "report " + scored().out + " -o " + page.string(), page,
                              file.filename().string());
        },
        may_be_unread);
}

/// Sweeps whose program is a stand-in that takes no time.
struct SweepFlips : SweepFixture {
    fs::path job_with(const std::string& file) const {
        for (const auto& entry : fs::recursive_directory_iterator(dir / "out/jobs"))
            if (entry.path().filename() == file) return entry.path().parent_path();
        return {};
    }
};

}  // namespace

TEST(Flips, InADatasetsDescription) {
    flip("dataset.json", "data/dataset.json", "export " + made().at("data") + " -o " + made().at("x.h5"),
         "x.h5", {"dataset.json"});
}

TEST(Flips, InAShard) {
    flip("shard", "data/shard-00000.h5", "export " + made().at("data") + " -o " + made().at("x.h5"), "x.h5",
         {"shard-00000.h5"});
}

TEST(Flips, InAShardWhoseFeaturesAreKept) {
    const auto score = score_into("s.json");
    ASSERT_EQ(made().run(score).exit, 0);
    flip("scored shard", "data/shard-00000.h5", score, "s.json", {"shard-00000.h5"}, true);
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
    const auto score = score_into("s.json");
    ASSERT_EQ(made().run(score).exit, 0);
    fs::path cached;
    for (const auto& entry : fs::directory_iterator(made().dir / "cache/actformer/features"))
        if (entry.path().extension() == ".h5") cached = entry.path();
    ASSERT_FALSE(cached.empty());
    flip("cached features", fs::relative(cached, made().dir.path()).string(), score, "s.json",
         {cached.string()}, true);
    auto bytes = read_file(cached);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_file(cached, bytes);
    EXPECT_NE(
        made().run(score).output.find(cached.string() + ": damaged, or of an earlier version; made anew"),
        std::string::npos);
}

TEST(Flips, InWhatAnInterruptedScoreLeft) {
    const auto& all = made();
    const auto to = all.at("k.json"), work = to + ".work", kept = all.at("kept");
    const auto score = score_into("k.json");
    const auto score_with = [&](const std::string& how) {
        return run_command(all.cache() + " LD_PRELOAD=" + failing_calls() + " FAIL_BELOW=" + to +
                           ".partial " + how + " " + program() + " " + score);
    };
    ASSERT_EQ(score_with("FAIL_LIST=" + all.at("list")).exit, 0);
    std::istringstream calls(read_file(all.dir / "list"));
    std::size_t last_open = 0, number = 0;
    for (std::string call; std::getline(calls, call);)
        if (++number, call.starts_with("open")) last_open = number;
    const auto interrupted = score_with(fmt::format("FAIL_AT={} FAIL_ON=1", last_open));
    ASSERT_EQ(interrupted.exit, 1) << interrupted.output;
    fs::rename(work, kept);
    std::size_t measures = 0, features = 0;
    for (const auto& entry : fs::directory_iterator(kept)) {
        const auto file = entry.path();
        const bool measured = file.extension() == ".measures";
        ++(measured ? measures : features);
        flip_and_read(measured ? "kept measures" : "kept features", file, flips_to_make(few),
                      {file.filename()}, [&] {
                          fs::remove_all(work);
                          fs::copy(kept, work);
                          return outcome_of(all.cache(), score, to);
                      });
    }
    EXPECT_GE(measures, 1U);
    EXPECT_EQ(features, 1U);
}

TEST(Flips, InScoresThatAreReported) {
    flip_and_report("scores", scored().scores());
}

TEST(Flips, InFeaturesThatAreReported) {
    flip_and_report("reported features", scored().scores().parent_path() / "features/real.h5", true);
}

TEST(Flips, InASweepsResults) {
    flip_and_report("results.json", scored().out + "/results.json");
}

TEST(Flips, InTiles) {
    const auto cache = made().at("tuned");
    ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    const kernels::Device device("");
    auto tiles = default_tiles(device.info());
    tiles.rows = tiles.rows == 4 ? 5 : 4;
    eval::save_tiles(device.info(), tiles);
    const auto file = eval::tiles_file();
    ::unsetenv("XDG_CACHE_HOME");
    flip_and_read("tiles.json", file, flips_to_make(few), {"tiles.json"}, [&] {
        return outcome_of("XDG_CACHE_HOME=" + cache,
                          "features --recogniser " + made().at("w.h5") + " " + made().at("m.h5") + " -o " +
                              made().at("g.h5"),
                          made().dir / "g.h5");
    });
}

TEST(Flips, InWhatIsToldOfRawData) {
    const auto raw = made().at("raw"), out = made().at("ingested"), again = made().at("again");
    const auto synth = "synth ntu -o " + raw + " --clips 3 --actions 1,2 --seed 1",
               ingest = "ingest ntu " + raw + " -o ";
    ASSERT_EQ(made().run(synth).exit, 0);
    ASSERT_EQ(made().run(ingest + out).exit, 0);
    flip_and_read("ingest.json", out + "/ingest.json", flips_to_make(few), {"ingest.json"},
                  [&] { return outcome_of(made().run(ingest + out)); });
    flip_and_read("synth.json", raw + "/synth.json", flips_to_make(few), {"synth.json"},
                  [&] { return outcome_of(made().run(synth), raw + "/ORIGIN"); });
    flip_and_read("ORIGIN", raw + "/ORIGIN", flips_to_make(few), {"ORIGIN"}, [&] {
        fs::remove_all(again);
        return outcome_of(made().run(ingest + again), again + "/ntu-1p/dataset.json");
    });
}

TEST_F(SweepFlips, InTheMarkOfAJobThatIsDone) {
    sweep_file(two_rows);
    ASSERT_EQ(sweep().exit, 0);
    const auto job = job_with("scores.json");
    for (const auto* name : {"done.json", "scores.json"})
        flip_and_read(std::string("a job's ") + name, job / name, flips_to_make(few), {name}, [&] {
            const auto result = sweep();
            auto outcome = outcome_of(result, job / "scores.json");
            outcome.output += read_file(dir / "out/results.json");
            outcome.anew = result.output.find("again:  ") != std::string::npos;
            return outcome;
        });
}

TEST_F(SweepFlips, InTheMarkOfAJobThatFailed) {
    sweep_file(two_rows);
    write_file(dir / "broken", "train generator");
    ASSERT_EQ(sweep().exit, 1);
    flip_and_read("failed.json", job_with("failed.json") / "failed.json", flips_to_make(few), {"failed.json"},
                  [&] { return outcome_of(sweep("--status"), {}, "failed.json: damaged"); });
}

TEST_F(SweepFlips, InTheNumbersOfJobsInSlurm) {
    sweep_file(two_rows);
    slurm_stand_in("", "seq 1 8 | sed 's/$/|PD|None|(null)/'");
    ASSERT_EQ(with_slurm("--slurm").output.find("8 jobs submitted"), 0U);
    flip_and_read("slurm.json", dir / "out/slurm.json", flips_to_make(few), {"slurm.json"}, [&] {
        auto outcome = outcome_of(with_slurm("--status"));
        const auto submitted = with_slurm("--slurm");
        if (outcome.error.empty() || submitted.exit == 0)
            outcome = {{}, false, outcome.output + submitted.output};
        return outcome;
    });
    const auto text = read_file(dir / "out/slurm.json");
    EXPECT_NE(text.find("\"program\": \"actformer "), std::string::npos) << text;
    write_file(dir / "out/slurm.json", text.substr(0, text.find(",\n  \"checksum\"")) + "\n}\n");
    expect_refused(with_slurm("--slurm"), {"slurm.json: damaged", "remove it once none"});
    EXPECT_EQ(lines_in(read_file(dir / "bin/calls")), 8) << "nothing is submitted twice";
    write_file(dir / "out/slurm.json", "{\"of an earlier version\": \"1\"}");
    EXPECT_EQ(with_slurm("--status").exit, 0);
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
