#include "ingest/pipeline.hpp"

#include <chrono>
#include <future>
#include <set>

#include "ingest/checksum.hpp"
#include "ingest/dataset_json.hpp"
#include "ingest/file.hpp"
#include "ingest/journal.hpp"
#include "ingest/parallel.hpp"
#include "ingest/shard.hpp"
#include "ingest/source.hpp"
#include "ingest/text/printable.hpp"
#include "kernels/error.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

// A tranche is what one kill can lose, and what one shard a dataset is made of; a group is what is in memory as text.
constexpr std::uint64_t files_a_tranche = 4096, bytes_a_tranche = std::uint64_t{384} << 20;
constexpr std::uint64_t files_a_group = 256, bytes_a_group = std::uint64_t{48} << 20;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// One raw file on its way through a group.
struct Item {
    RawFile file;
    std::string checksum;  ///< of its text
    ParsedClip clip = Rejection{};
    double read_seconds = 0, parse_seconds = 0;
};

struct Group {
    std::vector<Item> items;
    bool ends_tranche = false;
    double fraction = 0;  ///< of the source that has been read with it
};

/// Cuts the source into groups and tranches.
class Groups {
  public:
    Groups(Source& source, double total) : source_(source), total_(total) {}

    bool next(Group& group) {
        group = {};
        std::uint64_t bytes = 0;
        while (more() && group.items.size() < files_a_group && bytes < bytes_a_group && !group.ends_tranche) {
            bytes += ahead_.size;
            tranche_bytes_ += ahead_.size;
            group.items.push_back({std::move(ahead_), {}, Rejection{}, 0, 0});
            have_ahead_ = false;
            group.ends_tranche = ++tranche_files_ >= files_a_tranche || tranche_bytes_ >= bytes_a_tranche;
        }
        if (!more()) group.ends_tranche = true;
        if (group.ends_tranche) tranche_files_ = tranche_bytes_ = 0;
        group.fraction = total_ > 0 ? static_cast<double>(source_.bytes_read()) / total_ : 1;
        return !group.items.empty();
    }

  private:
    bool more() { return have_ahead_ || (have_ahead_ = source_.next(ahead_)); }

