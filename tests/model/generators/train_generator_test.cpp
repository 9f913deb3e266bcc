// `actformer train generator` and `actformer generate` as their users meet them, on toy motions.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>
#include <algorithm>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "base/hdf5/reader.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "model/generators/method.hpp"
#include "model/generators/train_generator.hpp"
#include "model/train/checkpoint.hpp"
#include "tests/support/checkpoints.hpp"
#include "tests/support/flips.hpp"
#include "tests/support/killed.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_log.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer;
using namespace actformer::test;
using hdf5::Reader;
namespace fs = std::filesystem;

namespace {

constexpr const char* tiny_generator =
    "model: actformer\nframes: 16\nwidth: 16\nheads: 2\ndepth: 1\nlatent: 8\nd_width: 2\nbatch: 6\nepochs: "
    "4\n"
    "train_split: s/train\nseed: 4\nthreads: 1\ncheckpoint_minutes: 0\n";

struct TrainGenerator : testing::Test {
    void SetUp() override { write_file(dir / "toy.yaml", tiny_generator); }

    std::string at(const std::string& name) const { return (dir / name).string(); }
    std::string line(const std::string& run, const std::string& more = "") const {
        return "train generator -c " + at("toy.yaml") + " --data " + toy().string() + " -o " + at(run) + " " +
               more;
    }
    CommandResult train(const std::string& run, const std::string& more = "") const {
        return run_actformer(line(run, more));
    }

    /// A recogniser of random weights that fits the toy dataset: its scores mean nothing, and are numbers.
    std::string recogniser() const {
        const auto graph = eval::recogniser_graph(ingest::Dataset(toy()).header().topology.parents);
        eval::write_stgcn_weights(dir / "recogniser.h5", eval::random_stgcn_weights(3, 3, graph, 0.125, 5));
        return "recogniser=" + at("recogniser.h5");
    }

    TempDir dir;
};

}  // namespace

TEST_F(TrainGenerator, GoesOnAfterAKillToTheSameBits) {
    const auto more = "average=0.9 beta1=0.5 score_every=2 score_per_class=2 " + recogniser();
    const auto whole = watched_run(line("whole", more), dir / "whole");
    ASSERT_EQ(whole.result.exit, 0) << whole.result.output;
    const auto last = newest(dir / "whole");
    ASSERT_EQ(last, "checkpoint-00008.h5");
    // From when the first checkpoint is kept until the last is about to be written.
    const auto first_call = whole.call("checkpoint-00002"), last_call = whole.call(last);
    ASSERT_TRUE(0 < first_call && first_call < last_call);
    std::mt19937 random(std::random_device{}());
    for (int kill = 0; kill < 2; ++kill) {
        const auto call = first_call + random() % (last_call - first_call);
        SCOPED_TRACE(fmt::format("killed before {}", whole.calls[call - 1]));
        kill_before(call, line("killed", more), dir / "killed");
        const auto again = train("killed", more);
        ASSERT_EQ(again.exit, 0) << again.output;
        EXPECT_NE(again.output.find("going on after "), std::string::npos) << again.output;
        EXPECT_EQ(newest(dir / "killed"), last);
        for (const std::string file : {"weights-last.h5", "weights-average.h5", "weights-best.h5"})
            EXPECT_EQ(read_file(dir / ("whole/" + file)), read_file(dir / ("killed/" + file))) << file;
        expect_same_checkpoint(dir / "whole" / last, dir / "killed" / last);
        const auto a = log_of(dir / "whole"), b = log_of(dir / "killed");
        ASSERT_EQ(a.size(), b.size());
        fs::remove_all(dir / "killed");
    }
}

