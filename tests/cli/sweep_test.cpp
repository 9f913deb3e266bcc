// `actformer sweep` as its users meet it, with a stand-in that trains and scores at once.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <set>
#include <sstream>
#include <thread>

#include "tests/support/paths.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/sweep.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/tree.hpp"

using namespace actformer::test;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

struct Sweep : SweepFixture {
    void expect_refused(const std::vector<std::string>& words) const {
        const auto result = sweep("--dry-run");
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto& word : words)
            EXPECT_NE(result.output.find(word), std::string::npos) << word << ": " << result.output;
        EXPECT_FALSE(fs::exists(at("out")));
    }
};

}  // namespace

TEST_F(Sweep, DoesSharedWorkOnce) {
    sweep_file(two_rows);
    const auto result = sweep();
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("begins: [1/8] dataset one ("), std::string::npos) << result.output;
    const auto last = result.output.find("begins: [8/8] ");
    ASSERT_NE(last, std::string::npos) << result.output;
    EXPECT_LT(result.output.find(" left\n", last), result.output.find("done:", last))
        << "other jobs of its kind tell how long it takes: " << result.output;
    EXPECT_EQ(calls_of("synth"), 1);
    EXPECT_EQ(calls_of("ingest ntu"), 1);
    EXPECT_EQ(calls_of("train recogniser"), 1);
    EXPECT_EQ(calls_of("train generator"), 2);
    EXPECT_EQ(calls_of("generate --generator"), 2);
    EXPECT_EQ(calls_of("score"), 2);
    EXPECT_EQ(calls_of("epochs=5 prior=gaussian seed=0"), 1)
        << "settings are laid over the base's key by key";
    const auto json = results();
    ASSERT_EQ(json["rows"].size(), 2U);
    EXPECT_EQ(json["rows"][1]["status"], "done");
    EXPECT_EQ(json["rows"][1]["fills"], Json::array({"table3/Gaussian prior/NTU-1P"}))
        << "not those of what it is like";
    for (const auto& row : json["rows"])
        for (const auto* key : {"scores", "motions", "run", "recogniser", "dataset"})
            EXPECT_TRUE(fs::exists(dir / "out" / row["runs"][0][key].get<std::string>())) << key;
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls().size(), 9U) << "all is done";

    write_file(dir / "g.yaml", "model: generator\nwidth: 64\n");
    ASSERT_EQ(sweep("--jobs 3").exit, 0);
    EXPECT_EQ(calls().size(), 15U) << "another configuration makes other generators, and nothing else";
}

TEST_F(Sweep, JobsAtOnceShareTheThreads) {
    sweep_file("  full: {}\n");
    const auto threads_with = [&](const std::string& environment, const std::string& jobs) {
        fs::remove_all(at("out"));
        fs::remove(at("threads"));
        const auto result = run_command("env " + environment + " " + command("--jobs " + jobs));
        EXPECT_EQ(result.exit, 0) << result.output;
        const auto threads = lines_of("threads");
        return std::set<std::string>(threads.begin(), threads.end());
    };
    const auto half = std::to_string(std::max(1U, std::thread::hardware_concurrency() / 2));
    EXPECT_EQ(threads_with("-u OMP_NUM_THREADS", "1"), std::set<std::string>{"all"});
    EXPECT_EQ(threads_with("-u OMP_NUM_THREADS", "2"), std::set<std::string>{half});
    EXPECT_EQ(threads_with("OMP_NUM_THREADS=3", "2"), std::set<std::string>{"3"}) << "as the user says";
}

TEST_F(Sweep, TrainsEverySeed) {
    sweep_file("  full: {seeds: [1, 2, 7], fills: [table3/full/NTU-1P]}\n");
    ASSERT_EQ(sweep("--jobs 2").exit, 0);
    EXPECT_EQ(calls_of("seed=7"), 1);
    EXPECT_EQ(calls_of("score"), 3);
    EXPECT_EQ(results()["rows"][0]["runs"].size(), 3U);
}

TEST_F(Sweep, RowsLeaveWhatTheyAreLikeAlone) {
    sweep_file(
        "  full: {fills: [table3/full/NTU-1P]}\n"
        "  gaussian: {like: full, set: {prior: gaussian}}\n"
        "  pairs: {data: two, config: other.yaml, set: {pe: fixed}}\n"
        "  last: {like: full, set: {pe: tiled}}\n");
    write_file(dir / "other.yaml", "model: generator\nwidth: 32\n");
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls_of("epochs=5 pe=tiled seed=0"), 1);
    EXPECT_EQ(calls_of("epochs=5 pe=fixed seed=0"), 1);
    EXPECT_EQ(calls_of("epochs=5 prior=gaussian seed=0"), 1);
    EXPECT_EQ(calls_of("other.yaml"), 1);
    EXPECT_EQ(results()["rows"][3]["dataset"], "one");
}

TEST_F(Sweep, AKeyWithoutAValueIsNotSaid) {
    sweep_file(
        "  full: {split: ~, repeats: ~, device: ~, fills: ~, set: {device: ~, epochs: ~}}\n"
        "  bare: {like: ~, set: ~}\n");
    write_file(dir / "sweep.yaml",
               replaced(read_file(dir / "sweep.yaml"), "seeds: [0]", "seeds: [0], device: cpu, split: here"));
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls_of("null"), 0);
    EXPECT_EQ(calls_of("device="), 0);
    EXPECT_EQ(calls_of("epochs="), 1) << "the recogniser's";
    EXPECT_EQ(calls_of("--repeats 20 "), 1) << "not the base's 3";
    EXPECT_EQ(calls_of("--split all "), 1);
    EXPECT_EQ(calls_of("--split here "), 1) << "of the other row";
    EXPECT_EQ(calls_of("--device cpu"), 1) << "of the other row";
}

