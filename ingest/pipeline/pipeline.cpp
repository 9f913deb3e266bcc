#include "ingest/pipeline/pipeline.hpp"

#include <chrono>
#include <set>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/printable.hpp"
#include "base/threads/parallel.hpp"
#include "base/threads/worker.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "ingest/dataset/shard.hpp"
#include "ingest/pipeline/groups.hpp"
#include "ingest/pipeline/journal.hpp"
#include "ingest/pipeline/parsers.hpp"
#include "ingest/pipeline/record.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t groups_at_once = 2;  // in memory as text
constexpr std::size_t groups_ahead = 6;    // parsed and waiting to be cleaned: enough to ride out a slow one

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class Ingest {
  public:
    Ingest(const IngestRequest& request, const Format& format, kernels::Device& device)
        : request_(request), format_(format), device_(device), threads_(thread_count(request.threads)) {
        for (const auto& header : format.datasets()) {
            shards_.emplace_back(header);
            shard_count_.push_back(0);
        }
    }

    IngestSummary run() {
        const auto start = Clock::now();
        Source source(request_.raw, format_.extension());
        summary_.seconds.walk = seconds_since(start);
        const auto wanted = request_line(source);
        const auto aside = fs::path(request_.out.string() + ".partial");
        if (fs::exists(request_.out) && !(fs::is_directory(request_.out) && fs::is_empty(request_.out))) {
            take_over_finished(wanted);
            std::error_code ignored;
            fs::remove_all(aside, ignored);
            return summary_;
        }
        Workplace workplace(aside, wanted);
        try {
            go_on_from(workplace, source);
            read_everything(workplace, source);
            finish(workplace, wanted);
        } catch (const std::exception& e) {
            if (workplace.finished().empty()) {
                workplace.discard();
                throw;
            }
            std::uint64_t kept = 0;
            for (const auto& tranche : workplace.finished()) kept += tranche.files;
            throw Error("{} ({} files are done and kept in {}; the same command goes on from there)",
                        e.what(), kept, aside.string());
        }
        summary_.seconds.wall = seconds_since(start);
        return summary_;
    }

  private:
    std::string request_line(const Source& source) const {
        Checksum missing;
        for (const auto& name : std::set<std::string>(request_.missing.begin(), request_.missing.end()))
            missing.add(name + "\n");
        return fmt::format("actformer {} | {} | raw {} | missing {}", ACTFORMER_VERSION, format_.settings(),
                           source.listing(), missing.hex());
    }

    fs::path folder_of(std::size_t dataset) const {
        return request_.one_dataset ? fs::path() : fs::path(format_.datasets()[dataset].name);
    }

    /// OUT exists: fine if this very request made it.
    void take_over_finished(const std::string& wanted) {
        if (!read_record(request_.out, checksum(wanted), summary_))
            throw Error("{}: already there, and not from this command; remove it or choose another -o",
                        request_.out.string());
    }

    void go_on_from(const Workplace& workplace, Source& source) {
        RawFile skipped;
        for (const auto& tranche : workplace.finished()) {
            count(tranche);
            for (std::uint64_t i = 0; i < tranche.files; ++i)
                if (!source.next_name(skipped))
                    throw Error("the raw files changed while they were read; remove {}.partial",
                                request_.out.string());
            for (const auto& name : tranche.names) names_.insert(name);
        }
        summary_.resumed_files = files_done_;
    }

    void count(const Tranche& tranche) {
        files_done_ += tranche.files;
        clips_done_ += tranche.names.size();
        fingerprint_ = tranche.fingerprint;
        for (const auto& [dataset, shard] : tranche.shards) ++shard_count_[dataset];
    }

    /// Parsing some groups, cleaning those before them and writing the tranche before that overlap.
    void read_everything(Workplace& workplace, Source& source) {
        Groups groups(source, static_cast<double>(source.bytes_total()));
        Worker writer(1), cleaner(groups_ahead);
        Parsers parsers(threads_, [this](Item& item, std::vector<char>& text) { parse(item, text); });
        const auto hand_on = [&] {
            cleaner.add([this, &workplace, &writer, g = parsers.take()]() mutable {
                clean(g);
                if (g.ends_tranche) commit(workplace, writer);
                if (request_.progress) request_.progress(g.fraction, clips_done_);
            });
        };
        for (;;) {
            Group group;
            const auto start = Clock::now();
            const bool any = groups.next(group);
            summary_.seconds.walk += seconds_since(start);
            if (!any) break;
            parsers.add(std::move(group));
            if (parsers.groups() == groups_at_once) hand_on();
        }
        while (parsers.groups() > 0) hand_on();
        cleaner.finish();
        writer.finish();
    }

    void parse(Item& item, std::vector<char>& scratch) const {
        if (request_.missing.contains(item.file.stem)) {
            item.clip = Rejection{Rejection::Kind::missing, "named in the missing list"};
            return;
        }
        const auto start = Clock::now();
        try {
            const auto text = item.file.text(scratch);
            item.file.size = text.size();
            item.read_seconds = seconds_since(start);
            item.checksum = checksum(text);
            item.clip = format_.parse({item.file.path, item.file.stem, text});
            item.parse_seconds = seconds_since(start) - item.read_seconds;
        } catch (const Error& e) {
            std::string why = e.what();
            if (why.starts_with(item.file.path + ": ")) why.erase(0, item.file.path.size() + 2);
            item.clip = Rejection{Rejection::Kind::broken, why};
        }
        item.file.bytes = {};
    }

    void clean(Group& group) {
        const auto start = Clock::now();
        std::vector<std::vector<std::unique_ptr<RawClip>>> clips(format_.datasets().size());
        Checksum chain;
        chain.add(fingerprint_);
        for (auto& item : group.items) {
            chain.add(fmt::format("{} {} {}\n", item.file.stem, item.file.size, item.checksum));
            ++tranche_.files;
            tranche_.text_bytes += item.checksum.empty() ? 0 : item.file.size;
            summary_.seconds.read += item.read_seconds;
            summary_.seconds.parse += item.parse_seconds;
            keep_or_leave(item, clips);
        }
        fingerprint_ = chain.hex();
        files_done_ += group.items.size();
        for (std::size_t d = 0; d < clips.size(); ++d)
            if (!clips[d].empty()) clean(d, clips[d]);
        summary_.seconds.clean += seconds_since(start);
    }

    void keep_or_leave(Item& item, std::vector<std::vector<std::unique_ptr<RawClip>>>& clips) {
        if (auto* clip = std::get_if<std::unique_ptr<RawClip>>(&item.clip)) {
            if (names_.insert((*clip)->name).second) {
                tranche_.names.push_back((*clip)->name);
                ++clips_done_;
                clips[(*clip)->dataset].push_back(std::move(*clip));
                return;
            }
            item.clip = Rejection{Rejection::Kind::duplicate, "a clip of this name came before"};
        }
        auto rejection = std::get<Rejection>(item.clip);
        rejection.reason = printable(rejection.reason);
        const auto path = printable(item.file.path);
        if (request_.strict && rejection.kind == Rejection::Kind::broken)
            throw Error("{}: {} (--strict; without it such clips are skipped)", path, rejection.reason);
        tranche_.left_out.push_back({path, std::move(rejection)});
    }

    void clean(std::size_t dataset, const std::vector<std::unique_ptr<RawClip>>& raw) {
        std::vector<std::uint32_t> frames;
        auto cleaned = format_.clean(device_, dataset, raw, frames);
        std::vector<Clip> clips;
        for (std::size_t i = 0; i < raw.size(); ++i)
            clips.push_back({raw[i]->name, raw[i]->label, 0, 0, frames[i], raw[i]->fields});
        shards_[dataset].add(clips, std::move(cleaned));
    }

    /// Ends a tranche: its shards go to disk and it is noted down, while the next one is read.
    void commit(Workplace& workplace, Worker& writer) {
        tranche_.fingerprint = fingerprint_;
        std::vector<ShardBuilder> shards;
        for (const auto& header : format_.datasets()) shards.emplace_back(header);
        shards.swap(shards_);
        writer.add(
            [this, &workplace, shards = std::move(shards), tranche = std::exchange(tranche_, {})]() mutable {
                const auto start = Clock::now();
                for (std::size_t d = 0; d < shards.size(); ++d)
                    if (!shards[d].empty())
                        tranche.shards.emplace_back(d, write(workplace, d, shards[d], tranche.fingerprint));
                workplace.finish(std::move(tranche));
                summary_.seconds.write += seconds_since(start);
            });
    }

    ShardEntry write(const Workplace& workplace, std::size_t dataset, const ShardBuilder& shard,
                     const std::string& fingerprint) {
        const auto file = folder_of(dataset) / shard_name(shard_count_[dataset]++);
        ShardEntry entry{file.string(), {}, 0, shard.clips(), shard.frames()};
        fs::create_directories((workplace.data() / file).parent_path());
        shard.image(format_.settings(), fingerprint, [&](std::string_view image) {
            write_whole(workplace.data() / file, image);
            entry.checksum = checksum(image);
            entry.bytes = image.size();
        });
        return entry;
    }

    /// What stands beside the shards, and the move to OUT.
    void finish(Workplace& workplace, const std::string& wanted) {
        const auto& tranches = workplace.finished();
        add_up(tranches, summary_);
        if (clips_done_ == 0) {
            workplace.discard();
            throw Error("none of {} files gave a clip{}{}", summary_.files,
                        summary_.first_rejections.empty() ? "" : "; the first: ",
                        summary_.first_rejections.empty() ? "" : summary_.first_rejections[0]);
        }
        for (std::size_t d = 0; d < format_.datasets().size(); ++d) {
            const auto file = dataset_file(d, tranches);
            if (file.shards.empty()) continue;
            write_whole(workplace.data() / folder_of(d) / "dataset.json", to_text(file));
            add_dataset(file, (request_.out / folder_of(d)).lexically_normal(), summary_);
        }
        write_whole(workplace.data() / "rejected.csv", rejected_csv(tranches));
        write_whole(
            workplace.data() / "ingest.json",
            record_text({format_.settings(), checksum(wanted), fingerprint_}, request_.out, summary_));
        workplace.deliver(request_.out);
    }

    DatasetFile dataset_file(std::size_t dataset, const std::vector<Tranche>& tranches) const {
        DatasetFile file{format_.datasets()[dataset], format_.settings(), fingerprint_, {}};
        for (const auto& tranche : tranches)
            for (auto [owner, shard] : tranche.shards) {
                if (owner != dataset) continue;
                shard.file = fs::path(shard.file).filename();
                file.shards.push_back(std::move(shard));
            }
        return file;
    }

    const IngestRequest& request_;
    const Format& format_;
    kernels::Device& device_;
    unsigned threads_;
    IngestSummary summary_;
    std::vector<ShardBuilder> shards_;      ///< of the tranche in hand, one a dataset
    std::vector<std::size_t> shard_count_;  ///< shards written so far, one a dataset
    Tranche tranche_;
    std::string fingerprint_;
    std::unordered_set<std::string> names_;
    std::uint64_t files_done_ = 0, clips_done_ = 0;
};

}  // namespace

IngestSummary ingest(const IngestRequest& request, const Format& format, kernels::Device& device) {
    return Ingest(request, format, device).run();
}

}  // namespace actformer::ingest