TEST_F(TrainGenerator, ASignalKeepsTheRunningStep) {
    const std::string more = "epochs=60 checkpoint_minutes=1000";
    ASSERT_EQ(train("whole", more).exit, 0);
    for (const int signal : {SIGINT, SIGTERM}) {
        Child child(line("stopped", more), at("output"));
        for (int i = 0; i < 60'000 && !fs::exists(dir / "stopped/log.jsonl"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ::kill(child.pid(), signal);
        const int code = child.wait();
        const auto said = read_file(dir / "output");
        EXPECT_EQ(code, 128 + signal) << said;
        EXPECT_NE(said.find(signal == SIGINT ? "stopped by SIGINT; " : "stopped by SIGTERM; "),
                  std::string::npos)
            << said;
        EXPECT_NE(said.find("of 120 is kept; the same command goes on from there"), std::string::npos)
            << said;
        EXPECT_NE(newest(dir / "stopped"), "") << said;
        for (const auto& entry : fs::directory_iterator(dir / "stopped"))
            EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
        const auto again = train("stopped", more);
        ASSERT_EQ(again.exit, 0) << again.output;
        EXPECT_NE(again.output.find("going on after"), std::string::npos) << again.output;
        EXPECT_EQ(read_file(dir / "whole/weights-last.h5"), read_file(dir / "stopped/weights-last.h5"));
        fs::remove_all(dir / "stopped");
    }
}

TEST_F(TrainGenerator, FlippedBytesInWeightsAndCheckpointsAreNoticed) {
    ASSERT_EQ(train("run", "epochs=2").exit, 0);
    flip_and_read("generator's weights", dir / "run/weights-last.h5", flips_to_make(2), {"weights-last.h5"},
                  [&] {
                      return outcome_of("",
                                        "generate --generator " + at("run/weights-last.h5") +
                                            " --per-class 1 --frames 8 -o " + at("m.h5"),
                                        dir / "m.h5");
                  });
    const auto checkpoint = dir / "run" / newest(dir / "run");
    flip_and_read("checkpoint", checkpoint, flips_to_make(2), {"checkpoint-"}, [&] {
        auto outcome = outcome_of("", line("run", "epochs=2"), dir / "run/weights-last.h5");
        outcome.anew = fs::remove(checkpoint.string() + ".damaged");
        return outcome;
    });
}

TEST_F(TrainGenerator, FlippedBytesInLogsAndConfigurationsAreNoticed) {
    ASSERT_EQ(train("run", "epochs=2").exit, 0);
    const std::map<std::string, std::string> remarks{{"log.jsonl", "log.jsonl: "}, {"config.yaml", ""}};
    for (const auto& [name, remark] : remarks) {
        flip_and_read("reported " + name, dir / "run" / name, flips_to_make(2), {name, "results.json"}, [&] {
            return outcome_of("", "report " + at("run") + " -o " + at("r.html"), dir / "r.html", remark);
        });
        flip_and_read("continued " + name, dir / "run" / name, flips_to_make(2), {name}, [&] {
            return outcome_of("", line("run", "epochs=2"), dir / "run/weights-last.h5", remark);
        });
    }
}

// Containers with CUDA often have no OpenCL.
TEST_F(TrainGenerator, WithoutOpenClTheProcessorDrawsTheSameWindows) {
    ASSERT_EQ(train("usual").exit, 0);
    const auto weights = read_file(dir / "usual/weights-last.h5");
    const auto none = train("none", "opencl=none");
    ASSERT_EQ(none.exit, 0) << none.output;
    const auto last = newest(dir / "usual");
    expect_same_checkpoint(dir / "usual" / last, dir / "none" / last);
    const auto no_driver = run_command("OCL_ICD_VENDORS=/nowhere " + program() + " " + line("no-driver"));
    ASSERT_EQ(no_driver.exit, 0) << no_driver.output;
    EXPECT_NE(no_driver.output.find("no OpenCL device: the processor draws the windows"), std::string::npos)
        << no_driver.output;
    EXPECT_TRUE(read_file(dir / "no-driver/weights-last.h5") == weights) << "other weights";
    const auto judged = train("judged", "opencl=none " + recogniser());
    EXPECT_EQ(judged.exit, 1);
    EXPECT_NE(judged.output.find("scores are computed in OpenCL"), std::string::npos) << judged.output;
}

TEST_F(TrainGenerator, RatesDropAtTheEpochsNamed) {
    // Powers of two: a quarter of four times a rate is the rate, to the bit.
    const std::string high = "generator_rate=0.0009765625 discriminator_rate=0.0009765625 epochs=2 ",
                      low = "generator_rate=0.000244140625 discriminator_rate=0.000244140625 epochs=2 ";
    ASSERT_EQ(train("low", low).exit, 0);
    ASSERT_EQ(train("dropped", high + "rate_drops=[0] rate_factor=0.25").exit, 0);
    ASSERT_EQ(train("later", high + "rate_drops=[1] rate_factor=0.25").exit, 0);
    const auto numbers = [&](const std::string& run) { return numbers_of(dir / run / newest(dir / run)); };
    EXPECT_EQ(numbers("low"), numbers("dropped"));
    EXPECT_NE(numbers("low"), numbers("later")) << "its first epoch goes at the higher rate";
}

TEST_F(TrainGenerator, LogsLossesAndScoresAndKeepsTheBest) {
    const auto result =
        train("run", "epochs=3 score_every=1 score_per_class=4 --json " + recogniser() + " 2>/dev/null");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output);
    // 36 clips in batches of 6, four discriminator's steps a step: an epoch takes two.
    EXPECT_EQ(json.at("steps"), 6);
    EXPECT_EQ(json.at("last").at("step"), 6);
    double best = 1e300;
    std::size_t scored = 0;
    for (const auto& entry : log_of(dir / "run"))
        if (entry.contains("fid_whole")) {
            best = std::min(best, entry.at("fid_whole").get<double>());
            ++scored;
        } else {
            EXPECT_TRUE(std::isfinite(entry.at("discriminator_loss").get<double>()));
            EXPECT_EQ(entry.at("step"), 2 * entry.at("epoch").get<int>());
        }
    EXPECT_EQ(scored, 3U);
    EXPECT_EQ(json.at("best").at("fid_whole"), best);
    EXPECT_EQ(Reader(dir / "run/weights-best.h5").attribute_texts("step")[0],
              std::to_string(json.at("best").at("step").get<int>()));
    const auto again =
        train("run", "epochs=3 score_every=1 score_per_class=4 --json " + recogniser() + " 2>/dev/null");
    EXPECT_EQ(again.output, result.output) << "a finished training tells the same again";
}

