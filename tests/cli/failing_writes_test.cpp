// Every command that writes, with each of its calls of the system that change files failing in turn: the right bytes, or exit code 1,
// one line that names the file, and nothing left over.
//
// ctest tries some of the calls. ACTFORMER_ALL_FAULTS=1 tries all of them, each alone and with all behind it, and prints how many.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "ingest/dataset/dataset.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/toy_recogniser.hpp"
#include "tests/support/tree.hpp"

namespace actformer::test {
namespace {

namespace fs = std::filesystem;

using Tree = std::map<std::string, std::string>;

enum class AfterFailure {
    nothing,  ///< files that were finished before may stay, whole
    resumes   ///< what is done stays, and the same command goes on from there
};

struct Writing {
    std::string name, arguments;  ///< {} is the folder that it writes into
    AfterFailure after = AfterFailure::nothing;
    std::string compared = ".*";  ///< which files have the same bytes in every run
    bool keeps_features = false;  ///< in the user's cache
    long tried = 3;               ///< of its calls, where not all are
    bool has_jobs = false;        ///< whose lines, above the last, name the file
    bool must_fail = true;        ///< the calls that are tried are sure to hold one that it cannot do without
};

struct Ran {
    CommandResult result;
    long calls = 0;
};

struct FailingWrites : testing::Test {
    TempDir dir;
    int runs = 0;

    std::string at(const std::string& name) const { return (dir / name).string(); }

    fs::path fresh() {
        const auto out = dir / std::to_string(runs++) / "out";  // a dataset there is always called the same
        fs::create_directories(out);
        return out;
    }

    Ran run(const Writing& writing, const fs::path& out, long call, bool on = false) const {
        const auto arguments = std::regex_replace(writing.arguments, std::regex("\\{\\}"), out.string());
        Ran ran;
        const auto cache = writing.keeps_features ? out / "cache" : dir / "cache";
        ran.result = run_command(fmt::format(
            "timeout 120 env XDG_CACHE_HOME={} POCL_CACHE_DIR=${{POCL_CACHE_DIR:-{}/pocl}} LD_PRELOAD={} "
            "FAIL_BELOW={} FAIL_AT={} {} FAIL_COUNT={} {} {}",
            cache.string(), dir.path().string(), failing_calls(), out.string(), call, on ? "FAIL_ON=1" : "",
            at("count"), program(), arguments));
        ran.calls = std::atol(read_file(dir / "count").c_str());
        return ran;
    }

    static Tree compared(const Writing& writing, const fs::path& out) {
        auto files = tree(out);
        const std::regex which(writing.compared);
        std::erase_if(files, [&](const auto& file) { return !std::regex_match(file.first, which); });
        return files;
    }

    static std::string names(const Tree& files) {
        std::string all;
        for (const auto& [name, bytes] : files) all += name + " ";
        return all;
    }

    void check_failed(const Writing& writing, const Ran& ran, const fs::path& out, const Tree& right) const {
        const auto& said = ran.result.output;
        EXPECT_EQ(ran.result.exit, 1) << said;
        const auto at = said.rfind("actformer: ");
        ASSERT_NE(at, std::string::npos) << said;
        EXPECT_EQ(lines_in(said.substr(at)), 1) << said;
        EXPECT_NE(said.find(out.string(), writing.has_jobs ? 0 : at), std::string::npos)
            << "names no file: " << said;
        if (writing.after == AfterFailure::resumes) {
            const auto again = run(writing, out, 0);
            EXPECT_EQ(again.result.exit, 0) << again.result.output;
            EXPECT_TRUE(compared(writing, out) == right) << names(compared(writing, out));
            return;
        }
        for (const auto& [name, bytes] : compared(writing, out)) {
            const auto whole = right.find(name);
            EXPECT_TRUE(whole != right.end() && whole->second == bytes) << "left over: " << name;
        }
    }

    /// Whether it failed.
    bool check_one(const Writing& writing, const Tree& right, long call, bool on) {
        SCOPED_TRACE(fmt::format("{}, call {}{}", writing.name, call, on ? " and all behind it" : ""));
        const auto out = fresh();
        const auto ran = run(writing, out, call, on);
        if (ran.result.exit == 0) {
            EXPECT_TRUE(compared(writing, out) == right)
                << "exit 0 with other files: " << names(compared(writing, out)) << "\n"
                << ran.result.output;
        } else {
            check_failed(writing, ran, out, right);
        }
        for (const auto& [name, bytes] : tree(out))
            if (writing.after == AfterFailure::nothing || ran.result.exit == 0) {
                EXPECT_EQ(name.find(".partial"), std::string::npos) << "left over: " << name;
            }
        fs::remove_all(out);
        return ran.result.exit == 1;
    }

