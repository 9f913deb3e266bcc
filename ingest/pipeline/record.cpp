#include "ingest/pipeline/record.hpp"

#include <algorithm>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/csv.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t shown = 3;  // names and reasons, of however many

void add_doubt(const Doubtful& one, std::vector<IngestSummary::Doubt>& doubts) {
    auto found =
        std::find_if(doubts.begin(), doubts.end(), [&](const auto& d) { return d.what == one.doubt; });
    if (found == doubts.end()) found = doubts.insert(found, {one.doubt, 0, {}});
    ++found->clips;
    if (found->first.size() < shown) found->first.push_back(one.clip);
}

void take_summary(const nlohmann::ordered_json& json, const fs::path& out, IngestSummary& summary) {
    expect_counts(json);
    summary.was_complete = true;
    summary.files = json.at("files");
    summary.text_bytes = json.at("text_bytes");
    summary.left_out = json.at("left_out").get<std::map<std::string, std::uint64_t>>();
    summary.first_rejections = json.at("first_rejections").get<std::vector<std::string>>();
    summary.remarks = json.at("remarks").get<std::vector<std::string>>();
    for (const auto& d : json.at("doubts"))
        summary.doubts.push_back({d.at("what"), d.at("clips"), d.at("first")});
    for (const auto& d : json.at("datasets")) {
        summary.datasets.push_back({(out / d.at("folder").get<std::string>()).lexically_normal().string(),
                                    d.at("clips"), d.at("frames"), d.at("bytes"), d.at("shards"),
                                    d.at("classes")});
        const auto splits = d.value("splits", nlohmann::ordered_json::object());
        for (const auto& [split, clips] : splits.items())
            summary.datasets.back().splits.emplace_back(split, clips);
    }
}

}  // namespace

std::string_view kind_name(Rejection::Kind kind) {
    switch (kind) {
        case Rejection::Kind::broken:
            return "broken";
        case Rejection::Kind::dropped:
            return "dropped";
        case Rejection::Kind::missing:
            return "missing";
        case Rejection::Kind::duplicate:
            return "duplicate";
    }
    return "unknown";
}

void add_up(const std::vector<Tranche>& tranches, IngestSummary& summary) {
    for (const auto& tranche : tranches) {
        summary.files += tranche.files;
        summary.text_bytes += tranche.text_bytes;
        for (const auto& left : tranche.left_out) {
            ++summary.left_out[std::string(kind_name(left.rejection.kind))];
            if (summary.first_rejections.size() < shown && left.is_broken())
                summary.first_rejections.push_back(left.text());
        }
        for (const auto& one : tranche.doubts) add_doubt(one, summary.doubts);
    }
}

void add_dataset(const DatasetFile& file, const fs::path& folder, SplitCounts splits,
                 IngestSummary& summary) {
    IngestSummary::PerDataset entry{folder.string(),  0, 0, 0, file.shards.size(), file.header.classes.size(),
                                    std::move(splits)};
    for (const auto& shard : file.shards) {
        entry.clips += shard.clips;
        entry.frames += shard.frames;
        entry.bytes += shard.bytes;
    }
    summary.datasets.push_back(std::move(entry));
}

std::vector<IngestSummary::Doubt> doubts_of(const std::vector<Tranche>& tranches, std::size_t dataset) {
    std::vector<IngestSummary::Doubt> doubts;
    for (const auto& tranche : tranches)
        for (const auto& one : tranche.doubts)
            if (one.dataset == dataset) add_doubt(one, doubts);
    return doubts;
}

std::string to_line(const IngestSummary::Doubt& doubt) {
    return fmt::format("{} clip{}: {} ({}{})", doubt.clips, doubt.clips == 1 ? "" : "s", doubt.what,
                       fmt::join(doubt.first, ", "), doubt.clips > doubt.first.size() ? ", ..." : "");
}

std::string rejected_csv(const std::vector<Tranche>& tranches) {
    std::string csv = "file,kind,reason\n";
    for (const auto& tranche : tranches)
        for (const auto& [path, rejection] : tranche.left_out)
            csv += fmt::format("{},{},{}\n", csv_cell(path), kind_name(rejection.kind),
                               csv_cell(rejection.reason));
    return csv;
}

nlohmann::ordered_json doubts_json(const IngestSummary& summary) {
    auto all = nlohmann::ordered_json::array();
    for (const auto& d : summary.doubts)
        all.push_back({{"what", d.what}, {"clips", d.clips}, {"first", d.first}});
    return all;
}

nlohmann::ordered_json datasets_json(const IngestSummary& summary) {
    auto all = nlohmann::ordered_json::array();
    for (const auto& d : summary.datasets) {
        all.push_back({{"folder", d.folder},
                       {"clips", d.clips},
                       {"frames", d.frames},
                       {"bytes", d.bytes},
                       {"shards", d.shards},
                       {"classes", d.classes}});
        for (const auto& [split, clips] : d.splits) all.back()["splits"][split] = clips;
    }
    return all;
}

std::string record_text(const Origin& origin, const fs::path& out, const IngestSummary& summary) {
    nlohmann::ordered_json json{{"program", "actformer " ACTFORMER_VERSION},
                                {"settings", origin.settings},
                                {"request", origin.request},
                                {"source", origin.fingerprint},
                                {"files", summary.files},
                                {"text_bytes", summary.text_bytes},
                                {"left_out", summary.left_out},
                                {"first_rejections", summary.first_rejections},
                                {"remarks", summary.remarks},
                                {"not_read", origin.not_read}};
    json["doubts"] = doubts_json(summary);
    json["datasets"] = datasets_json(summary);
    for (auto& d : json["datasets"])
        d["folder"] =
            fs::path(d["folder"].get<std::string>()).lexically_relative(out.lexically_normal()).string();
    return with_checksum(std::move(json)).dump(1) + "\n";
}

bool read_record(const fs::path& out, const std::string& request, IngestSummary& summary) {
    const auto path = out / "ingest.json";
    if (!fs::exists(path)) return false;
    std::vector<char> scratch;
    const auto text = read_text(path, scratch, std::uint64_t{1} << 26);
    expect_shallow_json(text, path);
    try {
        const auto json = nlohmann::ordered_json::parse(text);
        if (own_checksum_of(json) == OwnChecksum::wrong)
            throw Error("its checksum is of other contents, or missing");
        if (json.at("request") != request) return false;
        take_summary(json, out, summary);
        return true;
    } catch (const std::exception& e) {
        throw Error(
            "{}: damaged: {}; it tells what {} was made from: remove that folder, or choose another -o",
            path.string(), printable(e.what()), out.string());
    }
}

}  // namespace actformer::ingest