TEST_F(Sweep, GeneratesWhereItTrains) {
    sweep_file("  full: {set: {device: cuda}, fills: [table3/full/NTU-1P]}\n");
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls_of("train generator") * calls_of("device=cuda"), 1);
    EXPECT_EQ(calls_of("--device cuda"), 1) << "generate";
    EXPECT_EQ(calls_of("--generate-on cuda"), 1) << "score";
}

TEST_F(Sweep, ARowThatFailsStopsNoOther) {
    sweep_file(two_rows);
    write_file(dir / "broken", "prior=gaussian");
    const auto result = sweep();
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("failed: gaussian: gaussian, seed 0: generator: actformer: out of luck"),
              std::string::npos)
        << result.output;
    EXPECT_EQ(calls_of("score"), 1) << "the other row is scored";
    EXPECT_EQ(results()["rows"][0]["status"], "done");
    EXPECT_EQ(results()["rows"][1]["status"], "failed");
    EXPECT_NE(results()["rows"][1]["why"].get<std::string>().find("out of luck"), std::string::npos);
    const auto before = calls().size();
    fs::remove(dir / "broken");
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls().size(), before + 3) << "generator, motions and scores of that row alone";
    EXPECT_EQ(results()["rows"][1]["status"], "done");
}

TEST_F(Sweep, TellsNoTimeOfJobsThatFailed) {
    sweep_file(two_rows);
    write_file(dir / "broken", "prior=gaussian");
    ASSERT_EQ(sweep().exit, 1);
    const auto status = sweep("--status --json");
    ASSERT_EQ(status.exit, 0) << status.output;
    const auto json = Json::parse(status.output);
    std::size_t failed = 0;
    for (const auto& job : json["jobs"]) {
        failed += job["state"] == "failed";
        EXPECT_EQ(job.contains("seconds"), job["state"] == "done") << job;
    }
    EXPECT_EQ(failed, 3U) << "the generator, its motions and its scores";
}

TEST_F(Sweep, ManyHandsTellOfEveryFailure) {
    sweep_file("  full: {seeds: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], fills: [table3/full/NTU-1P]}\n");
    write_file(dir / "broken", "train generator");
    const auto result = sweep("--jobs 4");
    EXPECT_EQ(result.exit, 1) << result.output;
    EXPECT_PRED2([](const auto& said, const auto& words) { return said.find(words) != std::string::npos; },
                 result.output, std::string("30 of 32 jobs failed or could not begin"));
}

TEST_F(Sweep, KilledTwiceItComesToTheSame) {
    sweep_file(two_rows);
    write_file(dir / "pause", "0.2");
    for (const char* seconds : {"0.5", "0.9"})
        EXPECT_EQ(run_command("timeout -s KILL " + std::string(seconds) + " " + command()).exit, 128 + 9);
    ASSERT_EQ(sweep("--jobs 2").exit, 0);
    const auto killed = read_file(dir / "out/results.json");
    fs::remove_all(dir / "out");
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(read_file(dir / "out/results.json"), killed);
}

TEST_F(Sweep, WhatAJobMadeIsMadeAgainWhereItChangedAndThatIsSaid) {
    sweep_file("  full: {fills: [table1/ActFormer/NTU-1P]}\n");
    ASSERT_EQ(sweep().exit, 0);
    const auto file = [&](const std::string& name) {
        for (const auto& entry : fs::recursive_directory_iterator(dir / "out/jobs"))
            if (entry.path().filename() == name && entry.path().string().find("/score-") != std::string::npos)
                return entry.path();
        ADD_FAILURE() << name;
        return fs::path();
    };
    const auto scores = file("scores.json"), done = file("done.json");
    const auto text = read_file(scores), noted = read_file(done);
    auto cut = Json::parse(noted);
    cut.erase("checksum");
    const auto changes = {
        std::tuple{scores, replaced(text, "0.5", "0.6"), "scores.json: changed since it was made"},
        {done, replaced(noted, "finished", "finisht"), "done.json: damaged"},
        {done, cut.dump(), "done.json: damaged"},
        {done, noted.substr(0, noted.size() / 2), "done.json: damaged"}};
    for (const auto& [path, changed, why] : changes) {
        const auto before = calls().size();
        write_file(path, changed);
        const auto again = sweep();
        ASSERT_EQ(again.exit, 0) << again.output;
        EXPECT_NE(again.output.find("again:  full, seed 0: scores"), std::string::npos) << again.output;
        EXPECT_NE(again.output.find(why), std::string::npos) << again.output;
        EXPECT_EQ(calls().size(), before + 1) << "the scores alone";
        EXPECT_EQ(read_file(scores), text);
    }
    fs::remove(scores);
    EXPECT_NE(sweep().output.find("scores.json: missing"), std::string::npos);
    const auto before = calls().size();
    auto old = Json::parse(read_file(done));  // as it was before it told any checksums
    old.erase("made");
    old.erase("checksum");
    write_file(done, old.dump());
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls().size(), before);
}

