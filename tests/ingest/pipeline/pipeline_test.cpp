// The pipeline through a format made for it: files of many clips, a survey, classes that nobody has.
#include "ingest/pipeline/pipeline.hpp"
#include "ingest/formats/parsed.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "ingest/formats/parsed.hpp"
#include "tests/support/command.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/flips.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t mib = std::size_t{1} << 20;

std::atomic<std::int64_t> alive{0}, most_alive{0};

struct LineClip : RawClip {
    LineClip() { most_alive = std::max(most_alive.load(), ++alive); }
    ~LineClip() override { --alive; }
    std::size_t bytes() const override { return mib; }  // so it says, that a file of many has to wait
    float x = 0;
};

/// A line "NAME CLASS X" is a clip of two frames of two joints; "!WHY" is a bad one, "?NAME CLASS X" one in doubt; "stop" throws,
/// and after "broken" the file cannot be read.
class LineFormat : public Format {
  public:
    explicit LineFormat(Survey how = Survey::texts) : how_(how) {}
    std::vector<std::string_view> extensions() const override { return {".lines", ".txt"}; }
    Survey surveys() const override { return how_; }
    void survey(const RawText& raw) override {
        const std::lock_guard lock(mutex_);
        seen.insert(std::string(raw.inside) + "=" + std::string(raw.text));
    }
    void settle() override {
        DatasetHeader header;
        header.name = "lines";
        header.topology = {{"a", "b"}, {-1, 0}};
        header.classes = {"c0", "c1", "c2", "c3"};
        datasets_ = {header};
    }
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    bool surveys_text_of(const RawText& raw) const override { return raw.stem != "by_name"; }
    bool drops_empty_classes() const override { return drops; }
    std::string settings() const override { return "lines"; }
    std::vector<std::string> remarks() const override {
        return {fmt::format("{} files surveyed", seen.size())};
    }
    std::optional<Rejection> refuse(const RawText& raw) const override {
        if (raw.stem != "refused") return {};
        return Rejection{Rejection::Kind::dropped, "not this one"};
    }
    void read(const RawText& raw, ClipSink& sink) const override {
        std::istringstream lines{std::string(raw.text)};
        int number = 0;
        for (std::string line; std::getline(lines, line);) {
            ++number;
            if (line == "stop" && stops) throw std::runtime_error("stopped");
            if (line == "broken") throw Error("{}: line {}: broken", raw.path, number);
            if (lines) raw.release(raw.text.data() + lines.tellg());
            if (line.starts_with("!")) {
                sink.take(
                    Rejection{Rejection::Kind::broken, fmt::format("line {}: {}", number, line.substr(1))});
                continue;
            }
            if (line == "stop") continue;
            auto clip = std::make_unique<LineClip>();
            if (line.starts_with("?")) clip->doubts = {"odd: --even mends it"};
            std::istringstream words(line.substr(line.starts_with("?")));
            words >> clip->name >> clip->label >> clip->x;
            sink.take(std::move(clip));
        }
    }
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override {
        kernels::ClipBatch batch;
        batch.joints = 2;
        batch.first = {0};
        auto limbs = kernels::limb_buffer(device, clips.size() * 2, 2);
        limbs.write_with([&](std::span<float> to) {
            for (std::size_t i = 0; i < clips.size(); ++i) {
                const float x = static_cast<const LineClip&>(*clips[i]).x;
                const float one[] = {0, 0, 0, x, 0, 0, 0, 0, 0, 0, x, 0};
                std::copy(std::begin(one), std::end(one), to.begin() + 12 * i);
            }
        });
        for (std::size_t i = 0; i < clips.size(); ++i) {
            batch.frames.push_back(2);
            batch.step.push_back(1);
            batch.times.insert(batch.times.end(), {0, 1});
            batch.first.push_back(batch.first.back() + 2);
        }
        frames = batch.frames;
        return kernels::clean(device, batch, limbs, {0, 0});
    }

    std::set<std::string> seen;
    bool drops = false;
    bool stops = false;

  private:
    Survey how_;
    std::mutex mutex_;
    std::vector<DatasetHeader> datasets_;
};

