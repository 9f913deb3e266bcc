#include "reports/page/measured.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "base/text/loose_json.hpp"
#include "reports/page/curves.hpp"
#include "reports/page/training.hpp"
#include "reports/same_path.hpp"
#include "reports/tables/own_tables.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The member's elements that are objects.
std::vector<Json> objects(const Json& object, const char* key) {
    std::vector<Json> out;
    std::ranges::copy_if(loose::list(object, key), std::back_inserter(out),
                         [](const Json& one) { return one.is_object(); });
    return out;
}

void add_own_tables(std::vector<PaperTable>& tables, const Json& results, const fs::path& folder) {
    const auto text = loose::text(results, "tables");
    if (text.empty()) return;
    const YamlPlace place{(folder / "results.json").string() + ": tables"};
    try {
        tables = with_own_tables(std::move(tables), YAML::Load(text), place);
    } catch (const YAML::Exception& e) {
        throw Error("{}: line {}: {}", place.file, e.mark.line + 1, e.msg);
    }
}

/// What tells the version that wrote it has a checksum too.
bool is_damaged(const Json& json, const Json& version) {
    const auto said = own_checksum_of(json);
    return said == OwnChecksum::wrong || (said == OwnChecksum::absent && version.is_string());
}

Json read_results(const fs::path& folder) {
    const auto path = folder / "results.json";
    if (!fs::exists(folder))
        throw Error("{}: no such file or folder{}", folder.string(), did_you_mean(folder));
    if (!fs::is_directory(folder))
        throw Error("{}: a file; the folder of a sweep, a training or a comparison is expected",
                    folder.string());
    if (!fs::is_regular_file(path))
        throw Error(
            "{}: no results.json in it; give the folder that `actformer sweep FILE -o FOLDER` or a training "
            "wrote",
            folder.string());
    auto json = loose::read(path);
    if (!loose::member(json, "rows").is_array() || is_damaged(json, loose::member(json, "version")))
        throw Error("{}: damaged, or not a sweep's results; `actformer sweep` again writes it anew",
                    path.string());
    if (loose::member(json, "format") != Json(1))
        throw Error("{}: results of another version of actformer; `actformer sweep` again writes them anew",
                    path.string());
    return json;
}

/// What the scores of a run that is done say; null and a notice where they cannot be read.
Json read_scores(const MeasuredRun& run, const std::string& row, std::vector<std::string>& notices) {
    if (run.status != "done") return {};
    Json json;
    try {
        json = loose::read(run.scores);
    } catch (const Error& e) {
        notices.push_back(fmt::format("{}, seed {}: {}", row, run.seed, e.what()));
        return {};
    }
    const auto& origin = loose::member(json, "provenance");
    if (json.is_object() && !is_damaged(json, loose::member(origin, "version"))) return json;
    notices.push_back(fmt::format("{}, seed {}: {} is {}; `actformer sweep` again makes it anew", row,
                                  run.seed, run.scores.string(),
                                  fs::exists(run.scores) ? "damaged" : "missing"));
    return {};
}

MeasuredRun read_run(const Json& json, const fs::path& folder) {
    MeasuredRun run;
    if (const auto& seed = loose::member(json, "seed"); seed.is_number_unsigned()) run.seed = seed;
    run.status = loose::text(json, "status");
    run.why = loose::text(json, "why");
    const auto path = [&](const char* key) {
        const auto said = loose::text(json, key);
        return said.empty() ? fs::path() : folder / said;  // whole paths stay as they are
    };
    run.scores = path("scores");
    run.features = path("features");
    run.motions = path("motions");
    run.run = path("run");
    run.recogniser = path("recogniser");
    run.dataset = path("dataset");
    return run;
}