TEST_F(Sweep, TwoProcessesShareTheWork) {
    sweep_file(two_rows);
    write_file(dir / "pause", "0.1");
    const auto both = run_command(command() + " & " + command() + "; wait");
    EXPECT_EQ(calls().size(), 9U) << both.output;
    EXPECT_EQ(results()["rows"][0]["status"], "done");
    EXPECT_EQ(results()["rows"][1]["status"], "done");
}

TEST_F(Sweep, PrintsItsPlanAndChangesNothing) {
    sweep_file(two_rows);
    const auto plan = sweep("--dry-run");
    ASSERT_EQ(plan.exit, 0) << plan.output;
    EXPECT_NE(plan.output.find("train generator -c " + at("g.yaml")), std::string::npos) << plan.output;
    EXPECT_NE(plan.output.find("8 of 8 jobs to do"), std::string::npos) << plan.output;
    EXPECT_NE(plan.output.find("about"), std::string::npos) << plan.output;
    EXPECT_FALSE(fs::exists(at("out")));
    EXPECT_FALSE(fs::exists(at("calls")));
    ASSERT_EQ(sweep().exit, 0);
    const auto status = sweep("--status");
    EXPECT_NE(status.output.find("0 of 8 jobs to do"), std::string::npos) << status.output;
    EXPECT_NE(status.output.find("2 of 2 rows done"), std::string::npos) << status.output;
}

TEST_F(Sweep, RunsNothingWhereItIsAskedToTell) {
    sweep_file(two_rows);
    for (const auto* other : {"--dry-run", "--status", "--slurm", "--jobs 2"})
        actformer::test::expect_refused(sweep(std::string("--only score-0 ") + other),
                                        {"--only runs a single job", "leave it out"});
    for (const auto* other : {"--dry-run", "--slurm"})
        actformer::test::expect_refused(sweep(std::string("--status ") + other),
                                        {"--status tells of all jobs", "leave it out"});
    EXPECT_FALSE(fs::exists(at("out")));
    EXPECT_FALSE(fs::exists(at("calls")));
}

TEST_F(Sweep, ADryRunFailsWhereAJobCannotBeDone) {
    sweep_file("  full: {config: none.yaml}\n");
    const auto plan = sweep("--dry-run");
    EXPECT_EQ(plan.exit, 1) << plan.output;
    EXPECT_GT(plan.output.find("sweep.yaml: 1 of 5 jobs cannot be done; the lines above say why"),
              plan.output.find("5 of 5 jobs to do"))
        << plan.output;
    EXPECT_NE(plan.output.find("sweep.yaml: 1 of 5"), std::string::npos) << plan.output;
    EXPECT_NE(plan.output.find("cannot be done: "), std::string::npos) << plan.output;
    EXPECT_FALSE(fs::exists(at("out")));
}

TEST_F(Sweep, RefusesDatasetsThatCannotBeMade) {
    const std::string row = "rows:\n  full: {data: d, recogniser: r, weights: g.yaml}\n";
    const auto with = [&](const std::string& dataset) {
        write_file(dir / "sweep.yaml", "name: test\ndatasets:\n  d: " + dataset +
                                           "\nrecognisers:\n  r: {weights: r.yaml}\n" + row);
        return sweep("--dry-run");
    };
    for (const auto& [dataset, why] :
         {std::pair{"{format: motions, clips: 10}",
                    "synth makes no clips of format 'motions'; it makes ntu, "},
          {"{format: babel, clips: 10, actions: 1-3}", "actions: clips of format 'babel'"},
          {"{format: ntu, clips: 10, actions: 1-500}", "--actions 1-500: '1-500' is outside 1 to 120"},
          {"{format: ntu, clips: 10, arguments: [--treads, '2']}",
           "there is no option '--treads'; did you mean --threads? (see actformer ingest ntu --help)"},
          {"{format: bvh, raw: [.], arguments: [--threads, many]}", "--threads: "},
          {"{format: bvh, raw: [.], arguments: [--help]}", "help is asked for"}}) {
        const auto result = with(dataset);
        EXPECT_EQ(result.exit, 1) << dataset;
        EXPECT_NE(result.output.find(why), std::string::npos) << result.output;
    }
    for (const auto& [dataset, why] : {std::pair{"{path: out, seed: 3}", "'seed' says nothing beside 'path'"},
                                       {"{path: out, use: ntu-1p}", "'use' says nothing beside 'path'"},
                                       {"{raw: out, actions: 1-3}", "'actions' says nothing beside 'raw'"}})
        actformer::test::expect_refused(with(dataset), {"sweep.yaml: line 3", why});
}

TEST_F(Sweep, GoesOnWhereverItsConfigurationsLie) {
    sweep_file(two_rows);
    ASSERT_EQ(sweep().exit, 0);
    fs::create_directory(dir / "moved");
    for (const auto* name : {"r.yaml", "g.yaml"}) fs::rename(dir / name, dir / "moved" / name);
    const auto before = read_file(dir / "sweep.yaml");
    write_file(dir / "sweep.yaml",
               replaced(replaced(before, ": r.yaml", ": moved/r.yaml"), ": g.yaml", ": moved/g.yaml"));
    const auto moved = sweep("--dry-run");
    EXPECT_NE(moved.output.find("0 of 8 jobs to do"), std::string::npos) << moved.output;
    write_file(dir / "moved/g.yaml", read_file(dir / "moved/g.yaml") + "# another\n");
    const auto changed = sweep("--dry-run");
    EXPECT_EQ(changed.output.find("0 of 8 jobs to do"), std::string::npos) << changed.output;
}