/// A file's clips are made together; what made them is noted. Whoever makes one waits, for a minute at most, until so many threads do.
class TogetherFormat : public LineFormat {
  public:
    explicit TogetherFormat(std::size_t wanted) : wanted_(wanted) {}

    void read(const RawText& raw, ClipSink& sink) const override {
        LineFormat::read(raw, sink);
        make_in_order(
            64, sink, [](std::size_t) { return std::size_t{1}; },
            [&](std::size_t i) {
                std::unique_lock lock(noting_);
                threads.insert(std::this_thread::get_id());
                met_.notify_all();
                const auto all_met = [&] { return threads.size() >= wanted_ || gave_up_; };
                gave_up_ = !met_.wait_for(lock, std::chrono::minutes(1), all_met) || gave_up_;
                return Rejection{Rejection::Kind::dropped, fmt::format("clip {}", i)};
            },
            [](std::size_t) {});
    }
    mutable std::set<std::thread::id> threads;

  private:
    std::size_t wanted_;
    mutable std::mutex noting_;
    mutable std::condition_variable met_;
    mutable bool gave_up_ = false;
};

/// The first shard is not written, for which its settings are asked, until a file's reading has failed.
class LateFormat : public LineFormat {
  public:
    void read(const RawText& raw, ClipSink& sink) const override {
        reading_ = true;
        try {
            LineFormat::read(raw, sink);
        } catch (...) {
            failed_ = true;
            failed_.notify_all();
            throw;
        }
    }
    std::string settings() const override {
        if (reading_) failed_.wait(false);
        return LineFormat::settings();
    }

  private:
    mutable std::atomic<bool> reading_ = false, failed_ = false;
};

/// Takes what an ingest makes for raw files.
class GreedyFormat : public LineFormat {
  public:
    std::vector<std::string_view> extensions() const override { return {".lines", ".h5", ".json", ".csv"}; }
};

/// A file is made where the dataset is to be put, once its clips are done.
class HinderedFormat : public LineFormat {
  public:
    explicit HinderedFormat(fs::path file) : file_(std::move(file)) {}
    std::vector<std::string> remarks() const override {
        write_file(file_, "in the way");
        return LineFormat::remarks();
    }

  private:
    fs::path file_;
};

struct PipelineOnDevice : testing::Test {
    IngestSummary run(LineFormat& format, const char* out = "out", unsigned threads = 3) {
        IngestRequest request;
        request.raw = {raw};
        request.out = dir / out;
        request.one_dataset = true;
        request.threads = threads;
        request.strict = strict;
        return ingest::ingest(request, format, device);
    }

    /// `count` clips of class 0 and 2 in turn.
    static std::string many(const std::string& prefix, int count) {
        std::string text;
        for (int i = 0; i < count; ++i) text += fmt::format("{}{} {} {}\n", prefix, i, i % 2 * 2, i % 7 + 1);
        return text;
    }

    /// An ingest of more than one tranche that stops in the second: the first is kept.
    void run_until_it_stops() {
        LineFormat stopped;
        run_until_it_stops(stopped);
    }
    void run_until_it_stops(LineFormat& stopped, const char* out = "out") {
        for (int i = 0; i < 5000; ++i)
            write_file(dir / fmt::format("raw/{:04}.lines", i), fmt::format("n{} 1 2\n", i));
        write_file(dir / "raw/z.lines", many("z", 300) + "stop\n" + many("y", 20));
        stopped.stops = true;
        EXPECT_THROW(run(stopped, out), Error);
    }

    /// Names and contents of all files below `folder`.
    static std::map<std::string, std::string> contents(const fs::path& folder) {
        std::map<std::string, std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.is_regular_file())
                out[fs::relative(entry.path(), folder).string()] = checksum(read_file(entry.path()));
        return out;
    }

    TempDir dir;
    fs::path raw = dir / "raw";
    kernels::Device device;
    bool strict = false;
};

}  // namespace