/// "660 synthetic clips (seed 1)", "recordings in a.zip and b.zip".
std::string data_in_words(const Json& row) {
    const auto& data = loose::member(row, "data");
    const auto name = "‘" + loose::text(row, "dataset") + "’";
    if (const auto& clips = loose::member(data, "synthetic"); clips.is_number_unsigned())
        return fmt::format("{}: {} clip{} of synthetic people, no one was recorded", name,
                           clips.get<std::uint64_t>(), clips == 1 ? "" : "s");
    std::string raw;
    for (const auto& file : loose::list(data, "raw"))
        if (file.is_string()) raw += (raw.empty() ? "" : ", ") + file.get<std::string>();
    if (!raw.empty()) return fmt::format("{}: recordings in {}", name, raw);
    const auto path = loose::text(data, "path");
    return path.empty() ? name : fmt::format("{}: the dataset in {}", name, path);
}

/// What the scores of any run tell of the motions they were measured on.
ingest::DataOrigin origin_in(const std::vector<MeasuredRun>& runs) {
    ingest::DataOrigin out;
    for (const auto& run : runs) {
        const auto& said =
            loose::member(loose::member(loose::member(run.scored, "provenance"), "real"), "origin");
        for (const auto kind : ingest::DataOrigin::kinds)
            if (loose::text(said, "data") == ingest::name_of(kind)) out.kind = kind;
        if (const auto skeleton = loose::text(said, "skeleton"); !skeleton.empty()) out.skeleton = skeleton;
        if (const auto part = loose::text(said, "part"); !part.empty()) out.part = part;
    }
    return out;
}

MeasuredRow read_row(const Json& json, const std::string& sweep, const fs::path& folder,
                     std::vector<std::string>& notices) {
    MeasuredRow row;
    row.sweep = sweep;
    row.name = loose::text(json, "name");
    row.status = loose::text(json, "status");
    row.why = loose::text(json, "why");
    for (const auto& cell : loose::list(json, "fills"))
        if (cell.is_string()) row.fills.push_back(cell);
    row.dataset = loose::text(json, "dataset");
    row.split = loose::text(json, "split");
    row.data = data_in_words(json);
    row.settings = json.value("settings", Json::object());
    for (const auto& one : objects(json, "runs")) {
        auto run = read_run(one, folder);
        run.scored = read_scores(run, row.name, notices);
        row.runs.push_back(std::move(run));
    }
    row.origin = origin_in(row.runs);
    return row;
}

/// Under its path where another row has its name.
void add_training(MeasuredRow row, const fs::path& folder, std::vector<MeasuredRow>& rows) {
    if (std::ranges::any_of(rows, [&](const auto& one) { return one.name == row.name; }))
        row.name = fs::weakly_canonical(folder).string();
    rows.push_back(std::move(row));
}

}  // namespace

const MeasuredRun* MeasuredRow::shown() const {
    const auto found =
        std::ranges::find_if(runs, [](const MeasuredRun& run) { return !run.scored.is_null(); });
    return found == runs.end() ? nullptr : &*found;
}

const MeasuredRun* MeasuredRow::trained() const {
    if (const auto* run = shown()) return run;
    const auto found = std::ranges::find_if(
        runs, [](const MeasuredRun& run) { return !run.run.empty() && has_log(run.run); });
    if (found != runs.end()) return &*found;
    return runs.empty() ? nullptr : &runs.front();
}

Measured read_measured(const std::vector<fs::path>& folders) {
    if (const auto again = given_twice(folders))
        throw Error("{}: given twice; name each folder once", again->string());
    Measured out;
    for (std::size_t i = 0; i < folders.size(); ++i) {
        const auto& folder = folders[i];
        if (auto row = training_row(folder)) {
            add_training(std::move(*row), folder, out.rows);
            continue;
        }
        const auto json = read_results(folder);
        add_own_tables(out.tables, json, folder);
        for (const auto& row : objects(json, "rows")) {
            out.rows.push_back(read_row(row, loose::text(json, "sweep"), fs::absolute(folder), out.notices));
            if (loose::member(json, "comparison") == Json(true)) out.rows.back().comparison = i;
        }
    }
    return out;
}

}  // namespace actformer::reports