TEST_F(Sweep, MayHaveTablesOfItsOwn) {
    write_file(dir / "mine.h5", "motions");
    sweep_file(
        "  mine: {motions: mine.h5, fills: [cmu/Mine/CMU, table1/Mine/NTU-1P]}\n",
        "tables:\n"
        "  cmu: {title: Real motion, columns: [{dataset: CMU, metrics: [accuracy]}], rows: {Mine: {}}}\n"
        "  table1: {rows: {Mine: {}}}\n");
    ASSERT_EQ(sweep().exit, 0);
    const auto report = run_command(program() + " report " + at("out") + " --json");
    ASSERT_EQ(report.exit, 0) << report.output;
    const auto tables = Json::parse(report.output.substr(report.output.find('{')))["tables"];
    EXPECT_EQ(tables[0]["title"], "Real motion") << "before the papers'";
    EXPECT_EQ(tables[0]["rows"][0]["name"], "Mine");
    EXPECT_EQ(tables[1]["id"], "table1");
    EXPECT_EQ(tables[1]["rows"].back()["name"], "Mine");
}

TEST_F(Sweep, ScoresMotionsOfOtherTools) {
    write_file(dir / "theirs.h5", "motions");
    sweep_file("  theirs: {motions: [theirs.h5], fills: [table1/ACTOR/NTU-1P]}\n");
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls_of("--generated " + at("theirs.h5")), 1);
    EXPECT_EQ(calls_of("train generator"), 0);
}

TEST_F(Sweep, ScoresWeightsThatAreThereAndAgainWhereTheyChanged) {
    write_file(dir / "ready.h5", "weights");
    sweep_file("  ready: {weights: ready.h5, seeds: [1, 2], fills: [table1/ActFormer/NTU-1P]}\n");
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls_of("train generator"), 0);
    EXPECT_EQ(calls_of("generate --generator " + at("ready.h5")), 1);
    EXPECT_EQ(calls_of("--generator " + at("ready.h5") + " --repeats 3"), 1) << "there is one of it";
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls_of("--generator " + at("ready.h5") + " --repeats 3"), 1);
    write_file(dir / "ready.h5", "others");
    ASSERT_EQ(sweep().exit, 0);
    EXPECT_EQ(calls_of("--generator " + at("ready.h5") + " --repeats 3"), 2);
}

TEST_F(Sweep, ScoresAgainWhereADatasetThatIsThereChanged) {
    fs::copy(toy(), dir / "toy", fs::copy_options::recursive);
    write_file(dir / "ready.h5", "weights");
    write_file(dir / "sweep.yaml",
               "datasets:\n  toy: {path: toy}\nrecognisers:\n  toy: {weights: ready.h5}\n"
               "rows:\n  ready: {data: toy, recogniser: toy, weights: ready.h5, split: s/train}\n");
    const auto scorings = [&] {
        EXPECT_EQ(sweep().exit, 0);
        return calls_of("score ");
    };
    EXPECT_EQ(scorings(), 1);
    EXPECT_EQ(scorings(), 1);
    auto description = nlohmann::ordered_json::parse(read_file(dir / "toy/dataset.json"));
    description.erase("checksum");  // as who edits it does
    description.erase("program");
    description["fps"] = 25;
    write_file(dir / "toy/dataset.json", description.dump());
    EXPECT_EQ(scorings(), 2);
    EXPECT_EQ(scorings(), 2);
}

TEST_F(Sweep, IngestsAgainWhereRawFilesOrAFileThatItNamesChanged) {
    fs::create_directory(dir / "takes");
    write_file(dir / "takes/a.bvh", "a walk");
    write_file(dir / "names.csv", "a,walk");
    write_file(dir / "mine.h5", "weights");
    write_file(
        dir / "sweep.yaml",
        fmt::format("datasets:\n  d: {{format: bvh, raw: [takes], arguments: [--labels, {0}/names.csv]}}\n"
                    "recognisers:\n  r: {{data: d, config: r.yaml}}\n"
                    "rows:\n  a: {{data: d, recogniser: r, config: g.yaml, seeds: 0, set: {{recogniser: "
                    "{0}/mine.h5}}}}\n",
                    dir.path().string()));
    using Calls = std::pair<long, long>;  // of ingests and trainings
    const auto calls = [&] {
        const auto result = sweep();
        EXPECT_EQ(result.exit, 0) << result.output;
        return Calls{calls_of("ingest bvh"), calls_of("train generator")};
    };
    EXPECT_EQ(calls(), Calls(1, 1));
    EXPECT_EQ(calls(), Calls(1, 1));
    write_file(dir / "takes/b.bvh", "a run");
    EXPECT_EQ(calls(), Calls(2, 2)) << "a recording more";
    write_file(dir / "names.csv", "a,stroll");
    EXPECT_EQ(calls(), Calls(3, 3)) << "another label";
    write_file(dir / "mine.h5", "others");
    EXPECT_EQ(calls(), Calls(3, 4)) << "another recogniser that chooses weights";
}