TEST_F(PipelineOnDevice, TakesManyClipsOfAFileInOrder) {
    write_file(dir / "raw/a.lines", "x 1 2\n!too short\n?y 2 3\n!too long\ny 0 1\n?z 3 4\n");
    write_file(dir / "raw/b/c.txt", "w 0 5\n");
    LineFormat format;
    const auto summary = run(format);
    const Dataset dataset(dir / "out");
    std::vector<std::string> names;
    std::vector<std::uint32_t> labels;
    for (const auto& clip : dataset.clips()) {
        names.push_back(clip.name);
        labels.push_back(clip.label);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "w"}));
    EXPECT_EQ(labels, (std::vector<std::uint32_t>{1, 2, 3, 0}));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(dataset.bone_length(i)[1], 2 + i, 1e-6);
    EXPECT_EQ(read_file(dir / "out/rejected.csv"),
              fmt::format("file,kind,reason\n{0},broken,line 2: too short\n{0},broken,line 4: too long\n"
                          "{0},duplicate,clip y: a clip of this name came before\n",
                          (dir / "raw/a.lines").string()));
    EXPECT_EQ(summary.left_out, (std::map<std::string, std::uint64_t>{{"broken", 2}, {"duplicate", 1}}));
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_EQ(summary.doubts[0].what, "odd: --even mends it");
    EXPECT_EQ(summary.doubts[0].clips, 2U);
    EXPECT_EQ(summary.doubts[0].first, (std::vector<std::string>{"y", "z"}));
    EXPECT_EQ(summary.remarks, std::vector<std::string>{"2 files surveyed"});
    const auto again = run(format);
    EXPECT_TRUE(again.was_complete);
    EXPECT_EQ(again.remarks, summary.remarks);
    EXPECT_EQ(again.doubts[0].clips, 2U);
}

TEST_F(PipelineOnDevice, IsMarkedWithTheChecksumsOfWholeFiles) {
    const std::string good = "x 1 2\ny 2 3\n", broken = "z 1 2\nbroken\nw 2 3\n", refused = "v 1 2\n";
    write_file(dir / "raw/broken.lines", broken);
    write_file(dir / "raw/good.lines", good);
    write_file(dir / "raw/refused.lines", refused);
    LineFormat format;
    const auto summary = run(format);
    const auto line = [](const std::string& name, const std::string& text) {
        return fmt::format("{} {} {}\n", name, text.size(), checksum(text));
    };
    const auto files =
        line("broken", broken) + line("good", good) + fmt::format("refused {} \n", refused.size());
    EXPECT_NE(read_file(dir / "out/dataset.json").find(checksum(files)), std::string::npos) << files;
    EXPECT_EQ(summary.text_bytes, good.size() + broken.size());
    EXPECT_EQ(read_file(dir / "out/rejected.csv"),
              fmt::format("file,kind,reason\n{},broken,line 2: broken\n{},dropped,not this one\n",
                          (dir / "raw/broken.lines").string(), (dir / "raw/refused.lines").string()));
}

TEST_F(PipelineOnDevice, HoldsFewClipsOfALargeFileAtOnce) {
    write_file(dir / "raw/large.lines", many("l", 2000));
    write_file(dir / "raw/small.lines", many("s", 3));
    write_file(dir / "raw/zlarge.lines", many("z", 500));
    most_alive = 0;
    LineFormat format;
    run(format);
    // 64 MiB wait to be cleaned; 6 portions of 16 MiB and one in hand behind them; a file and its successors fill up in the meantime.
    EXPECT_LT(most_alive, 64 + 8 * 17 + 3 * 17 + 17);
    EXPECT_EQ(alive, 0);
    LineFormat alone;
    run(alone, "alone", 1);
    EXPECT_EQ(contents(dir / "out"), contents(dir / "alone"));
    const Dataset dataset(dir / "out");
    ASSERT_EQ(dataset.clips().size(), 2503U);
    EXPECT_EQ(dataset.clips()[1999].name, "l1999");
    EXPECT_EQ(dataset.clips()[2000].name, "s0");
    EXPECT_TRUE(verify_dataset(dir / "out").faults.empty());
}