TEST_F(TrainGenerator, BestWeightsAreThoseOfScoresAlike) {
    const auto more = "score_every=1 --json " + recogniser() + " ";
    ASSERT_EQ(train("run", more + "epochs=2 score_per_class=4").exit, 0);
    auto checkpoint = *model::newest_checkpoint(dir / "run", "actformer", [](const std::string&) {});
    checkpoint.state.at("best").at("merit") = 1e9;  // no later score is better
    model::save_checkpoint(dir / "run", checkpoint);
    const auto best_step = [&](const std::string& keys) {
        const auto result = train("run", more + keys + " 2>/dev/null");
        EXPECT_EQ(result.exit, 0) << result.output;
        return nlohmann::json::parse(result.output).at("best").at("step").get<int>();
    };
    EXPECT_LE(best_step("epochs=3 score_per_class=4"), 4);
    EXPECT_LE(best_step("epochs=3 score_per_class=8"), 4) << "nothing is left to train: the scores stay";
    EXPECT_EQ(best_step("epochs=4 score_per_class=8"), 8) << "scores of fewer motions are others";
}

TEST_F(TrainGenerator, BestWeightsOutliveEpochsThatNothingScores) {
    const auto scored = "score_every=1 score_per_class=4 " + recogniser() + " ";
    ASSERT_EQ(train("run", scored + "epochs=1").exit, 0);
    const auto state = [&] {
        return model::newest_checkpoint(dir / "run", "actformer", [](const std::string&) {})->state;
    };
    const auto before = state();
    const auto unscored = train("run", "epochs=2");
    ASSERT_EQ(unscored.exit, 0) << unscored.output;
    for (const auto* line : {"weights-best.h5 is of epoch 1 and stays: nothing scores later ones\n",
                             "weights-best.h5: after epoch 1: "})
        EXPECT_NE(unscored.output.find(line), std::string::npos) << unscored.output;
    for (const auto* key : {"best", "last", "scorer"}) EXPECT_EQ(state().at(key), before.at(key)) << key;
}

TEST_F(TrainGenerator, ARecogniserOfTheCommonJointsScores) {
    const auto graph = eval::recogniser_graph(ingest::common15().parents);
    eval::write_stgcn_weights(dir / "common.h5", eval::random_stgcn_weights(6, 26, graph, 0.125, 5));
    const auto result = run_actformer(
        "train generator -c " + at("toy.yaml") + " --data " + toy_pairs().string() + " -o " + at("run") +
        " epochs=1 train_split=all score_per_class=4 recogniser=" + at("common.h5"));
    EXPECT_EQ(result.exit, 0) << result.output;
    EXPECT_TRUE(fs::exists(dir / "run/weights-best.h5")) << result.output;
}