TEST_F(Sweep, EndsInOneLineWhereItsResultsCannotBeWritten) {
    sweep_file(two_rows);
    write_file(dir / "actformer",
               replaced(stand_in, "kind=$1\n",
                        "kind=$1\n[ $kind != train ] || until [ -d $here/out/results.json/taken ]; do "
                        "rm -rf $here/out/results.json; mkdir -p $here/out/results.json/taken; done\n"));
    for (const char* jobs : {"1", "2", "4"}) {
        const auto result = run_command("timeout 60 " + command("--jobs " + std::string(jobs)));
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_NE(result.output.find("results.json"), std::string::npos) << result.output;
        const auto last = result.output.rfind("actformer: ");
        ASSERT_NE(last, std::string::npos) << result.output;
        EXPECT_EQ(lines_in(result.output.substr(last)), 1) << result.output;
        fs::remove_all(dir / "out");
    }
}

TEST_F(Sweep, MissingDataFailOnlyTheirRows) {
    sweep_file("  full: {fills: [table3/full/NTU-1P]}\n  theirs: {motions: none.h5}\n");
    const auto result = sweep();
    EXPECT_EQ(result.exit, 1);
    EXPECT_NE(result.output.find("failed: theirs: none.h5: no such file"), std::string::npos)
        << result.output;
    EXPECT_EQ(results()["rows"][0]["status"], "done");
}

TEST_F(Sweep, RefusesWhatMakesNoSense) {
    sweep_file("  a: {like: b}\n  b: {like: c}\n  c: {like: a}\n");
    expect_refused({"sweep.yaml", "line ", "circle", "a -> b -> c -> a"});
    sweep_file("  a: {like: a}\n");
    expect_refused({"circle", "a -> a"});
    std::string chain;
    for (int i = 0; i < 9000; ++i)
        chain += "  a" + std::to_string(i) + ": {like: a" + std::to_string(i + 1) + "}\n";
    sweep_file(chain + "  a9000: {}\n");
    expect_refused({"sweep.yaml: line ", "more than 64 entries like each other"});
    sweep_file("  a: {split: caf\xE9}\n");
    expect_refused({"sweep.yaml: line 9", "not UTF-8"});
    sweep_file("  a: {like: nobody}\n");
    expect_refused({"line 9", "nobody"});
    sweep_file("  a: {fills: [table9/full/NTU-1P]}\n");
    expect_refused({"line 9", "table9", "table1, table2"});
    sweep_file("  a: {fills: [table3/fool/NTU-1P]}\n");
    expect_refused({"no row 'fool'; did you mean full?", "Gaussian prior"});
    sweep_file("  a: {fills: [table3/full/NTU-2P]}\n");
    expect_refused({"NTU-2P", "there are NTU-1P"});
    sweep_file("  a: {fills: [full]}\n");
    expect_refused({"table3/full/NTU-1P"});
    sweep_file("  a: {fills: [table3/full/NTU-1P]}\n  b: {fills: [table3/full/NTU-1P]}\n");
    expect_refused({"table3/full/NTU-1P", "'a' and 'b'"});
    sweep_file("  a: {repeat: 3}\n");
    expect_refused({"line 9", "'repeat'", "repeats"});
    sweep_file("  a: {sett: {batch: 3}}\n");
    expect_refused({"line 9", "a row has no key 'sett'; did you mean set?; it takes data, recogniser, "});
    sweep_file("  a: {like: bb}\n  b: {}\n");
    expect_refused({"line 9", "no 'bb' to be like; did you mean b?"});
    sweep_file("  a: {repeats: many}\n");
    expect_refused({"line 9", "'repeats'", "whole number"});
    sweep_file("  a: {seeds: [0, 1, 0]}\n");
    expect_refused({"line 9", "seed 0 twice"});
    sweep_file("  a: {seeds: {first: 0}}\n");
    expect_refused({"line 9", "'seeds' must be a list"});
    sweep_file("  a: {? [seeds] : 3}\n");
    expect_refused({"line 9", "rows: 'a': a key must be a text"});
    sweep_file("  a: {repeats: 0}\n");
    expect_refused({"'repeats'", "at least 1"});
    sweep_file("  a: {set: {seed: 7}}\n");
    expect_refused({"line 9", "row 'a': 'seed' says nothing in 'set'; say seeds beside it"});
    sweep_file("  a: {set: {data: two}}\n");
    expect_refused({"line 9", "row 'a': 'data' says nothing in 'set'; say data beside it"});
    sweep_file("  a: {fills: [~]}\n");
    expect_refused({"line 9", "'fills' must be cells"});
    write_file(dir / "sweep.yaml",
               "recognisers:\n  r: {data: d, config: r.yaml, set: {seed: 3, data: e}}\nrows:\n  a: {}\n");
    expect_refused({"line 2", "recogniser 'r': 'data' says nothing in 'set'"});
    sweep_file("  a: {data: three}\n");
    expect_refused({"line 9", "no dataset 'three'"});
    write_file(dir / "sweep.yaml", "datasets:\n  one: {raw: [x], format: bhv}\nrows:\n  a: {}\n");
    expect_refused({"line 2", "no format 'bhv'; did you mean bvh?; there are", "ntu"});
    sweep_file("  a: {recogniser: ears}\n");
    expect_refused({"no recogniser 'ears'"});
    sweep_file("  a: 3\n");
    expect_refused({"line 9", "must be a map"});
    sweep_file("  a: {}\n  a: {}\n");
    expect_refused({"line 10: rows: 'a' is given twice"});
    sweep_file("  a: [\n");
    expect_refused({"sweep.yaml", "line"});
    write_file(dir / "sweep.yaml", "name: nothing\n");
    expect_refused({"no rows"});
    write_file(dir / "sweep.yaml", "just text");
    expect_refused({"holds no sweep"});
    fs::remove(dir / "sweep.yaml");
    expect_refused({"sweep.yaml", "no such file"});
}