    void check(const Writing& writing) {
        const auto out = fresh();
        const auto whole = run(writing, out, 0);
        ASSERT_EQ(whole.result.exit, 0) << whole.result.output;
        const auto right = compared(writing, out);
        ASSERT_FALSE(right.empty());
        ASSERT_GE(whole.calls, 4) << "it opens, writes, closes and renames at least";
        const bool all = std::getenv("ACTFORMER_ALL_FAULTS") != nullptr;
        const auto step = all ? 1 : std::max(1L, (whole.calls + writing.tried - 1) / writing.tried);
        long tried = 0, failed = 0;
        bool turn = false;  // of the calls that are sampled one fails alone, the next with all behind it
        for (long call = whole.calls; call >= 1; call -= step, turn = !turn)
            for (const bool on : {false, true})
                if (on == turn || step == 1) {
                    failed += check_one(writing, right, call, on);
                    ++tried;
                }
        // From one of the calls on all fail, long before the last file has its name.
        EXPECT_TRUE(failed > 0 || !writing.must_fail)
            << writing.name << ": none of " << tried << " runs failed";
        if (all) fmt::print("{:<24}{:>5} calls, {:>5} runs\n", writing.name, whole.calls, tried);
    }
};

}  // namespace

TEST_F(FailingWrites, Synth) {
    check({"synth ntu", "synth ntu -o {}/raw --clips 2 --threads 1"});
    check({"synth gta", "synth gta -o {}/raw --clips 2 --threads 1"});
    check({"synth babel", "synth babel -o {}/raw --clips 2 --threads 1"});
}

TEST_F(FailingWrites, Ingest) {
    const auto bvh = (toy().parent_path() / "raw").string();
    const std::string splits = " --name '{action}_{part}_{index}' --split s/train=part:a --threads 1";
    check({"ingest bvh", "ingest bvh " + bvh + " -o {}/toy" + splits, AfterFailure::resumes});
    check({"ingest bvh, folder there", "ingest bvh " + bvh + " -o {}" + splits, AfterFailure::resumes});
    ASSERT_EQ(run_actformer("synth ntu -o " + at("raw") + " --clips 4 --actions 1,50").exit, 0);
    check({"ingest ntu", "ingest ntu " + at("raw") + " -o {}/ntu --threads 1", AfterFailure::resumes});
    ASSERT_EQ(run_actformer("export " + toy().string() + " -o " + at("m.h5")).exit, 0);
    check({"ingest motions", "ingest motions " + at("m.h5") + " -o {}/motions --threads 1",
           AfterFailure::resumes});
}

TEST_F(FailingWrites, Export) {
    const auto clip = " --clip " + ingest::Dataset(toy_pairs()).clips()[0].name;
    const auto from = "export " + toy_pairs().string() + clip;
    for (const auto* kind : {"h5", "npz", "glb", "bvh"})
        check({fmt::format("export .{}", kind), from + " -o {}/clip." + kind});
    for (const auto* kind : {"h5", "bvh"})
        check({fmt::format("export --format {}", kind), from + " -o {}/clips --format " + kind});
    check({"export all .h5", "export " + toy().string() + " -o {}/all.h5"});
}

TEST_F(FailingWrites, Scores) {
    const auto weights = at("recogniser.h5");
    write_toy_recogniser(toy(), weights);
    ASSERT_EQ(run_actformer("export " + toy().string() + " -o " + at("m.h5") + " --split s/train").exit, 0);
    write_file(dir / "labels.txt", labels_of_clips(toy()));
    check({"features",
           "features --recogniser " + weights + " " + toy().string() + " --split s/test -o {}/f.h5"});
    check({"classify", "classify --recogniser " + weights + " " + at("m.h5") + " -o {}/c.csv"});
    ASSERT_EQ(
        run_actformer("features --recogniser " + weights + " " + toy().string() + " -o " + at("f.h5")).exit,
        0);
    check({"score of features",
           "score --real-features " + at("f.h5") + " --generated-features " + at("f.h5") + " -o {}/s.json"});
    Writing score{"score",
                  "score --recogniser " + weights + " --real " + toy().string() +
                      " --split s/train --generated " + at("m.h5") + " --labels " + at("labels.txt") +
                      " -o {}/s.json --keep-features {}/kept",
                  AfterFailure::resumes};
    score.keeps_features = true;
    score.compared =
        "s.json|kept/.*";  // where nothing can be kept for the next scoring, this one goes on without
    check(score);
}

/// Whose bytes are the same in every run: of sweeps and comparisons all but what tells the time.
constexpr const char* untimed = "(?!.*(results|job|done)\\.json|.*log\\.txt|.*lock|.*\\.html).*";

TEST_F(FailingWrites, Comparisons) {
    const auto weights = at("recogniser.h5");
    write_toy_recogniser(toy(), weights);
    for (const auto* split : {"train", "test"})
        ASSERT_EQ(
            run_actformer("export " + toy().string() + " -o " + at(split) + ".h5 --split s/" + split).exit,
            0);
    Writing compare{"compare",
                    "compare " + at("train.h5") + " " + at("test.h5") + " --recogniser " + weights +
                        " --real " + toy().string() + " --split s/train -o {}/c",
                    AfterFailure::resumes, untimed};
    compare.must_fail = false;  // its last files are a page and what tells the time
    check(compare);
}

TEST_F(FailingWrites, Sweeps) {
    write_toy_recogniser(toy(), dir / "recogniser.h5");
    ASSERT_EQ(run_actformer("export " + toy().string() + " -o " + at("m.h5") + " --split s/test").exit, 0);
    write_file(dir / "sweep.yaml",
               "datasets:\n  toy: {path: " + toy().string() +
                   "}\nrecognisers:\n  toy: {weights: recogniser.h5}\n"
                   "rows:\n  theirs: {data: toy, recogniser: toy, motions: [m.h5], split: s/train}\n");
    Writing sweep{"sweep", "sweep " + at("sweep.yaml") + " -o {}/sweep", AfterFailure::resumes, untimed};
    sweep.has_jobs = true;
    sweep.must_fail = false;
    check(sweep);
}

TEST_F(FailingWrites, Import) {
    if (!has_eager_pytorch()) GTEST_SKIP() << "no Python with torch";
    const auto joints = ingest::Dataset(toy()).header().topology.joints();
    write_file(dir / "make.py", fmt::format("import torch\n"
                                            "from torch import nn\n"
                                            "gru = nn.Module()\n"
                                            "gru.recurrent = nn.GRU(3 * {}, 32, 2)\n"
                                            "gru.linear1, gru.linear2 = nn.Linear(32, 30), nn.Linear(30, 3)\n"
                                            "torch.save({{'model': gru.state_dict()}}, '{}')\n",
                                            joints, at("gru.tar")));
    ASSERT_EQ(run_command("/usr/bin/python3 " + at("make.py")).exit, 0);
    check({"import recogniser",
           "import recogniser " + at("gru.tar") + " --data " + toy().string() + " -o {}/r.h5"});
}

TEST_F(FailingWrites, Pictures) {
    if (!fs::exists(fs::path(program()).parent_path() / "actformer-render"))
        GTEST_SKIP() << "there is no render";
    for (const auto* kind : {"png", "gif", "mp4"})
        check({fmt::format("render .{}", kind),
               "render " + toy().string() + " --count 1 --size 60 -o {}/a." + kind});
}

TEST_F(FailingWrites, Report) {
    write_file(dir / "sweep/results.json", R"({"format": 1, "sweep": "s", "rows": []})");
    check({"report", "report " + at("sweep") + " -o {}/r.html --csv {}/r.csv --latex {}/r.tex"});
}

TEST_F(FailingWrites, Trainings) {
    if (!fs::exists(fs::path(program()).parent_path() / "actformer-train"))
        GTEST_SKIP() << "there is no libtorch";
    write_file(dir / "r.yaml",
               "model: recogniser\nwidth: 0.25\nframes: 16\nbatch: 12\nepochs: 2\nrate_drops: []\n"
               "train_split: s/train\ntest_split: s/test\nseed: 4\nthreads: 1\ncheckpoint_minutes: 0\n");
    write_file(
        dir / "g.yaml",
        "model: actformer\nframes: 16\nwidth: 16\nheads: 2\ndepth: 1\nlatent: 8\nd_width: 2\nbatch: 6\n"
        "epochs: 1\ntrain_split: s/train\nseed: 4\nthreads: 1\ncheckpoint_minutes: 0\n");
    const std::string data = " --data " + toy().string(), weights = ".*weights.*h5";
    constexpr long tried = 2;  // each loads libtorch twice
    check({"train recogniser", "train recogniser -c " + at("r.yaml") + data + " -o {}/run",
           AfterFailure::resumes, weights, false, tried});
    check({"train generator", "train generator -c " + at("g.yaml") + data + " -o {}/run",
           AfterFailure::resumes, weights, false, tried});
    ASSERT_EQ(run_actformer("train generator -c " + at("g.yaml") + data + " -o " + at("run")).exit, 0);
    check({"generate", "generate --generator " + at("run") + " --per-class 2 -o {}/m.h5"});
}

namespace {

/// A command's calls in order, each its name and path.
std::vector<std::string> calls_of(const TempDir& dir, const std::string& arguments) {
    const auto list = (dir / "list").string();
    fs::remove(list);
    const auto ran = run_command(fmt::format(
        "env XDG_CACHE_HOME={} FAIL_BELOW={} FAIL_LIST={} LD_PRELOAD={} {} {}", (dir / "cache").string(),
        (dir / "out").string(), list, failing_calls(), program(), arguments));
    EXPECT_EQ(ran.exit, 0) << ran.output;
    std::vector<std::string> calls;
    std::istringstream lines(read_file(list));
    for (std::string line; std::getline(lines, line);) calls.push_back(line);
    return calls;
}

/// Where the last of `calls` is that is called one of `names`, of this path; -1 where none is.
std::ptrdiff_t last_of(const std::vector<std::string>& calls, std::initializer_list<std::string> names,
                       const std::string& path) {
    for (auto i = std::ssize(calls); i-- > 0;)
        for (const auto& name : names)
            if (calls[static_cast<std::size_t>(i)] == name + " " + path) return i;
    return -1;
}

std::ptrdiff_t last_write(const std::vector<std::string>& calls, const std::string& path) {
    return last_of(calls, {"write", "writev", "pwrite", "pwrite64", "ftruncate", "ftruncate64"}, path);
}

}  // namespace

TEST_F(FailingWrites, AFileIsOnTheDiskBeforeItHasItsName) {
    write_toy_recogniser(toy(), dir / "r.h5");
    fs::create_directory(dir / "out");
    const auto clip = " --clip " + ingest::Dataset(toy()).clips()[0].name;
    const auto from = "export " + toy().string() + clip + " -o ";
    for (const auto& [file, command] :
         {std::pair{"a.h5", from},
          {"a.npz", from},
          {"a.bvh", from},
          {"f.h5", "features --recogniser " + at("r.h5") + " " + toy().string() + " --split s/test -o "}}) {
        const auto path = at(std::string("out/") + file);
        const auto calls = calls_of(dir, command + path);
        const auto written = last_write(calls, path + ".partial"),
                   synced = last_of(calls, {"fsync"}, path + ".partial"),
                   named = last_of(calls, {"rename", "renameat"}, path),
                   listed = last_of(calls, {"fsync"}, at("out"));
        EXPECT_TRUE(0 <= written && written < synced && synced < named && named < listed)
            << file << ": " << fmt::format("{}", fmt::join(calls, "\n"));
    }
}

TEST_F(FailingWrites, ADatasetIsOnTheDiskBeforeItHasItsName) {
    const auto out = at("out");
    const auto calls = calls_of(dir, "ingest bvh " + (toy().parent_path() / "raw").string() + " -o " + out +
                                         " --name '{action}_{part}_{index}' --threads 1");
    const auto named = last_of(calls, {"rename", "renameat"}, out);
    const auto files = tree(out);
    EXPECT_TRUE(files.contains("shard-00000.h5")) << "and those beside it";
    for (const auto& [name, bytes] : files) {
        const auto path = out + ".partial/data/" + name;
        const auto written = last_of(calls, {"rename", "renameat"}, path),
                   synced = last_of(calls, {"fsync"}, path);
        EXPECT_TRUE(0 <= written && written < synced && synced < named)
            << name << ": " << fmt::format("{}", fmt::join(calls, "\n"));
    }
}

}  // namespace actformer::test
