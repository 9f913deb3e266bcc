#include "ingest/pipeline/journal.hpp"

#include <algorithm>
#include <fstream>
#include <set>

#include "base/checksum/checksum.hpp"
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
        shards.push_back(
            {{"dataset", dataset}, {"shard", ingest::to_json(shard.entry)}, {"bytes", shard.checksum}});
    return {{"files", tranche.files},
            {"text_bytes", tranche.text_bytes},
            {"fingerprint", tranche.fingerprint},
            {"left_out", left_out},
            {"doubts", doubts},
            {"shards", shards},
            {"names", tranche.names},
            {"labels", tranche.labels},
            {"splits", tranche.splits}};
}

Rejection::Kind kind_from(const Json& json) {
    const auto number = json.get<int>();
    if (number < 0 || number > static_cast<int>(Rejection::Kind::duplicate))
        throw Error("there is no kind {} of rejection", number);
    return static_cast<Rejection::Kind>(number);
}

/// Throws Error where its file does not lie below the working folder's data.
KeptShard shard_from(const Json& json) {
    KeptShard shard{shard_from_json(json.at("shard")), json.at("bytes").get<std::string>()};
    if (!lies_below(shard.entry.file))
        throw Error("{}: not below the working folder's data", shard.entry.file);
    return shard;
}

/// Throws Error or Json::exception where it is none.
Tranche tranche_from(const Json& json) {
    expect_counts(json);
    Tranche tranche{json.at("files"), json.at("text_bytes"), json.at("fingerprint"), {}, {}, {},
                    json.at("names"), json.at("labels"),     json.at("splits")};
    for (const auto& one : json.at("doubts"))
        tranche.doubts.push_back({one.at(0).get<std::size_t>(), one.at(1), one.at(2)});
    for (const auto& one : json.at("left_out"))
        tranche.left_out.push_back({one.at(0), {kind_from(one.at(1)), one.at(2)}});
    for (const auto& one : json.at("shards"))
        tranche.shards.emplace_back(one.at("dataset").get<std::size_t>(), shard_from(one));
    return tranche;
}

/// False where it names a dataset that there is not.
bool is_of_datasets(const Tranche& tranche, std::size_t datasets) {
    const auto known = [datasets](std::size_t number) { return number < datasets; };
    return std::ranges::all_of(tranche.shards, known, [](const auto& one) { return one.first; }) &&
           std::ranges::all_of(tranche.labels, known, [](const auto& one) { return one.first; }) &&
           std::ranges::all_of(tranche.splits, known, [](const auto& one) { return one.first.first; }) &&
           std::ranges::all_of(tranche.doubts, known, &Doubtful::dataset);
}

/// None where the text is no tranche's of so many datasets, whatever its checksum says.
std::optional<Tranche> tranche_in(const std::string& text, std::size_t datasets) {
    try {
        auto tranche = tranche_from(json_or_discarded<Json>(text));
        if (is_of_datasets(tranche, datasets)) return tranche;
    } catch (const Json::exception&) {
    } catch (const Error&) {
    }
    return {};
}

/// Text with bytes that are no UTF-8 (file names may hold any) replaced, so that every line can be read back.
std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Workplace::Workplace(fs::path folder, const std::string& request, std::size_t datasets)
    : folder_(std::move(folder)), datasets_(datasets) {
    const auto expect_free = [this](bool is_free) {
        if (!is_free)
            throw Error("{}: another ingest is writing there; wait for it, or choose another -o",
                        folder_.string());
    };
    expect_free(!FileLock::is_held(folder_ / "lock"));
    expect_own_workplace(folder_);
    make_folders(folder_);
    lock_ = FileLock::if_free(folder_ / "lock");
    expect_free(lock_.has_value());
    take_back(data(), folder_);
    load(request);
}

/// The text as a line behind those so far, whose checksum it begins with.
std::string Workplace::line_for(const std::string& text) {
    sum_ = checksum(sum_ + text);
    return sum_ + " " + text + "\n";
}