TEST_F(Sweep, RefusesKeysGivenTwice) {
    sweep_file("  a: {split: here, split: there}\n");
    expect_refused({"sweep.yaml: line 9: rows: 'a': 'split' is given twice"});
    sweep_file("  a: {set: {batch: 1, batch: 2}}\n");
    expect_refused({"line 9: rows: 'a', set: 'batch' is given twice"});
    sweep_file("  a: {}\n", "name: other\n");
    expect_refused({"line 8: a sweep: 'name' is given twice"});
    sweep_file("  a: {}\n", "tables:\n  table1: {rows: {A: {}}}\n  table1: {rows: {B: {}}}\n");
    expect_refused({"line 10: tables: 'table1' is given twice"});
    const auto with_base = [&](const std::string& keys, const std::string& others) {
        sweep_file("  a: {set: {batch: 1}}\n");
        write_file(dir / "sweep.yaml", replaced(read_file(dir / "sweep.yaml"), keys, others));
    };
    with_base("repeats: 3", "repeats: 3, repeats: 4");
    expect_refused({"line 7: base: 'repeats' is given twice"});
    with_base("set: {epochs: 5}", "set: {epochs: 5, epochs: 6}");
    expect_refused({"line 7: base, set: 'epochs' is given twice"});
}

TEST_F(Sweep, RefusesWhatSaysNothingBesideMotions) {
    for (const auto* name : {"m.h5", "w.h5"}) write_file(dir / name, "another tool's");
    sweep_file("  a: {motions: m.h5, weights: w.h5}\n");
    expect_refused({"line 9: row 'a': 'weights' says nothing beside 'motions'; leave one of them out"});
    sweep_file("  a: {motions: m.h5, config: g.yaml}\n");
    expect_refused({"line 9: row 'a': 'config' says nothing beside 'motions'"});
    sweep_file("  a: {weights: w.h5}\n  b: {like: a, motions: m.h5}\n");
    expect_refused({"row 'b': 'weights' says nothing beside 'motions'", "`~` takes an inherited one away"});
    sweep_file("  a: {weights: w.h5}\n  b: {like: a, weights: ~, motions: m.h5}\n");
    const auto plan = sweep("--dry-run");
    EXPECT_EQ(plan.exit, 0) << "the base's config may stay: " << plan.output;
}

TEST_F(Sweep, RefusesAProgramThatCannotBeRun) {
    sweep_file("  full: {}\n");
    const auto with = [&](const std::string& named) {
        return run_command("PATH=" + at("bin") + ":$PATH " + program() + " sweep " + at("sweep.yaml") +
                           " -o " + at("out") + " --dry-run --program " + named);
    };
    for (const auto& named : {std::string("/nope"), at("sweep.yaml"), at("")})
        actformer::test::expect_refused(with(named), {"--program: " + named + " cannot be run"});
    actformer::test::expect_refused(with("no-actformer"), {"no program no-actformer in PATH"});
    fs::create_directory(dir / "bin");
    fs::copy(dir / "actformer", dir / "bin/my-actformer");
    EXPECT_EQ(with("my-actformer").exit, 0);
    EXPECT_EQ(with(at("actformer")).exit, 0);
}

TEST_F(Sweep, NamesAreOnlyText) {
    const std::string name = "../../<script>alert(1)</script>$(touch x)'";
    sweep_file("  \"" + name + "\\e[2J\": {fills: [table3/full/NTU-1P]}\n");
    const auto result = sweep();
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(result.output.find('\033'), std::string::npos) << "nothing reaches the terminal unescaped";
    EXPECT_EQ(results()["rows"][0]["name"], name + "\033[2J");
    for (const auto& entry : fs::directory_iterator(dir / "out/jobs"))
        EXPECT_EQ(entry.path().filename().string().find_first_not_of("abcdefghijklmnopqrstuvwxyz-0123456789"),
                  std::string::npos);
}

TEST_F(Sweep, GoesThroughSlurm) {
    sweep_file(two_rows);
    slurm_stand_in("for last; do :; done\nsh -c \"$last\" >$here/said 2>&1", "");  // runs the job at once
    const auto result = with_slurm("--slurm --sbatch=--gres=gpu:1");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(result.output.find("8 jobs submitted"), std::string::npos) << result.output;
    const auto said = read_file(dir / "bin/calls");
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 8);
    EXPECT_NE(said.find("--dependency afterok:1 --kill-on-invalid-dep=yes --gres=gpu:1"), std::string::npos)
        << said;
    EXPECT_EQ(results()["rows"][1]["status"], "done") << read_file(dir / "bin/said");
    EXPECT_EQ(calls().size(), 9U);
    EXPECT_NE(sweep("--status").output.find("2 of 2 rows done"), std::string::npos);
}

TEST_F(Sweep, TellsHowFarItIsAndWritesNothing) {
    sweep_file(two_rows);
    slurm_stand_in("", "echo slow today >&2");
    ASSERT_EQ(with_slurm("--slurm").exit, 0);
    const auto before = tree(dir / "out");
    sweep_file(std::string(two_rows) + "  third: {like: full, set: {epochs: 6}}\n");
    for (const auto* option : {"--status", "--status --json", "--dry-run"}) {
        const auto result = with_slurm(option);
        EXPECT_EQ(result.exit, 0) << result.output;
        EXPECT_TRUE(tree(dir / "out") == before) << option;
    }
}