TEST_F(PipelineOnDevice, StopsInTheMiddleOfAFileAndComesToTheSameBytes) {
    run_until_it_stops();
    EXPECT_EQ(alive, 0);
    LineFormat whole, resumed;
    run(whole, "whole");
    EXPECT_EQ(run(resumed).resumed_files, 4096U);
    EXPECT_EQ(contents(dir / "out"), contents(dir / "whole"));
}

TEST_F(PipelineOnDevice, ItsOwnOutputIsNoRawData) {
    GreedyFormat stopped, whole, resumed, again;
    run_until_it_stops(stopped, "raw/out");
    ASSERT_TRUE(fs::exists(dir / "raw/out.partial/data/shard-00000.h5"));
    EXPECT_EQ(run(resumed, "raw/out").resumed_files, 4096U);
    EXPECT_TRUE(run(again, "raw/out").was_complete);
    const auto made = contents(dir / "raw/out");
    fs::remove_all(dir / "raw/out");
    run(whole, "whole");
    EXPECT_EQ(made, contents(dir / "whole"));
}

TEST_F(PipelineOnDevice, RawFilesInTheWayOfTheOutputAreRefused) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    LineFormat format;
    const auto why = error_of([&] { run(format, "raw"); });
    EXPECT_NE(why.find("raw: already there, and not from this command"), std::string::npos) << why;
}

TEST_F(PipelineOnDevice, WhatNoIngestMadeIsNotWorkedInNorRemoved) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    write_file(dir / "thesis/data/chapter", "precious");
    write_file(dir / "thesis/journal", "dear diary");
    const auto before = contents(dir / "thesis");
    fs::create_directory_symlink("thesis", dir / "link.partial");
    fs::copy(dir / "thesis", dir / "other.partial", fs::copy_options::recursive);
    fs::create_directory(dir / "there");
    fs::copy(dir / "thesis", dir / "there/.partial", fs::copy_options::recursive);
    LineFormat format;
    for (const auto& [out, named] : {std::pair{"link", "link.partial: a symbolic link"},
                                     {"other", "other.partial/data/chapter: "},
                                     {"there", "there/.partial/data/chapter: "}}) {
        const auto* const place = out;
        const auto why = error_of([&] { run(format, place); });
        EXPECT_NE(why.find(named), std::string::npos) << why;
        EXPECT_FALSE(fs::exists(dir / out / "dataset.json"));
    }
    EXPECT_EQ(contents(dir / "there/.partial"), before);
    for (const auto* out : {"link", "other"}) {
        const auto partial = std::string(out) + ".partial";
        fs::rename(dir / partial, dir / "kept");
        run(format, out);
        fs::rename(dir / "kept", dir / partial);
        EXPECT_TRUE(run(format, out).was_complete) << "what it worked in goes, and nothing else";
        EXPECT_EQ(contents(dir / partial), before);
    }
    EXPECT_EQ(contents(dir / "thesis"), before);
}

TEST_F(PipelineOnDevice, WhatSomebodyPutsWhereItWorksStays) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    HinderedFormat putting(dir / "out.partial/thesis");
    run(putting);
    EXPECT_TRUE(fs::exists(dir / "out/dataset.json"));
    EXPECT_EQ(read_file(dir / "out.partial/thesis"), "in the way");
}

TEST_F(PipelineOnDevice, WhatAnIngestLeftGoesWhenAllIsDone) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    LineFormat format;
    run(format);
    write_file(dir / "out.partial/journal", "left");
    write_file(dir / "out.partial/data/shard-00000.h5.partial", "left");
    EXPECT_TRUE(run(format).was_complete);
    EXPECT_FALSE(fs::exists(dir / "out.partial"));
}

TEST_F(PipelineOnDevice, WhatWaitsToBeWrittenWhenALaterFileFailsIsKept) {
    LateFormat late;
    run_until_it_stops(late);
    LineFormat resumed;
    EXPECT_EQ(run(resumed).resumed_files, 4096U);
}

