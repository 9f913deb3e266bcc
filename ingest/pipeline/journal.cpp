#include "ingest/pipeline/journal.hpp"

#include <fstream>
#include <set>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/json.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "ingest/pipeline/place.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Tranche& tranche) {
    Json left_out = Json::array(), doubts = Json::array(), shards = Json::array();
    for (const auto& one : tranche.doubts) doubts.push_back({one.dataset, one.doubt, one.clip});
    for (const auto& one : tranche.left_out)
        left_out.push_back({one.path, static_cast<int>(one.rejection.kind), one.rejection.reason});
    for (const auto& [dataset, shard] : tranche.shards)
        shards.push_back({{"dataset", dataset}, {"shard", ingest::to_json(shard)}});
    return {{"files", tranche.files},
            {"text_bytes", tranche.text_bytes},
            {"fingerprint", tranche.fingerprint},
            {"left_out", left_out},
            {"doubts", doubts},
            {"shards", shards},
            {"names", tranche.names},
            {"labels", tranche.labels}};
}

Tranche tranche_from(const Json& json) {
    Tranche tranche{json.at("files"), json.at("text_bytes"), json.at("fingerprint"), {}, {}, {},
                    json.at("names"), json.at("labels")};
    for (const auto& one : json.at("doubts"))
        tranche.doubts.push_back({one.at(0).get<std::size_t>(), one.at(1), one.at(2)});
    for (const auto& one : json.at("left_out"))
        tranche.left_out.push_back(
            {one.at(0), {static_cast<Rejection::Kind>(one.at(1).get<int>()), one.at(2)}});
    for (const auto& one : json.at("shards"))
        tranche.shards.emplace_back(one.at("dataset").get<std::size_t>(), shard_from_json(one.at("shard")));
    return tranche;
}

/// Text with bytes that are no UTF-8 (file names may hold any) replaced, so that every line can be read back.
std::string line_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Workplace::Workplace(fs::path folder, const std::string& request) : folder_(std::move(folder)) {
    make_folders(folder_);
    lock_ = FileLock::if_free(folder_ / "lock");
    if (!lock_)
        throw Error("{}: another ingest is writing there; wait for it, or choose another -o",
                    folder_.string());
    take_back(data(), folder_);
    load(request);
}

void Workplace::load(const std::string& request) {
    std::ifstream journal(folder_ / "journal");
    std::string line;
    if (!std::getline(journal, line) || line != request || journal.eof()) return start_afresh(request);
    std::string whole = line + "\n";
    std::set<fs::path> known;
    bool all_there = true;
    while (std::getline(journal, line) &&
           !journal.eof()) {  // a line without its end was cut short by the kill
        const auto json = json_or_discarded<Json>(line);
        if (json.is_discarded()) break;
        finished_.push_back(tranche_from(json));
        whole += line + "\n";
        for (const auto& [dataset, shard] : finished_.back().shards) {
            std::error_code missing;
            all_there = all_there && fs::file_size(data() / shard.file, missing) == shard.bytes;
            known.insert(data() / shard.file);
        }
    }
    journal.close();
    if (!all_there) return start_afresh(request);
    fs::resize_file(folder_ / "journal", whole.size());
    std::vector<fs::path> unfinished;
    if (fs::exists(data()))
        for (const auto& entry : fs::recursive_directory_iterator(data()))
            if (!entry.is_directory() && !known.contains(entry.path())) unfinished.push_back(entry.path());
    for (const auto& path : unfinished) fs::remove(path);
}

void Workplace::start_afresh(const std::string& request) {
    finished_.clear();
    fs::remove(folder_ / "journal");
    fs::remove_all(data());
    make_folders(data());
    append(folder_ / "journal", request + "\n");
}

void Workplace::finish(Tranche tranche) {
    append(folder_ / "journal", line_of(to_json(tranche)));
    finished_.push_back(std::move(tranche));
}

void Workplace::deliver(const fs::path& out) {
    put_in_place(data(), folder_, out);
    discard();
}

void Workplace::discard() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    finished_.clear();
}

}  // namespace actformer::ingest