void Workplace::load(const std::string& request) {
    std::ifstream journal(folder_ / "journal", std::ios::binary);
    std::string line, whole = line_for(request);
    const bool ends = std::getline(journal, line) && !journal.eof();
    if (!ends && whole.starts_with(line)) return start_afresh(request);  // a kill may have cut it short
    if (!ends || line + "\n" != whole) {
        notes_.push_back(fmt::format("{}: damaged, or of other settings or raw files; all is read again",
                                     (folder_ / "journal").string()));
        return start_afresh(request);
    }
    read_announced();
    for (std::size_t number = 2; std::getline(journal, line) && !journal.eof(); ++number) {
        if (!take_line(line, number)) break;  // a line without its end was cut short by the kill
        whole += line + "\n";
    }
    journal.close();
    fs::resize_file(folder_ / "journal", whole.size());
    remove_unfinished();
}

/// False, and a note, where the line or one of its shards is not as it was written.
bool Workplace::take_line(const std::string& line, std::size_t number) {
    const auto before = sum_;
    const auto space = line.find(' ');
    const auto text = space == std::string::npos ? std::string() : line.substr(space + 1);
    auto tranche = line_for(text) == line + "\n" ? tranche_in(text, datasets_) : std::nullopt;
    const auto fault =
        tranche ? fault_of(*tranche) : fmt::format("{}:{}: damaged", (folder_ / "journal").string(), number);
    if (fault.empty()) {
        finished_.push_back(std::move(*tranche));
        return true;
    }
    sum_ = before;
    notes_.push_back(fault + "; what was done from there on is made again");
    return false;
}

std::string Workplace::fault_of(const Tranche& tranche) const {
    for (const auto& [dataset, shard] : tranche.shards) {
        const auto path = data() / shard.entry.file;
        if (std::error_code missing; fs::file_size(path, missing) != shard.entry.bytes || missing)
            return fmt::format("{}: missing, or of another size", path.string());
        const auto announced = announced_.find(shard.entry.file);
        if (const auto sum = checksum_file(path);
            sum != shard.checksum && (announced == announced_.end() || sum != announced->second))
            return fmt::format("{}: changed since it was written", path.string());
    }
    return {};
}

void Workplace::announce(const std::map<fs::path, std::string>& to_be) {
    for (const auto& [path, sum] : to_be) announced_[path.lexically_relative(data())] = sum;
    std::string text;
    for (const auto& [file, sum] : announced_) text += fmt::format("{} {}\n", sum, file.string());
    write_whole(folder_ / "announced", text);
}

void Workplace::read_announced() {
    std::ifstream file(folder_ / "announced", std::ios::binary);
    std::string sum, path;
    while (file >> sum && file.get() == ' ' && std::getline(file, path)) announced_[path] = sum;
}

void Workplace::remove_unfinished() const {
    std::set<fs::path> known;
    for (const auto& tranche : finished_)
        for (const auto& [dataset, shard] : tranche.shards) known.insert(data() / shard.entry.file);
    std::vector<fs::path> unfinished;
    if (fs::exists(data()))
        for (const auto& entry : fs::recursive_directory_iterator(data()))
            if (!entry.is_directory() && !known.contains(entry.path())) unfinished.push_back(entry.path());
    for (const auto& path : unfinished) fs::remove(path);
}

void Workplace::start_afresh(const std::string& request) {
    finished_.clear();
    sum_.clear();
    fs::remove(folder_ / "journal");
    fs::remove(folder_ / "announced");
    fs::remove_all(data());
    make_folders(data());
    append(folder_ / "journal", line_for(request));
}

void Workplace::finish(Tranche tranche) {
    append(folder_ / "journal", line_for(text_of(to_json(tranche))));
    finished_.push_back(std::move(tranche));
}

void Workplace::deliver(const fs::path& out) {
    put_in_place(data(), folder_, out);
    discard();
}

void Workplace::discard() {
    remove_workplace(folder_);
    finished_.clear();
}

}  // namespace actformer::ingest