TEST_F(PipelineOnDevice, WhatChangedBetweenAStopAndTheNextRunIsMadeAgainAndNamed) {
    run_until_it_stops();
    LineFormat whole;
    run(whole, "whole");
    fs::rename(dir / "out.partial", dir / "kept");
    const auto journal = read_file(dir / "kept/journal"), shard = read_file(dir / "kept/data/shard-00000.h5");
    const auto second = journal.find('\n') + 1;
    struct Damage {
        const char* file;
        std::string bytes;
        const char* said;
        std::uint64_t resumed;
    };
    auto flipped = shard;
    flipped[shard.size() / 2] ^= 4;
    const std::vector<Damage> damages{
        {"journal", journal, "", 4096},
        {"journal", journal.substr(0, journal.size() - 1), "", 0},  // cut short by the kill
        {"journal", replaced(journal, "\"files\":4096", "\"files\":4095"), "journal:2: damaged", 0},
        {"journal", replaced(journal, "\"names\"", "\"nomes\""), "journal:2: damaged", 0},
        {"journal", journal.substr(0, second) + "x" + journal.substr(second), "journal:2: damaged", 0},
        {"journal", "x" + journal, "journal: damaged, or of other settings", 0},
        {"journal", "", "", 0},
        {"data/shard-00000.h5", flipped, "shard-00000.h5: changed since it was written", 0},
        {"data/shard-00000.h5", shard.substr(1), "shard-00000.h5: missing, or of another size", 0}};
    for (const auto& damage : damages) {
        fs::remove_all(dir / "out");
        fs::copy(dir / "kept", dir / "out.partial", fs::copy_options::recursive);
        write_file(dir / "out.partial" / damage.file, damage.bytes);
        LineFormat resumed;
        const auto summary = run(resumed);
        EXPECT_EQ(summary.resumed_files, damage.resumed) << damage.said;
        EXPECT_EQ(contents(dir / "out"), contents(dir / "whole")) << damage.said;
        ASSERT_EQ(summary.made_again.size(), *damage.said ? 1U : 0U) << damage.said;
        if (summary.made_again.empty()) continue;
        EXPECT_NE(summary.made_again[0].find(damage.said), std::string::npos) << summary.made_again[0];
    }
}

TEST_F(PipelineOnDevice, FlippedBytesInWhatAStopLeftAreNoticed) {
    run_until_it_stops();
    fs::rename(dir / "out.partial", dir / "kept");
    for (const auto* file : {"journal", "data/shard-00000.h5"})
        flip_and_read(file, dir / "kept" / file, flips_to_make(2), {file}, [&]() -> FlipOutcome {
            fs::remove_all(dir / "out");
            fs::remove_all(dir / "out.partial");
            fs::copy(dir / "kept", dir / "out.partial", fs::copy_options::recursive);
            LineFormat resumed;
            try {
                const auto summary = run(resumed);
                std::string all;
                for (const auto& [name, sum] : contents(dir / "out")) all += name + " " + sum + "\n";
                return {{}, !summary.made_again.empty(), all};
            } catch (const std::exception& e) {
                return {std::string(e.what()) + "\n", false, {}};
            }
        });
}

TEST_F(PipelineOnDevice, FlippedBytesInTheListOfWhatWasBeingPutInPlaceAreNoticed) {
    run_until_it_stops();
    fs::rename(dir / "out.partial", dir / "kept");
    const std::string shard = "shard-00000.h5";
    write_file(dir / "kept/delivering", checksum('\0' + shard) + '\0' + shard);
    flip_and_read("delivering", dir / "kept/delivering", flips_to_make(2), {"delivering"},
                  [&]() -> FlipOutcome {
                      fs::remove_all(dir / "out");
                      fs::create_directory(dir / "out");
                      fs::copy(dir / "kept", dir / "out/.partial", fs::copy_options::recursive);
                      fs::rename(dir / "out/.partial/data" / shard, dir / "out" / shard);
                      LineFormat resumed;
                      try {
                          const auto summary = run(resumed);
                          std::string all;
                          for (const auto& [name, sum] : contents(dir / "out"))
                              all += name + " " + sum + "\n";
                          return {{}, !summary.made_again.empty(), all};
                      } catch (const Error& e) {
                          EXPECT_TRUE(fs::exists(dir / "out" / shard)) << "it stays";
                          return {std::string(e.what()) + "\n", false, {}};
                      }
                  });
}

