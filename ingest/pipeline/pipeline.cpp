#include "ingest/pipeline/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <unordered_set>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/full_path.hpp"
#include "base/process/interruption.hpp"
#include "base/text/counted.hpp"
#include "base/text/printable.hpp"
#include "base/threads/parallel.hpp"
#include "base/threads/worker.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "ingest/dataset/shard.hpp"
#include "ingest/dataset/subjects.hpp"
#include "ingest/pipeline/empty_classes.hpp"
#include "ingest/pipeline/groups.hpp"
#include "ingest/pipeline/journal.hpp"
#include "ingest/pipeline/parsers.hpp"
#include "ingest/pipeline/place.hpp"
#include "ingest/pipeline/record.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t groups_at_once = 2;  // in memory as text
constexpr std::size_t portions_ahead = 6;  // parsed and waiting to be cleaned: enough to ride out a slow one

constexpr std::size_t writes_ahead =
    4;  // the shards of a tranche of a few datasets, and its line in the journal

// Clips are cleaned together up to a group's end or so many bytes, and a shard is closed at a tranche's end or beyond so many.
// Both depend on the clips alone, so that the output does not depend on which thread was fast.
constexpr std::size_t most_cleaned_at_once = std::size_t{16} << 20;
constexpr std::size_t most_in_a_shard = std::size_t{128} << 20;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What the format has not released, piece by piece, so that a large file does not come into memory whole.
void release_rest(const RawText& raw) {
    constexpr std::size_t piece = std::size_t{8} << 20;
    for (std::size_t from = 0; from < raw.text.size(); from += piece) {
        const auto part = raw.text.substr(from, piece);
        raw.release(part.data() + part.size());
    }
}

class Ingest {
  public:
    Ingest(const IngestRequest& request, Format& format, kernels::Device& device)
        : request_(request),
          format_(format),
          device_(device),
          threads_(thread_count(request.threads)),
          origin_(request.origin) {
        for (const auto& raw : request.raw)
            for (const auto& folder : {raw, full_path(raw).parent_path()})
                if (!origin_) origin_ = read_origin(folder);
    }

    IngestSummary run() {
        const auto start = Clock::now();
        if (is_taken(request_.out) && !fs::exists(request_.out / "ingest.json")) refuse_taken();
        settle_format();
        Source source = open_source();
        not_read_ = source.not_read();
        summary_.seconds.walk = seconds_since(start);
        const auto wanted = request_line(source);
        const auto aside = workplace_of(request_.out);
        if (is_taken(request_.out)) {
            take_over_finished(wanted);
            for (const auto& left : {aside, fs::path(request_.out.string() + ".partial")})
                remove_workplace(left);
            return whole_summary();
        }
        const SafePoints safe_points;
        Workplace workplace(aside, wanted, format_.datasets().size());
        summary_.made_again = workplace.notes();
        try {
            go_on_from(workplace, source);
            read_everything(workplace, source, safe_points);
            finish(workplace, wanted);
        } catch (const Interrupted&) {
            safe_points.stop(kept_for_later(workplace, aside));
        } catch (const std::exception& e) {
            const bool any = !workplace.finished().empty();
            const auto kept = kept_for_later(workplace, aside);
            if (!any) throw;
            throw Error("{} ({})", e.what(), kept);
        }
        summary_.seconds.wall = seconds_since(start);
        return whole_summary();
    }

  private:
    /// With the remarks on archives in RAW now: some may have come or gone since a finished ingest was made.
    IngestSummary whole_summary() {
        summary_.remarks.insert(summary_.remarks.end(), not_read_.begin(), not_read_.end());
        return summary_;
    }

    /// What a run that stops here leaves for the next one, in words; removes it where that is nothing.
    static std::string kept_for_later(Workplace& workplace, const fs::path& aside) {
        std::uint64_t kept = 0;
        for (const auto& tranche : workplace.finished()) kept += tranche.files;
        if (!workplace.finished().empty())
            return fmt::format("{} done and kept in {}; the same command goes on from there",
                               counted(kept, "file"), aside.string());
        workplace.discard();
        return "nothing was done yet that could be kept";
    }