TEST_F(TrainGenerator, TwoProcessesAreOneWithTwiceTheBatch) {
    const auto port = std::to_string(20000 + ::getpid() % 20000);
    const auto of = [&](int rank) {
        return "env RANK=" + std::to_string(rank) + " WORLD_SIZE=2 LOCAL_RANK=" + std::to_string(rank) +
               " MASTER_ADDR=127.0.0.1 MASTER_PORT=" + port + " " + program() + " " +
               line("two", "batch=18 discriminator_steps=1 epochs=1 --data-parallel");
    };
    const auto two = run_command(of(1) + " & " + of(0) + "; wait $!");
    if (two.output.find("this build has no Gloo") != std::string::npos) GTEST_SKIP() << two.output;
    ASSERT_TRUE(fs::exists(dir / "two/weights-last.h5")) << two.output;
    const auto one = train("one", "batch=36 discriminator_steps=1 epochs=1");
    ASSERT_EQ(one.exit, 0) << one.output;

    const auto la = log_of(dir / "one"), lb = log_of(dir / "two");
    EXPECT_NEAR(la[0].at("discriminator_loss"), lb[0].at("discriminator_loss"), 2e-6);
    EXPECT_NEAR(la[0].at("generator_loss"), lb[0].at("generator_loss"), 1e-4);
    // A first step of Adam moves every weight by the rate, 2e-4, in its gradient's direction. A few gradients are mere
    // rounding, and their weights go either way; all others must agree.
    const Reader a(dir / "one/weights-last.h5"), b(dir / "two/weights-last.h5");
    std::size_t all = 0, apart = 0;
    for (const auto& name : a.names()) {
        const auto x = a.read<float>(name), y = b.read<float>(name);
        for (std::size_t i = 0; i < x.size(); ++i, ++all) {
            ASSERT_NEAR(x[i], y[i], 4.1e-4) << name;
            apart += std::abs(x[i] - y[i]) > 1e-6F * (1 + std::abs(x[i]));
        }
    }
    EXPECT_LT(static_cast<double>(apart), 0.01 * static_cast<double>(all));
    expect_refused(train("two", "batch=18 discriminator_steps=1"), {"by 2 processes", "another -o"});
}

TEST_F(TrainGenerator, SaysWhatItTrainsOn) {
    const auto result = train("run", "epochs=1 batch=20 discriminator_steps=1");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_NE(
        result.output.find("trains on split s/train: 36 clips, 40 windows an epoch; no recogniser scores "
                           "it, so no accuracy and no new weights-best.h5 (recogniser=RUN names one)\n"),
        std::string::npos)
        << result.output;
}

TEST_F(TrainGenerator, KeepsARunToItsSettingsItsDataAndOneTraining) {
    ASSERT_EQ(train("run", "epochs=1").exit, 0);
    expect_refused(train("run", "width=8"), {"other settings", "width is 16 there and 8 here", "another -o"});
    EXPECT_EQ(train("run", "epochs=2").exit, 0);
    EXPECT_NE(train("run", "epochs=2").output.find("all 2 epochs are done: nothing is left to train"),
              std::string::npos);
    EXPECT_NE(train("run", "epochs=1").output.find("2 epochs are done, more than epochs=1"),
              std::string::npos);
    write_file(at("csgn.yaml"), "model: csgn\n");
    expect_refused(run_actformer("train generator -c " + at("csgn.yaml") + " --data " + toy_pairs().string() +
                                 " -o " + at("run")),
                   {"run: holds a training of 'actformer', not of 'csgn'", "another -o"});
    const int lock = ::open(at("run/lock").c_str(), O_RDWR);
    ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
    expect_refused(train("run"), {"another training", "another -o"});
    ::close(lock);
    expect_refused(run_actformer("train generator -c " + at("toy.yaml") + " --data " + toy_pairs().string() +
                                 " -o " + at("run") + " epochs=2 train_split=all"),
                   {"other settings", "train_split"});
    ASSERT_EQ(train("all", "epochs=1 train_split=all").exit, 0);
    expect_refused(run_actformer("train generator -c " + at("toy.yaml") + " --data " + toy_pairs().string() +
                                 " -o " + at("all") + " train_split=all"),
                   {"clips of 1 person", "ntu-2p", "another -o"});
    auto checkpoint = *model::newest_checkpoint(dir / "all", "actformer", [](const std::string&) {});
    checkpoint.state["dataset"] = "of clips that have changed since";
    model::save_checkpoint(dir / "all", checkpoint);
    expect_refused(train("all", "epochs=1 train_split=all"),
                   {"on other data than " + toy().string(), "another -o"});
}