TEST_F(PipelineOnDevice, ADamagedRecordOfAFinishedIngestIsNamed) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    LineFormat format, again;
    run(format);
    const auto path = dir / "out/ingest.json";
    const auto text = read_file(path);
    for (const auto& damaged :
         {replaced(text, "\"files\": 1", "\"files\": 2"), replaced(text, "files", "fils"),
          text.substr(0, text.size() / 2), std::string()}) {
        write_file(path, damaged);
        const auto why = error_of([&] { run(again); });
        EXPECT_NE(why.find("ingest.json: damaged"), std::string::npos) << why;
        EXPECT_NE(why.find("choose another -o"), std::string::npos) << why;
    }
    write_file(path, text);
    EXPECT_TRUE(run(again).was_complete);
}

TEST_F(PipelineOnDevice, AFifoIsSkippedByName) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    ASSERT_EQ(::mkfifo((dir / "raw/b.lines").c_str(), 0600), 0);
    LineFormat format;
    EXPECT_EQ(run(format).left_out, (std::map<std::string, std::uint64_t>{{"broken", 1}}));
    EXPECT_EQ(read_file(dir / "out/rejected.csv"),
              fmt::format("file,kind,reason\n{},broken,\"a FIFO, and no regular file\"\n",
                          (dir / "raw/b.lines").string()));
}

TEST_F(PipelineOnDevice, AnArchiveWithoutAFileOfTheFormatIsNamed) {
    write_file(dir / "other/notes.md", "nothing");
    ASSERT_EQ(run_command("cd " + (dir / "other").string() + " && tar -cf ../raw notes.md").exit, 0);
    LineFormat format;
    const auto why = error_of([&] { run(format); });
    EXPECT_NE(why.find((dir / "raw").string() + ": no .lines, .txt file in it"), std::string::npos) << why;
}

TEST_F(PipelineOnDevice, ArchivesAmongTheFilesAreToldOfWheneverItIsAskedFor) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    write_file(dir / "raw/b.tar.gz", "");
    LineFormat format;
    const std::string surveyed = "1 files surveyed";
    const std::vector<std::string> told{
        surveyed,
        fmt::format("1 archive in {} is not read (b.tar.gz): unless unpacked there, give it as RAW too",
                    (dir / "raw").string())};
    EXPECT_EQ(run(format).remarks, told);
    EXPECT_NE(read_file(dir / "out/ingest.json").find("(b.tar.gz)"), std::string::npos);
    const auto again = run(format);
    EXPECT_TRUE(again.was_complete);
    EXPECT_EQ(again.remarks, told);
    fs::remove(dir / "raw/b.tar.gz");
    EXPECT_EQ(run(format).remarks, std::vector<std::string>{surveyed});
}

TEST_F(PipelineOnDevice, OriginIsToldInRawAndBesideIt) {
    write_file(dir / "raw/ORIGIN", "stand-in\n");
    write_file(dir / "raw/part/a.lines", "x 1 2\n");
    write_file(dir / "raw/b.lines", "y 1 2\n");
    int made = 0;
    for (const char* given : {"raw", "raw/", "raw/part", "raw/part/", "raw/part/.", "raw/b.lines"}) {
        raw = dir / given;
        LineFormat format;
        const auto out = fmt::format("out{}", made++);
        run(format, out.c_str());
        EXPECT_EQ(Dataset(dir / out).header().origin.kind, DataOrigin::Kind::stand_in) << given;
    }
}

TEST_F(PipelineOnDevice, SurveysEveryFileBeforeTheFirstIsRead) {
    write_file(dir / "raw/a.lines", "x 1 2\n");
    write_file(dir / "raw/b/refused.lines", "y 1 2\n");
    write_file(dir / "raw/b/c.txt", "w 0 5\n");
    write_file(dir / "raw/by_name.txt", "v 0 5\n");
    fs::create_symlink(dir / "gone", dir / "raw/dangling.lines");
    LineFormat texts, names(Format::Survey::names), nothing(Format::Survey::nothing);
    EXPECT_EQ(run(texts).left_out, (std::map<std::string, std::uint64_t>{{"broken", 1}, {"dropped", 1}}));
    EXPECT_EQ(texts.seen, (std::set<std::string>{"a.lines=x 1 2\n", "b/c.txt=w 0 5\n", "by_name.txt="}));
    run(names, "names");
    EXPECT_EQ(names.seen, (std::set<std::string>{"a.lines=", "b/c.txt=", "by_name.txt=", "dangling.lines="}));
    run(nothing, "nothing");
    EXPECT_TRUE(nothing.seen.empty());
}