    Source& source_;
    double total_;
    RawFile ahead_;
    bool have_ahead_ = false;
    std::uint64_t tranche_files_ = 0, tranche_bytes_ = 0;
};

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
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
            throw Error("{} ({} files are done and kept in {}; the same command goes on from there)", e.what(), kept,
                        aside.string());
        }
        summary_.seconds.wall = seconds_since(start);
        return summary_;
    }

  private:
    std::string request_line(const Source& source) const {
        Checksum missing;
        for (const auto& name : std::set<std::string>(request_.missing.begin(), request_.missing.end()))
            missing.add(name + "\n");
        return fmt::format("actformer {} | {} | raw {} | missing {}", ACTFORMER_VERSION, format_.settings(), source.listing(),
                           missing.hex());
    }

    fs::path folder_of(std::size_t dataset) const {
        return request_.one_dataset ? fs::path() : fs::path(format_.datasets()[dataset].name);
    }

    /// OUT exists: fine if this very request made it.
    void take_over_finished(const std::string& wanted) {
        const auto record = request_.out / "ingest.json";
        std::vector<char> scratch;
        if (fs::exists(record)) {
            const auto json = nlohmann::json::parse(read_text(record, scratch, 1 << 26), nullptr, false);
            if (!json.is_discarded() && json.value("request", "") == checksum(wanted)) {
                restore_summary(json);
                return;
            }
        }
        throw Error("{}: already there, and not from this command; remove it or choose another -o", request_.out.string());
    }

    void go_on_from(const Workplace& workplace, Source& source) {
        RawFile skipped;
        for (const auto& tranche : workplace.finished()) {
            count(tranche);
            for (std::uint64_t i = 0; i < tranche.files; ++i)
                if (!source.next_name(skipped))
                    throw Error("the raw files changed while they were read; remove {}.partial", request_.out.string());
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

    /// Parsing a group and cleaning the one before it overlap.
    void read_everything(Workplace& workplace, Source& source) {
        Groups groups(source, static_cast<double>(source.bytes_total()));
        std::future<void> cleaning;
        Group group;
        const auto walked = [&] {
            const auto start = Clock::now();
            const bool any = groups.next(group);
            summary_.seconds.walk += seconds_since(start);
            return any;
        };
        while (walked()) {
            parse(group);
            if (cleaning.valid()) cleaning.get();
            cleaning = std::async(std::launch::async, [this, &workplace, g = std::move(group)]() mutable {
                clean(g);
                if (g.ends_tranche) commit(workplace);
                if (request_.progress) request_.progress(g.fraction, clips_done_);
            });
        }
        if (cleaning.valid()) cleaning.get();
    }

    void parse(Group& group) {
        std::vector<std::vector<char>> scratch(threads_);
        parallel_for(group.items.size(), threads_, [&](std::size_t i, unsigned thread) {
            parse(group.items[i], scratch[thread]);
        });
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

    /// Ends a tranche: its shards go to disk, then it is noted down.
    void commit(Workplace& workplace) {
        const auto start = Clock::now();
        for (std::size_t d = 0; d < shards_.size(); ++d) {
            if (shards_[d].empty()) continue;
            const auto file = folder_of(d) / shard_name(shard_count_[d]++);
            fs::create_directories((workplace.data() / file).parent_path());
            shards_[d].image(format_.settings(), fingerprint_, [&](std::string_view image) {
                write_whole(workplace.data() / file, image);
                tranche_.shards.emplace_back(
                    d, ShardEntry{file.string(), checksum(image), image.size(), shards_[d].clips(), shards_[d].frames()});
            });
            shards_[d] = ShardBuilder(format_.datasets()[d]);
        }
        tranche_.fingerprint = fingerprint_;
        workplace.finish(std::exchange(tranche_, {}));
        summary_.seconds.write += seconds_since(start);
    }

    void finish(Workplace& workplace, const std::string& wanted) {
        std::string csv = "file,kind,reason\n";
        std::vector<DatasetFile> files;
        for (const auto& header : format_.datasets()) files.push_back({header, format_.settings(), fingerprint_, {}});
        for (const auto& tranche : workplace.finished()) {
            summary_.files += tranche.files;
            summary_.text_bytes += tranche.text_bytes;
            for (const auto& [path, rejection] : tranche.left_out) {
                ++summary_.left_out[std::string(kind_name(rejection.kind))];
                csv += fmt::format("{},{},{}\n", csv_field(path), kind_name(rejection.kind), csv_field(rejection.reason));
                if (summary_.first_rejections.size() < 3 && rejection.kind == Rejection::Kind::broken)
                    summary_.first_rejections.push_back(path + ": " + rejection.reason);
            }
            for (auto [dataset, shard] : tranche.shards) {
                shard.file = fs::path(shard.file).filename();
                files[dataset].shards.push_back(std::move(shard));
            }
        }
        if (clips_done_ == 0) {
            workplace.discard();
            throw Error("none of {} files gave a clip{}{}", summary_.files,
                        summary_.first_rejections.empty() ? "" : "; the first: ",
                        summary_.first_rejections.empty() ? "" : summary_.first_rejections[0]);
        }
        for (std::size_t d = 0; d < files.size(); ++d) {
            if (files[d].shards.empty()) continue;
            write_whole(workplace.data() / folder_of(d) / "dataset.json", to_text(files[d]));
            add_to_summary(files[d], folder_of(d));
        }
        write_whole(workplace.data() / "rejected.csv", csv);
        write_whole(workplace.data() / "ingest.json", record(wanted));
        workplace.deliver(request_.out);
    }

    void add_to_summary(const DatasetFile& file, const fs::path& folder) {
        IngestSummary::PerDataset entry{(folder.empty() ? request_.out : request_.out / folder).string(), 0, 0, 0,
                                        file.shards.size(), file.header.classes.size()};
        for (const auto& shard : file.shards) {
            entry.clips += shard.clips;
            entry.frames += shard.frames;
            entry.bytes += shard.bytes;
        }
        summary_.datasets.push_back(std::move(entry));
    }

    /// ingest.json: what was asked, and the summary, for a run that finds the work done.
    std::string record(const std::string& wanted) const {
        nlohmann::ordered_json json{{"program", "actformer " ACTFORMER_VERSION},
                                    {"settings", format_.settings()},
                                    {"request", checksum(wanted)},
                                    {"source", fingerprint_},
                                    {"files", summary_.files},
                                    {"text_bytes", summary_.text_bytes},
                                    {"left_out", summary_.left_out},
                                    {"first_rejections", summary_.first_rejections}};
        json["datasets"] = nlohmann::ordered_json::array();
        for (const auto& d : summary_.datasets)
            json["datasets"].push_back({{"folder", fs::path(d.folder).lexically_relative(request_.out).string()},
                                        {"clips", d.clips},
                                        {"frames", d.frames},
                                        {"bytes", d.bytes},
                                        {"shards", d.shards},
                                        {"classes", d.classes}});
        return json.dump(1) + "\n";
    }

    void restore_summary(const nlohmann::json& json) {
        summary_.was_complete = true;
        summary_.files = json.at("files");
        summary_.text_bytes = json.at("text_bytes");
        summary_.left_out = json.at("left_out").get<std::map<std::string, std::uint64_t>>();
        summary_.first_rejections = json.at("first_rejections").get<std::vector<std::string>>();
        for (const auto& d : json.at("datasets"))
            summary_.datasets.push_back({(request_.out / d.at("folder").get<std::string>()).lexically_normal().string(),
                                         d.at("clips"), d.at("frames"), d.at("bytes"), d.at("shards"), d.at("classes")});
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

std::string_view kind_name(Rejection::Kind kind) {
    switch (kind) {
        case Rejection::Kind::broken: return "broken";
        case Rejection::Kind::dropped: return "dropped";
        case Rejection::Kind::missing: return "missing";
        case Rejection::Kind::duplicate: return "duplicate";
    }
    return "unknown";
}

IngestSummary ingest(const IngestRequest& request, const Format& format, kernels::Device& device) {
    return Ingest(request, format, device).run();
}

}  // namespace actformer::ingest