/// The jobs that wait are those of all calls, each with its comment.
constexpr const char* all_wait =
    "[ ! -e $here/calls ] || sed -n 's/.*--comment \\([^ ]*\\).*/|PD|Nodes are DOWN, DRAINED|\\1/p' "
    "$here/calls | "
    "awk '{print NR $0}'";

TEST_F(Sweep, AKillBeforeSlurmsNumberIsKeptSubmitsNothingTwice) {
    sweep_file(two_rows);
    slurm_stand_in("[ $(wc -l < $here/calls) != 3 ] || kill -9 $PPID", all_wait);
    EXPECT_NE(with_slurm("--slurm").exit, 0);
    const auto again = with_slurm("--slurm");
    ASSERT_EQ(again.exit, 0) << again.output;
    EXPECT_NE(again.output.find("5 jobs submitted"), std::string::npos) << again.output;
    EXPECT_EQ(lines_of("bin/calls").size(), 8U);
    EXPECT_NE(read_file(dir / "bin/calls").find("afterok:3"), std::string::npos)
        << "of the job it was killed at";
}

TEST_F(Sweep, CommentsInSlurmThatAreNoTextAreKeptPrintable) {
    sweep_file(two_rows);
    slurm_stand_in(":", "printf '7\\377|R|None|" + at("out/jobs") + "/\\377\\n'");
    const auto result = with_slurm("--slurm");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(nlohmann::json::parse(read_file(dir / "out/slurm.json"))["\\xFF"], "7\\xFF");
}

TEST_F(Sweep, ASignalWhileAJobIsSubmittedWaitsForItsNumber) {
    sweep_file(two_rows);
    slurm_stand_in("[ $(wc -l < $here/calls) != 3 ] || { kill -TERM $PPID; sleep 0.2; }", "");
    const auto stopped = with_slurm("--slurm");
    EXPECT_EQ(stopped.exit, 143) << stopped.output;
    const auto submitted = lines_of("bin/calls").size();  // 3 unless the machine is busy
    EXPECT_GE(submitted, 3U);
    const auto said = fmt::format("stopped by SIGTERM; {} submitted", submitted);
    EXPECT_TRUE(submitted == 8 || stopped.output.find(said) != std::string::npos) << stopped.output;
    const auto numbers = nlohmann::json::parse(read_file(dir / "out/slurm.json"));
    EXPECT_EQ(numbers.size(), submitted + 2) << "the jobs, program and checksum: " << numbers;
}

TEST_F(Sweep, SubmittedTwiceAtOnceGoesToSlurmOnce) {
    sweep_file(two_rows);
    slurm_stand_in("sleep 0.05", all_wait);
    const auto once = command("--slurm");
    const auto both = run_command("export PATH=" + at("bin") + ":$PATH; " + once + " & " + once + "; wait");
    EXPECT_NE(both.output.find("8 jobs submitted"), std::string::npos) << both.output;
    EXPECT_NE(both.output.find("0 jobs submitted"), std::string::npos) << both.output;
    EXPECT_EQ(both.output.find("actformer: "), std::string::npos) << both.output;
    EXPECT_EQ(lines_of("bin/calls").size(), 8U) << read_file(dir / "bin/calls");
}

TEST(SweepFiles, AreSound) {
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(source("reports/sweeps"))) {
        ++files;
        const auto result = run_command("cd " + source("") + " && " + program() + " sweep " +
                                        entry.path().string() + " -o /nonexistent/out --dry-run");
        std::istringstream lines(result.output);
        for (std::string line; std::getline(lines, line);)
            EXPECT_TRUE(line.find("cannot be done: ") == std::string::npos ||
                        line.find("no such file or folder") != std::string::npos)
                << entry.path() << ": wants more than data: " << line;
        EXPECT_NE(result.output.find("jobs to do"), std::string::npos) << result.output;
    }
    EXPECT_EQ(files, 10U);
}

TEST(RealSweep, GoesFromADatasetToScores) {
    const TempDir dir;
    write_file(dir / "r.yaml",
               "model: recogniser\nwidth: 0.1\nframes: 20\nbatch: 16\nepochs: 1\ntrain_split: s/train\n");
    write_file(
        dir / "g.yaml",
        "model: actformer\nframes: 20\nwidth: 16\nheads: 2\ndepth: 1\nlatent: 8\nd_width: 4\nbatch: 16\n"
        "epochs: 1\ntrain_split: s/train\n");
    write_file(dir / "sweep.yaml",
               "name: real\n"
               "datasets: {toy: {path: " +
                   toy().string() +
                   "}}\n"
                   "recognisers: {toy: {data: toy, config: r.yaml}}\n"
                   "base: {data: toy, recogniser: toy, config: g.yaml, split: s/train, window: 20, repeats: "
                   "2, per_class: 3}\n"
                   "rows: {full: {fills: [table3/full/NTU-1P]}}\n");
    const auto out = (dir / "out").string();
    const auto result = run_actformer("sweep " + (dir / "sweep.yaml").string() + " -o " + out);
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto row = Json::parse(read_file(dir / "out/results.json"))["rows"][0];
    EXPECT_EQ(row["status"], "done") << row["why"];
    const auto scores = Json::parse(read_file(dir / "out" / row["runs"][0]["scores"].get<std::string>()));
    EXPECT_EQ(scores["fid_whole"]["repeats"].size(), 2U);
    EXPECT_TRUE(fs::exists(dir / "out" / row["runs"][0]["motions"].get<std::string>()));
}