TEST_F(TrainGenerator, RefusesACheckpointWithoutTheProgressThatItNeeds) {
    ASSERT_EQ(train("run", "epochs=1").exit, 0);
    auto checkpoint = *model::newest_checkpoint(dir / "run", "actformer", [](const std::string&) {});
    checkpoint.state["sums"] = {1, 2};
    model::save_checkpoint(dir / "run", checkpoint);
    expect_refused(train("run", "epochs=2"), {newest(dir / "run"), "2 sums of losses", "another -o"});
    checkpoint.state.erase("sums");
    model::save_checkpoint(dir / "run", checkpoint);
    expect_refused(train("run", "epochs=2"),
                   {newest(dir / "run"), "damaged, or made by another version", "another -o"});
}

TEST_F(TrainGenerator, GoesBackBehindDamagedCheckpointsAndRefusesForeignOnes) {
    ASSERT_EQ(train("run", "epochs=2").exit, 0);
    const auto weights = read_file(dir / "run/weights-last.h5");
    const auto last = newest(dir / "run");
    fs::resize_file(dir / "run" / last, 3000);
    const auto again = train("run", "epochs=2");
    EXPECT_EQ(again.exit, 0) << again.output;
    EXPECT_NE(again.output.find(last + ": cut short or damaged; going back to the one before"),
              std::string::npos)
        << again.output;
    EXPECT_EQ(read_file(dir / "run/weights-last.h5"), weights);
    EXPECT_TRUE(fs::exists(dir / "run" / (last + ".damaged")));

    write_file(dir / "run/checkpoint-99999", "actformer checkpoint 2\nof an earlier version");
    const auto past = train("run", "epochs=2");
    EXPECT_EQ(past.exit, 0) << past.output;
    EXPECT_NE(past.output.find("checkpoint-99999: of another version; going back to"), std::string::npos)
        << past.output;
    EXPECT_EQ(read_file(dir / "run/weights-last.h5"), weights);

    std::vector<fs::path> whole;
    for (const auto& entry : fs::directory_iterator(dir / "run"))
        if (entry.path().filename().string().starts_with("checkpoint-") && entry.path().extension() == ".h5")
            whole.push_back(entry.path());
    for (const auto& checkpoint : whole) fs::remove(checkpoint);
    expect_refused(train("run", "epochs=2"), {"checkpoint-99999", "an earlier version", "another -o"});
}

TEST_F(TrainGenerator, StopsWhereLossesAreNotFinite) {
    ASSERT_EQ(train("run", "epochs=1").exit, 0);
    const auto good = newest(dir / "run");
    auto checkpoint = *model::newest_checkpoint(dir / "run", "actformer", [](const std::string&) {});
    checkpoint.step += 1;
    std::get<std::vector<float>>(checkpoint.arrays[0].values)[0] = std::nanf("");
    model::save_checkpoint(dir / "run", checkpoint);
    const auto bad = newest(dir / "run");
    ASSERT_NE(good, bad);
    expect_refused(train("run", "epochs=4"),
                   {"stopped at step 4", "NaN or infinite", "checkpoint of step 3 is kept"});
    EXPECT_EQ(newest(dir / "run"), bad);
    EXPECT_TRUE(fs::exists(dir / "run" / good));
}

TEST_F(TrainGenerator, StopsWhereTheDiscriminatorIsCertain) {
    // A generator that stands still against a discriminator that hurries.
    const auto result = train("run", "generator_rate=0 discriminator_rate=0.02 epochs=2000 d_width=4");
    expect_refused(result, {"stopped at step", "for certain", "kept"});
}