    /// Without what this or an earlier run made, which may lie among the raw files.
    Source open_source() const {
        return {request_.raw, format_.extensions(), format_.largest_file(), threads_,
                own_folders(request_.out)};
    }

    /// Shows the format all files if it asks for that.
    void settle_format() {
        const auto wanted = format_.surveys();
        if (wanted != Format::Survey::nothing) {
            Source source = open_source();
            wanted == Format::Survey::names ? survey_names(source) : survey_texts(source);
        }
        format_.settle();
        for (const auto& header : format_.datasets()) {
            check_names_fit(header);
            shards_.emplace_back(header);
            shard_count_.push_back(0);
        }
        pending_.resize(format_.datasets().size());
    }

    void survey_names(Source& source) {
        for (RawFile file; source.next_name(file);)
            if (!format_.refuse(file.raw())) format_.survey(file.raw());
    }

    void survey_texts(Source& source) {
        const auto needs_text = [this](const RawFile& file) {
            return !format_.refuse(file.raw()) && format_.surveys_text_of(file.raw());
        };
        source.unpack_only(needs_text);
        Groups groups(source, static_cast<double>(source.bytes_total()));
        std::vector<TextMemory> memory;
        for (unsigned t = 0; t < threads_; ++t) memory.emplace_back(format_.largest_file());
        for (Group group; groups.next(group);)
            parallel_for(group.items.size(), threads_, [&](std::size_t i, unsigned thread) {
                const auto& file = group.items[i].file;
                if (format_.refuse(file.raw())) return;
                try {
                    format_.survey(needs_text(file) ? memory[thread].read(file) : file.raw());
                } catch (const Error&) {  // it cannot be read, and is rejected when it is to be parsed
                }
            });
    }

    std::string request_line(const Source& source) const {
        return fmt::format("actformer {} | {} | raw {}{}", ACTFORMER_VERSION, format_.settings(),
                           source.listing(), origin_ ? fmt::format(" | {}", name_of(*origin_)) : "");
    }

    fs::path folder_of(std::size_t dataset) const {
        return request_.one_dataset ? fs::path() : fs::path(format_.datasets()[dataset].name);
    }

    /// OUT exists: fine if this very request made it.
    void take_over_finished(const std::string& wanted) {
        if (!read_record(request_.out, checksum(wanted), summary_)) refuse_taken();
        if (request_.strict && !summary_.first_rejections.empty()) stop_at(summary_.first_rejections[0]);
    }

    [[noreturn]] void refuse_taken() const {
        throw Error("{}: already there, and not from this command; remove it or choose another -o",
                    request_.out.string());
    }

    /// For --strict, at a broken clip.
    [[noreturn]] static void stop_at(const std::string& clip) {
        throw Error("{} (--strict; without it such clips are skipped)", clip);
    }