TEST_F(Sweep, RowsAreScoredAgainstWhatTheyTrainOn) {
    sweep_file(
        "  said: {split: xsub/test, set: {train_split: here}}\n"
        "  set: {set: {train_split: here}}\n"
        "  configured: {config: split.yaml}\n"
        "  neither: {}\n");
    write_file(dir / "split.yaml", "model: generator\ntrain_split: there\n");
    ASSERT_EQ(sweep().exit, 0);
    for (const auto* split : {"xsub/test", "here", "there", "all"})
        EXPECT_EQ(calls_of(std::string("--split ") + split + " "), 1) << split;
    EXPECT_EQ(results()["rows"][2]["split"], "there");
}

TEST_F(Sweep, RefusesSplitsThatADatasetHasNot) {
    const auto sweep_of = [&](const std::string& recogniser, const std::string& row) {
        write_file(dir / "sweep.yaml", "datasets: {toy: {path: " + toy().string() +
                                           "}}\nrecognisers: {ears: {data: toy, config: r.yaml, set: {" +
                                           recogniser +
                                           "}}}\nbase: {data: toy, recogniser: ears, config: g.yaml}\n"
                                           "rows: {full: {" +
                                           row + "}}\n");
    };
    const std::string there = "which has all, s/train, s/test, s/two, s/none";
    sweep_of("", "split: xsub/train");
    expect_refused({"sweep.yaml: row 'full'", "no split 'xsub/train'", there, "split:"});
    sweep_of("", "set: {train_split: s/tain}");
    expect_refused({"row 'full'", "no split 's/tain'", there, "train_split:"});
    sweep_of("test_split: test", "");
    expect_refused({"recogniser ears", "no split 'test'", there, "test_split:"});
    sweep_of("train_split: s/train", "split: s/test");
    EXPECT_EQ(sweep("--dry-run").exit, 0);
    sweep_of("", "split: xsub/train");
    EXPECT_EQ(sweep("--status").exit, 0) << "what was done before may be looked at";
}

TEST_F(Sweep, StaysOutOfOtherFolders) {
    sweep_file("  full: {}\n");
    write_file(dir / "out/dataset.json", "{}");
    actformer::test::expect_refused(sweep(), {"/out: holds a dataset", "another -o"});
    fs::remove(dir / "out/dataset.json");
    write_file(dir / "out/config.yaml", "model: csgn\n");
    write_file(dir / "out/log.jsonl", "{\"epoch\":1,\"loss\":2.5}\n");
    actformer::test::expect_refused(sweep("--dry-run"), {"/out: holds a training", "another -o"});
    EXPECT_EQ(calls().size(), 0U);
}

TEST_F(Sweep, LeavesResultsOfOthersAlone) {
    sweep_file("  full: {}\n");
    const auto refused = [&](const std::string& held, const std::vector<std::string>& words) {
        write_file(dir / "out/results.json", held);
        for (const auto* option : {"", "--status", "--dry-run", "--only score-0"})
            actformer::test::expect_refused(sweep(option), words);
        EXPECT_EQ(read_file(dir / "out/results.json"), held);
    };
    refused(R"({"format": 1, "sweep": "mini", "rows": []})",
            {"/out: holds the sweep 'mini', not 'test'; choose another -o", "`name: mini` into"});
    refused(R"({"format": 1, "sweep": "comparison in out", "comparison": true, "rows": []})",
            {"/out: holds a comparison, not the sweep 'test'; choose another -o"});
    EXPECT_EQ(calls().size(), 0U);
    for (const auto* held : {R"({"sweep": "mini", "checksum": "0"})", R"({"sweep": "test"})", "{"}) {
        write_file(dir / "out/results.json", held);
        EXPECT_EQ(sweep().exit, 0) << held;
        EXPECT_EQ(results()["sweep"], "test");
    }
}

TEST_F(Sweep, ADryRunChecksEveryKey) {
    if (!fs::exists(program() + "-train")) GTEST_SKIP() << "built without libtorch";
    sweep_file(
        "  good: {set: {prior: gaussian}}\n"
        "  typing: {set: {piror: gaussian}}\n"
        "  choosing: {set: {epochs: many}}\n",
        "");
    const auto plan = sweep("--dry-run").output;
    EXPECT_NE(plan.find("there is no key 'piror'; did you mean 'prior'?"), std::string::npos) << plan;
    EXPECT_NE(plan.find("epochs must be a whole number"), std::string::npos) << plan;
    EXPECT_EQ(calls().size(), 0U);
    write_file(dir / "r.yaml", "model: recogniser\nwidht: 1\n");
    EXPECT_NE(sweep("--dry-run").output.find("r.yaml:2: there is no key 'widht'; did you mean 'width'?"),
              std::string::npos);
}

TEST_F(Sweep, SuggestsTheNameThatWasMeant) {
    sweep_file("  full: {data: onne}\n");
    expect_refused({"there is no dataset 'onne'; did you mean one?"});
    sweep_file("  full: {recogniser: won}\n");
    expect_refused({"there is no recogniser 'won'; did you mean one?"});
}