TEST_F(TrainGenerator, GoesOnWhereADiskIsFull) {
    // A limit on the size of its files, set when it has begun, stands for a full disk: checkpoints are larger, log lines
    // smaller.
    const Child child(line("run", "epochs=100000 width=64"), at("output"));
    const auto wait_for = [&](const auto& there) {
        for (int i = 0; i < 30000 && !there(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_TRUE(there()) << read_file(at("output"));
    };
    wait_for([&] { return fs::exists(dir / "run/log.jsonl"); });
    const rlimit small{1 << 17, 1 << 17};
    ASSERT_EQ(::prlimit(child.pid(), RLIMIT_FSIZE, &small, nullptr), 0);
    wait_for([&] { return read_file(at("output")).find("training goes on") != std::string::npos; });
    const auto checkpoint = newest(dir / "run");
    const auto logged = fs::file_size(dir / "run/log.jsonl");
    wait_for([&] { return fs::file_size(dir / "run/log.jsonl") > logged; });
    EXPECT_EQ(newest(dir / "run"), checkpoint);
    EXPECT_NE(read_file(at("output")).find("cannot be written"), std::string::npos)
        << read_file(at("output"));
    wait_for([&] {  // one may be about to fail
        return std::ranges::none_of(fs::directory_iterator(dir / "run"), [](const auto& entry) {
            return entry.path().string().find("partial") != std::string::npos;
        });
    });
}

TEST_F(TrainGenerator, LosesNoLineOfItsLogWhereADiskIsFull) {
    const std::string more = "score_every=2 score_per_class=2 " + recogniser();
    const auto failing = [&](const std::string& run, const std::string& calls) {
        return run_command("LD_PRELOAD=" + failing_calls() + " FAIL_BELOW=" + at(run + "/log.jsonl") + " " +
                           calls + " " + program() + " " + line(run, more));
    };
    const auto epochs_in = [&](const std::string& run) {
        std::vector<int> epochs;
        for (const auto& one : log_of(dir / run)) epochs.push_back(one.at("epoch"));
        return epochs;
    };
    ASSERT_EQ(train("whole", more).exit, 0);
    const auto epochs = epochs_in("whole");
    EXPECT_EQ(std::set(epochs.begin(), epochs.end()), (std::set{1, 2, 3, 4}));
    for (const auto* call : {"FAIL_AT=1", "FAIL_AT=2", "FAIL_AT=3"}) {  // to open, to write, to close
        const auto once = failing("once", call);
        EXPECT_EQ(once.exit, 0) << once.output;
        EXPECT_NE(once.output.find("log.jsonl: cannot be written: "), std::string::npos) << once.output;
        EXPECT_EQ(epochs_in("once"), epochs) << call;
        fs::remove_all(dir / "once");
    }
    expect_refused(failing("full", "FAIL_AT=4 FAIL_ON=1"), {"full/log.jsonl: cannot be written: "});
    const auto again = train("full", more);
    ASSERT_EQ(again.exit, 0) << again.output;
    EXPECT_EQ(epochs_in("full"), epochs);
    EXPECT_EQ(read_file(dir / "full/weights-last.h5"), read_file(dir / "whole/weights-last.h5"));
}

TEST_F(TrainGenerator, OpensNoLogThatIsALinkAndTellsOfADamagedOne) {
    ASSERT_EQ(train("run", "epochs=3").exit, 0);
    auto text = read_file(dir / "run/log.jsonl");
    const auto at_digit = text.find("\"step\":4") + 7;
    text[at_digit] = '5';
    write_file(dir / "run/log.jsonl", text);
    const auto told = train("run", "epochs=4");
    EXPECT_EQ(told.exit, 0) << told.output;
    EXPECT_NE(told.output.find("run/log.jsonl: line 2: damaged, and left out"), std::string::npos)
        << told.output;
    EXPECT_EQ(log_of(dir / "run").size(), 3U);
    fs::remove(dir / "run/log.jsonl");
    for (const auto* target : {"/dev/full", "/dev/zero"}) {
        fs::create_symlink(target, dir / "run/log.jsonl");
        expect_refused(run_command("timeout 60 " + program() + " " + line("run", "epochs=5")),
                       {"run/log.jsonl: a symbolic link", "regular file"});
        fs::remove(dir / "run/log.jsonl");
    }
}

TEST_F(TrainGenerator, RefusesWhatCannotBeTrained) {
    expect_refused(train("r", "heads=3"), {"heads: 3", "width: 16"});
    for (const auto* kind : {"generator", "recogniser"})
        expect_refused(run_actformer("train " + std::string(kind) + " -c " + dir.path().string() +
                                     " --data " + toy().string() + " -o " + at("r")),
                       {dir.path().string() + ": not a file", ".yaml"});
    expect_refused(train("r", "frames=8"), {"frames", "16"});
    expect_refused(train("r", "train_split=s/none"), {"split s/none holds no clip"});
    expect_refused(train("r", "persons=2"), {"1 person", "persons: 2"});
    expect_refused(train("r", "classes=94"), {"3 classes", "classes: 94"});
    expect_refused(train("r", "loss=mse"), {"loss", "wasserstein, hinge"});
    expect_refused(train("r", "body=graphcnov"), {"body", "transformer, graphconv"});
    expect_refused(train("r", "genrator_rate=1"), {"did you mean 'generator_rate'"});
    expect_refused(train("r", "device=cuda:7"), {"device cuda:7"});
    expect_refused(train("r", "bf16=true"), {"bf16", "CUDA"});
    expect_refused(train("r", "tf32=true"), {"tf32", "CUDA"});
    expect_refused(train("r", "recogniser=" + at("toy.yaml")), {"toy.yaml"});
    expect_refused(train("r", "--data-parallel"), {"--data-parallel", "torchrun", "mpirun", "srun"});
    EXPECT_FALSE(fs::exists(dir / "r"));
}

namespace {

struct Generate : TrainGenerator {
    void SetUp() override {
        TrainGenerator::SetUp();
        ASSERT_EQ(train("run", "epochs=1").exit, 0);
    }
    CommandResult generate(const std::string& more, const std::string& out = "m.h5") const {
        return run_actformer("generate --generator " + at("run") + " -o " + at(out) + " " + more);
    }
};

}  // namespace

TEST_F(Generate, GivesTheSameMotionsWhateverElseIsAskedFor) {
    ASSERT_EQ(generate("--per-class 30 --seed 7").exit, 0);
    ASSERT_EQ(generate("--per-class 30 --seed 7", "again.h5").exit, 0);
    EXPECT_EQ(read_file(dir / "m.h5"), read_file(dir / "again.h5"));
    ASSERT_EQ(generate("--per-class 27 --classes 2 --seed 7", "few.h5").exit, 0);
    ASSERT_EQ(generate("--per-class 2 --seed 8", "other.h5").exit, 0);
    const Reader all(dir / "m.h5"), few(dir / "few.h5"), other(dir / "other.h5");
    EXPECT_EQ(all.names().size(), 90U);
    ASSERT_EQ(few.names().size(), 27U);
    for (const auto& name : few.names()) EXPECT_EQ(all.read<float>(name), few.read<float>(name)) << name;
    EXPECT_NE(all.read<float>("A001_0"), other.read<float>("A001_0"));
    EXPECT_NE(all.read<float>("A001_0"), all.read<float>("A001_1"));
    EXPECT_EQ(all.shape("A003_29"), (hdf5::Shape{3, 7, 16}));
}

TEST_F(Generate, CarriesWhatItTakesToDraw) {
    ASSERT_EQ(generate("--per-class 2 --frames 12").exit, 0);
    const ingest::MotionsFile file(dir / "m.h5");
    const ingest::Dataset dataset(toy());
    ASSERT_TRUE(file.subjects());
    EXPECT_EQ(*file.subjects(), ingest::subjects_of(dataset));
    EXPECT_EQ(file.read("A002_1").frames, 12U);
    const Reader reader(dir / "m.h5");
    EXPECT_EQ(reader.attribute_texts("seed")[0], "0");
    EXPECT_NE(reader.attribute_texts("configuration")[0].find("width: 16"), std::string::npos);
    const auto drawn = run_actformer("render " + at("m.h5") + " --per-class 2 --size 60 -o " + at("m.png"));
    EXPECT_EQ(drawn.exit, 0) << drawn.output;
    EXPECT_NE(drawn.output.find("6 motions"), std::string::npos) << drawn.output;
}

TEST_F(Generate, RefusesWhatItCannotMake) {
    expect_refused(generate("--classes 1,4"), {"no class 4", "1 to 3 ('c0' .. 'c2')"});
    expect_refused(generate("--classes 0"), {"no class 0"});
    expect_refused(generate("--classes 2,2"), {"2 is given twice"});
    expect_refused(generate("--classes c1,2"), {"2 is given twice"});
    expect_refused(generate("--classes c9"), {"no class 'c9'", "did you mean 'c"});
    expect_refused(generate("--frames 17"), {"--frames 17", "at most 16"});
    EXPECT_FALSE(fs::exists(dir / "m.h5"));
    EXPECT_FALSE(fs::exists(dir / "m.h5.partial"));
    const auto with = [&](const std::string& weights) {
        return run_actformer("generate --generator " + at(weights) + " -o " + at("m.h5"));
    };
    expect_refused(with("nowhere"), {"nowhere: no such file"});
    write_file(dir / "empty/x", "");
    expect_refused(with("empty"), {"empty: holds no weights", "training"});
    write_file(dir / "text.h5", "no HDF5");
    expect_refused(with("text.h5"), {"text.h5: not an HDF5 file"});
    recogniser();
    expect_refused(with("recogniser.h5"), {"recogniser.h5: not the weights of a generator"});
    auto bytes = read_file(dir / "run/weights-last.h5");
    write_file(dir / "cut.h5", bytes.substr(0, 20000));
    expect_refused(with("cut.h5"), {"cut.h5"});
}

namespace {

/// Trains in this process, and gives the last epoch.
model::EpochReport trained(const fs::path& data, const fs::path& run, const std::vector<std::string>& keys) {
    auto config = model::generator_config(model::methods().front());
    config.load_text(tiny_generator, "tiny");
    config.override_with("data=" + data.string());
    config.override_with("checkpoint_minutes=10");
    for (const auto& key : keys) config.override_with(key);
    model::EpochReport last;
    model::TrainingEvents events;
    events.epoch = [&](const model::EpochReport& epoch) { last = epoch; };
    const auto result = model::train_generator(config, run, false, events);
    EXPECT_EQ(result.steps, last.step);
    return last;
}

struct Switch {
    bool pairs;
    std::vector<std::string> keys;
};

std::ostream& operator<<(std::ostream& out, const Switch& s) {
    out << (s.pairs ? "pairs" : "single");
    for (const auto& key : s.keys) out << ' ' << key;
    return out;
}

struct EverySwitch : testing::TestWithParam<Switch> {};

}  // namespace

TEST_P(EverySwitch, Trains) {
    TempDir dir;
    auto keys = GetParam().keys;
    keys.push_back("epochs=100");
    if (GetParam().pairs) {
        keys.push_back("train_split=all");
        keys.push_back("batch=4");
    }
    const auto last = trained(GetParam().pairs ? toy_pairs() : toy(), dir / "run", keys);
    EXPECT_GE(last.step, 100U);
    const auto of = [&](const char* key) { return model::value_of(last.losses, key); };
    EXPECT_TRUE(std::isfinite(of("discriminator_loss")) && std::isfinite(of("generator_loss")));
    EXPECT_NE(of("real_score"), of("fake_score"));
}

INSTANTIATE_TEST_SUITE_P(
    Generators, EverySwitch,
    testing::Values(Switch{false, {}}, Switch{false, {"loss=wasserstein"}}, Switch{false, {"prior=gaussian"}},
                    Switch{false, {"pe=concat"}}, Switch{false, {"body=graphconv"}},
                    Switch{true, {"pe=tiled"}}, Switch{true, {"pe=concat"}}, Switch{true, {"pe=independent"}},
                    Switch{true, {"pe=fixed"}}, Switch{true, {"shared_z=false"}},
                    Switch{true, {"interaction=concat"}}, Switch{true, {"body=graphconv", "average=0.9"}},
                    Switch{true, {"d_persons=avgpool"}}, Switch{true, {"d_persons=maxpool"}},
                    Switch{true, {"d_persons=selfatt"}}));