    void go_on_from(const Workplace& workplace, Source& source) {
        RawFile skipped;
        for (const auto& tranche : workplace.finished()) {
            count(tranche);
            for (const auto& left : tranche.left_out)
                if (request_.strict && left.is_broken()) stop_at(left.text());
            for (std::uint64_t i = 0; i < tranche.files; ++i)
                if (!source.next_name(skipped))
                    throw Error("{}: the raw files changed while they were read; remove {}",
                                request_.raw[0].string(), workplace_of(request_.out).string());
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

    /// Parsing some groups, cleaning what came before and writing the tranche before that overlap.
    void read_everything(Workplace& workplace, Source& source, const SafePoints& safe_points) {
        Groups groups(source, static_cast<double>(source.bytes_total()));
        Worker writer(writes_ahead), cleaner(portions_ahead);
        Parsers parsers(
            threads_, format_.largest_file(),
            [this](Item& item, ClipSink& sink, TextMemory& memory) { parse(item, sink, memory); });
        const auto hand_on = [&] {
            if (safe_points.asked()) safe_points.stop({});
            cleaner.add([this, &workplace, &writer, portion = parsers.take()]() mutable {
                add(portion, workplace, writer);
            });
        };
        const auto read_on = [&] {
            for (;;) {
                Group group;
                const auto start = Clock::now();
                const bool any = groups.next(group);
                summary_.seconds.walk += seconds_since(start);
                if (!any) break;
                parsers.add(std::move(group));
                while (parsers.groups() == groups_at_once) hand_on();
            }
            while (parsers.groups() > 0) hand_on();
        };
        try {
            read_on();
            cleaner.finish();
            writer.finish();
        } catch (const Interrupted&) {
            throw;
        } catch (...) {  // what came before the failure is ended and kept
            cleaner.end_what_waits();
            writer.end_what_waits();
            throw;
        }
    }

    /// An Error that `work` throws becomes a rejection of the file.
    template <typename Work>
    static void or_reject(const RawFile& file, ClipSink& sink, Work work) {
        try {
            work();
        } catch (const Error& e) {
            std::string why = e.what();
            if (const auto start = printable(file.path) + ": "; why.starts_with(start))
                why.erase(0, start.size());
            sink.take(Rejection{Rejection::Kind::broken, why});
        }
    }

    void parse(Item& item, ClipSink& sink, TextMemory& memory) const {
        const auto& file = item.file;
        if (auto refused = format_.refuse(file.raw())) return sink.take(std::move(*refused));
        const auto start = Clock::now();
        or_reject(file, sink, [&] {
            auto raw = memory.read(file);
            item.file.size = raw.text.size();
            item.read_seconds = seconds_since(start);
            TextChecksum checksum(raw.text);
            raw.checksum = &checksum;
            or_reject(file, sink, [&] { format_.read(raw, sink); });
            release_rest(raw);
            item.checksum = checksum.hex();
            item.parse_seconds = seconds_since(start) - item.read_seconds;
        });
        item.file.bytes = {};
        item.file.unpacked.reset();
    }

    /// Takes what was parsed, and cleans it as soon as it is enough.
    void add(Portion& portion, Workplace& workplace, Worker& writer) {
        const auto start = Clock::now();
        for (auto& item : portion.items) {
            for (auto& clip : item.clips) {
                keep_or_leave(item.file, clip);
                if (pending_bytes_ >= most_cleaned_at_once) clean(workplace, writer);
            }
            if (item.done) count(item);
        }
        if (portion.ends_group) {
            clean(workplace, writer);
            fingerprint_ = Checksum().add(fingerprint_).add(std::exchange(group_files_, {})).hex();
        }
        summary_.seconds.clean += seconds_since(start);
        if (portion.ends_tranche) commit(workplace, writer);
        if (request_.progress && portion.ends_group) request_.progress(portion.fraction, clips_done_);
    }

    void count(const Item& item) {
        group_files_ += fmt::format("{} {} {}\n", item.file.stem, item.file.size, item.checksum);
        ++tranche_.files;
        ++files_done_;
        tranche_.text_bytes += item.checksum.empty() ? 0 : item.file.size;
        summary_.seconds.read += item.read_seconds;
        summary_.seconds.parse += item.parse_seconds;
    }

    void keep_or_leave(const RawFile& file, ParsedClip& parsed) {
        if (auto* clip = std::get_if<std::unique_ptr<RawClip>>(&parsed)) {
            if (names_.insert((*clip)->name).second) return keep(std::move(*clip));
            std::string place = (*clip)->name == file.stem ? "" : fmt::format("clip {}: ", (*clip)->name);
            parsed = Rejection{Rejection::Kind::duplicate, place + "a clip of this name came before"};
        }
        auto rejection = std::get<Rejection>(std::move(parsed));
        rejection.reason = printable(rejection.reason);
        LeftOut left{printable(file.path), std::move(rejection)};
        if (request_.strict && left.is_broken()) stop_at(left.text());
        tranche_.left_out.push_back(std::move(left));
    }

    void keep(std::unique_ptr<RawClip> clip) {
        tranche_.names.push_back(clip->name);
        tranche_.labels.emplace(clip->dataset, clip->label);
        const auto& header = format_.datasets()[clip->dataset];
        for (const auto& split : header.splits)
            if (split.holds(header.fields, clip->fields)) ++tranche_.splits[{clip->dataset, split.name}];
        for (const auto& doubt : clip->doubts) tranche_.doubts.push_back({clip->dataset, doubt, clip->name});
        ++clips_done_;
        pending_bytes_ += clip->bytes();
        pending_[clip->dataset].push_back(std::move(clip));
    }

    /// Cleans the clips that wait, and sends full shards to the disk.
    void clean(const Workplace& workplace, Worker& writer) {
        for (std::size_t d = 0; d < pending_.size(); ++d) {
            if (pending_[d].empty()) continue;
            clean(d, pending_[d]);
            pending_[d].clear();
            if (shards_[d].bytes() >= most_in_a_shard) send(d, workplace, writer);
        }
        pending_bytes_ = 0;
    }

    void clean(std::size_t dataset, const std::vector<std::unique_ptr<RawClip>>& raw) {
        std::vector<std::uint32_t> frames;
        auto cleaned = format_.clean(device_, dataset, raw, frames);
        std::vector<Clip> clips;
        for (std::size_t i = 0; i < raw.size(); ++i)
            clips.push_back({raw[i]->name, raw[i]->label, 0, 0, frames[i], raw[i]->fields});
        shards_[dataset].add(clips, std::move(cleaned));
    }

    /// Writes a dataset's shard while the next one is made. It is marked with the fingerprint of all whole groups before its end.
    void send(std::size_t dataset, const Workplace& workplace, Worker& writer) {
        auto shard = std::exchange(shards_[dataset], ShardBuilder(format_.datasets()[dataset]));
        writer.add(
            [this, &workplace, dataset, shard = std::move(shard), fingerprint = fingerprint_]() mutable {
                const auto start = Clock::now();
                written_.emplace_back(dataset, write(workplace, dataset, shard, fingerprint));
                summary_.seconds.write += seconds_since(start);
            });
    }

    /// Ends a tranche: its shards go to disk and it is noted down, while the next one is read.
    void commit(Workplace& workplace, Worker& writer) {
        for (std::size_t d = 0; d < shards_.size(); ++d)
            if (!shards_[d].empty()) send(d, workplace, writer);
        tranche_.fingerprint = fingerprint_;
        writer.add([this, &workplace, tranche = std::exchange(tranche_, {})]() mutable {
            tranche.shards = std::exchange(written_, {});
            workplace.finish(std::move(tranche));
        });
    }

    KeptShard write(const Workplace& workplace, std::size_t dataset, ShardBuilder& shard,
                    const std::string& fingerprint) {
        const auto file = folder_of(dataset) / shard_name(shard_count_[dataset]++);
        ShardEntry entry{file.string(), {}, 0, shard.clips(), shard.frames()};
        make_folders((workplace.data() / file).parent_path());
        const auto image = shard.image(shard_memory_, format_.settings(), fingerprint);
        write_whole(workplace.data() / file, image.bytes, Sync::later);
        entry.checksum = image.contents;
        entry.metadata = image.metadata;
        entry.bytes = image.bytes.size();
        return {std::move(entry), checksum(image.bytes)};
    }

    /// What stands beside the shards, and the move to OUT.
    void finish(Workplace& workplace, const std::string& wanted) {
        const auto& tranches = workplace.finished();
        add_up(tranches, summary_);
        if (clips_done_ == 0) {
            const auto why = why_no_clip(tranches);
            workplace.discard();
            throw Error("{}: {}", request_.raw[0].string(), why);
        }
        summary_.remarks = format_.remarks();
        for (std::size_t d = 0; d < format_.datasets().size(); ++d) {
            auto file = dataset_file(d, tranches);
            if (file.shards.empty()) continue;
            const auto folder = workplace.data() / folder_of(d);
            file.remarks = format_.remarks();
            if (format_.drops_empty_classes())
                if (const auto lost = drop_classes(d, file, workplace); !lost.empty()) {
                    file.remarks.push_back(lost);
                    summary_.remarks.push_back(lost);
                }
            for (const auto& doubt : doubts_of(tranches, d)) file.remarks.push_back(to_line(doubt));
            write_whole(folder / "dataset.json", to_text(file), Sync::later);
            add_dataset(file, (request_.out / folder_of(d)).lexically_normal(), clips_of_splits(d, tranches),
                        summary_);
        }
        write_whole(workplace.data() / "rejected.csv", rejected_csv(tranches), Sync::later);
        write_whole(workplace.data() / "ingest.json",
                    record_text({format_.settings(), checksum(wanted), fingerprint_, not_read_}, request_.out,
                                summary_),
                    Sync::later);
        workplace.deliver(request_.out);
    }

    SplitCounts clips_of_splits(std::size_t dataset, const std::vector<Tranche>& tranches) const {
        SplitCounts out;
        for (const auto& split : format_.datasets()[dataset].splits) {
            out.emplace_back(split.name, 0);
            for (const auto& tranche : tranches)
                if (const auto found = tranche.splits.find({dataset, split.name});
                    found != tranche.splits.end())
                    out.back().second += found->second;
        }
        return out;
    }

    /// With the first clip that was left out, one that is broken where there is any.
    std::string why_no_clip(const std::vector<Tranche>& tranches) const {
        std::string first = summary_.first_rejections.empty() ? "" : summary_.first_rejections[0];
        for (const auto& tranche : tranches)
            if (first.empty() && !tranche.left_out.empty()) first = tranche.left_out[0].text();
        return (summary_.files == 0
                    ? fmt::format("no {} file in it", fmt::join(format_.extensions(), ", "))
                    : fmt::format("none of {} gave a clip", counted(summary_.files, "file"))) +
               (first.empty() ? "; is it the raw data of this format?" : "; the first: " + first);
    }

    /// The classes dropped in a line, or nothing where none was.
    std::string drop_classes(std::size_t dataset, DatasetFile& file, Workplace& workplace) const {
        std::set<std::uint32_t> labels;
        for (const auto& tranche : workplace.finished())
            for (const auto& [owner, label] : tranche.labels)
                if (owner == dataset) labels.insert(label);
        const auto dropped = drop_empty_classes(file, labels, workplace.data() / folder_of(dataset),
                                                [&](const auto& to_be) { workplace.announce(to_be); });
        if (dropped.empty()) return {};
        return fmt::format("no clip was left of {}: {} not among the classes", fmt::join(dropped, ", "),
                           dropped.size() == 1 ? "it is" : "they are");
    }

    DatasetFile dataset_file(std::size_t dataset, const std::vector<Tranche>& tranches) const {
        DatasetFile file{format_.datasets()[dataset], format_.settings(), fingerprint_, {}, {}};
        if (origin_) file.header.origin.kind = origin_;
        for (const auto& tranche : tranches)
            for (const auto& [owner, shard] : tranche.shards) {
                if (owner != dataset) continue;
                file.shards.push_back(shard.entry);
                file.shards.back().file = fs::path(shard.entry.file).filename();
            }
        return file;
    }

    const IngestRequest& request_;
    Format& format_;
    kernels::Device& device_;
    unsigned threads_;
    std::optional<DataOrigin::Kind> origin_;
    IngestSummary summary_;
    std::vector<std::string> not_read_;                           ///< as Source tells it
    std::vector<std::vector<std::unique_ptr<RawClip>>> pending_;  ///< (datasets) parsed and not yet cleaned
    std::size_t pending_bytes_ = 0;
    std::vector<ShardBuilder> shards_;                        ///< (datasets) in the making
    std::vector<std::size_t> shard_count_;                    ///< (datasets) shards written so far
    std::vector<std::pair<std::size_t, KeptShard>> written_;  ///< of the tranche in hand; the writer's own
    hdf5::FileMemory shard_memory_;  ///< of the shard that is written; the writer's own
    Tranche tranche_;
    std::string group_files_;  ///< names and checksums of the group in hand
    std::string fingerprint_;
    std::unordered_set<std::string> names_;
    std::uint64_t files_done_ = 0, clips_done_ = 0;
};

}  // namespace

IngestSummary ingest(const IngestRequest& request, Format& format, kernels::Device& device) {
    return Ingest(request, format, device).run();
}

}  // namespace actformer::ingest