TEST_F(PipelineOnDevice, MakesAFilesClipsOnAsManyThreadsAsAskedFor) {
    write_file(dir / "raw/a.lines", "a 1 2\n");
    for (const unsigned threads : {1U, 3U}) {
        TogetherFormat format(threads);
        run(format, threads == 1 ? "one" : "three", threads);
        EXPECT_EQ(format.threads.size(), threads);
    }
}

TEST_F(PipelineOnDevice, StopsAtABrokenClipWhenStrict) {
    write_file(dir / "raw/a.lines", "x 1 2\n!too short\n");
    strict = true;
    LineFormat format;
    try {
        run(format);
        FAIL() << "went through";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("a.lines: line 2: too short (--strict"), std::string::npos)
            << e.what();
    }
    EXPECT_FALSE(fs::exists(dir / "out"));
}

TEST_F(PipelineOnDevice, StopsAtABrokenClipOfEarlierWorkWhenStrict) {
    write_file(dir / "raw/0.lines", "x 1 2\n!too short\n");
    run_until_it_stops();
    LineFormat format;
    const auto strictly = [&] {
        strict = true;
        const auto why = error_of([&] { run(format); });
        EXPECT_NE(why.find("0.lines: line 2: too short (--strict; without it"), std::string::npos) << why;
        strict = false;
    };
    strictly();
    EXPECT_EQ(run(format).resumed_files, 4096U) << "the finished part is kept";
    strictly();
    EXPECT_TRUE(run(format).was_complete);
}

TEST_F(PipelineOnDevice, DropsClassesThatNoClipHas) {
    write_file(dir / "raw/a.lines", "x 1 2\ny 3 2\nz 3 1\n");
    LineFormat kept, dropping;
    run(kept, "kept");
    EXPECT_EQ(Dataset(dir / "kept").header().classes.size(), 4U);
    dropping.drops = true;
    const auto summary = run(dropping);
    const Dataset dataset(dir / "out");
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"c1", "c3"}));
    EXPECT_EQ(dataset.clips()[0].label, 0U);
    EXPECT_EQ(dataset.clips()[1].label, 1U);
    EXPECT_EQ(dataset.clips()[2].label, 1U);
    EXPECT_TRUE(verify_dataset(dir / "out").faults.empty());
    ASSERT_EQ(summary.datasets.size(), 1U);
    EXPECT_EQ(summary.datasets[0].classes, 2U);
    ASSERT_EQ(summary.remarks.size(), 2U);
    EXPECT_EQ(summary.remarks[1], "no clip was left of c0, c2: they are not among the classes");
    EXPECT_EQ(Dataset(dir / "kept").motion(2).values, dataset.motion(2).values);
}

TEST_F(PipelineOnDevice, WorkIsKeptWhereItCannotBePutInPlaceThoughClassesWereDropped) {
    write_file(dir / "raw/a.lines", "x 1 2\ny 3 2\nz 3 1\n");
    LineFormat format;
    format.drops = true;
    run(format, "undisturbed");
    HinderedFormat hindered(dir / "out/in the way");
    hindered.drops = true;
    for (int time = 0; time < 2; ++time) {
        const auto why = error_of([&] { run(hindered); });
        EXPECT_NE(why.find("1 file done and kept"), std::string::npos) << why;
        fs::remove_all(dir / "out");
    }
    const auto summary = run(format);
    EXPECT_EQ(summary.resumed_files, 1U);
    EXPECT_EQ(summary.made_again, std::vector<std::string>());
    EXPECT_EQ(contents(dir / "out"), contents(dir / "undisturbed"));
}
