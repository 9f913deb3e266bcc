#include "ingest/dataset/dataset_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

using Json = nlohmann::ordered_json;

Json splits_to_json(const std::vector<Split>& splits) {
    Json out = Json::object();
    for (const auto& split : splits) {
        Json conditions = Json::array();
        for (const auto& c : split.conditions)
            conditions.push_back({{"field", c.field}, {c.negated ? "not_in" : "in", c.values}});
        out[split.name] = conditions;
    }
    return out;
}

std::vector<Split> splits_from_json(const Json& json) {
    std::vector<Split> out;
    for (const auto& [name, conditions] : json.items()) {
        Split split{name, {}};
        for (const auto& c : conditions) {
            const bool negated = c.contains("not_in");
            split.conditions.push_back({c.at("field").get<std::string>(),
                                        c.at(negated ? "not_in" : "in").get<std::vector<std::string>>(),
                                        negated});
        }
        out.push_back(std::move(split));
    }
    return out;
}

/// (joints, 3) as rows; the shortest decimals that give the same float32 back.
Json rest_to_json(const std::vector<float>& rest) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < rest.size(); i += 3) {
        Json row = Json::array();
        for (std::size_t d = 0; d < 3; ++d) row.push_back(std::stod(fmt::format("{}", rest[i + d])));
        rows.push_back(row);
    }
    return rows;
}

std::vector<float> rest_from_json(const Json& json, const DatasetHeader& header, const std::string& where) {
    std::vector<float> rest;
    for (const auto& row : json.value("rest", Json::array()))
        for (const auto x : row.get<std::array<float, 3>>()) rest.push_back(x);
    const bool rotations = header.representation == Representation::rot6d;
    if (rotations ? rest.size() != header.topology.joints() * 3 : !rest.empty())
        throw Error("{}: 'rest' has {} offsets for {} joints in representation {}; ingest the raw data again",
                    where, rest.size() / 3, header.topology.joints(), header.representation.name());
    if (!std::ranges::all_of(rest, [](float x) { return std::isfinite(x); }))
        throw Error("{}: 'rest' holds numbers that are not finite", where);
    return rest;
}

/// Datasets of earlier versions do not tell it.
DataOrigin origin_from_json(const Json& json, const std::string& where) {
    DataOrigin origin;
    const auto said = json.value("origin", Json::object());
    if (said.contains("data")) origin.kind = origin_named(said.at("data").get<std::string>(), where);
    origin.skeleton = said.value("skeleton", "");
    origin.part = said.value("part", "");
    return origin;
}

/// They lie beside dataset.json, each once.
void check_shards(const std::vector<ShardEntry>& shards, const std::string& where) {
    std::set<std::string_view> seen;
    for (const auto& shard : shards) {
        const std::filesystem::path file = shard.file;
        if (!lies_below(file) || file.has_parent_path())
            throw Error("{}: shard {} is no file's name; ingest the raw data again", where,
                        in_quotes(shard.file));
        if (!seen.insert(shard.file).second)
            throw Error("{}: shard {} is there twice; ingest the raw data again", where,
                        in_quotes(shard.file));
    }
}

/// Every field is read of every clip.
void check_columns(const std::vector<std::string>& fields, const std::string& where) {
    if (fields.size() > most_fields)
        throw Error("{}: {} fields, and a clip has at most {}; ingest the raw data again", where,
                    fields.size(), most_fields);
    std::set<std::string_view> seen;
    for (const auto& field : fields)
        if (!seen.insert(field).second)
            throw Error("{}: field {} is there twice; ingest the raw data again", where, in_quotes(field));
}

DatasetFile from_json(const Json& json, const std::string& where) {
    if (const auto format = whole_number<int>(json.at("format")); format < 1 || format > dataset_format)
        throw Error(
            "{}: format {}, but this program reads formats 1 to {}; use the version it was written with ({})",
            where, format, dataset_format, json.value("program", "unknown"));
    const bool of_old = json.at("format") < first_format_with_checksum && !json.contains("checksum");
    if (!of_old && own_checksum_of(json) == OwnChecksum::wrong)
        throw Error(
            "{}: damaged: its checksum is {}; copy it again, or ingest the raw data again. If you edited it, "
            "take out its members \"checksum\" and \"program\"",
            where, json.contains("checksum") ? "of other contents" : "missing");
    DatasetFile file;
    auto& header = file.header;
    header.name = json.at("name").get<std::string>();
    header.representation = Representation::named(json.at("representation").get<std::string>(), where);
    header.fps = json.at("fps").get<double>();
    header.persons = whole_number<std::uint32_t>(json.at("persons"));
    header.centre_windows = json.value("centre", "clip") == "window";
    header.topology.names = json.at("topology").at("names").get<std::vector<std::string>>();
    for (const auto& parent : json.at("topology").at("parents"))
        header.topology.parents.push_back(whole_number<int>(parent));
    header.classes = json.at("classes").get<std::vector<std::string>>();
    header.fields = json.at("fields").get<std::vector<std::string>>();
    check_columns(header.fields, where);
    header.splits = splits_from_json(json.at("splits"));
    file.settings = json.at("settings").get<std::string>();
    file.fingerprint = json.at("source").get<std::string>();
    for (const auto& shard : json.at("shards")) file.shards.push_back(shard_from_json(shard));
    check_shards(file.shards, where);
    file.remarks = json.value("remarks", std::vector<std::string>());
    header.topology.check(where);
    header.rest = rest_from_json(json, header, where);
    header.origin = origin_from_json(json, where);
    if (header.persons == 0 || !(header.fps > 0) || !std::isfinite(header.fps))
        throw Error("{}: persons and fps must be above 0", where);
    return file;
}

}  // namespace

Json to_json(const DataOrigin& origin) {
    Json said = Json::object();
    if (origin.kind) said["data"] = name_of(*origin.kind);
    if (!origin.skeleton.empty()) said["skeleton"] = origin.skeleton;
    if (!origin.part.empty()) said["part"] = origin.part;
    return said;
}

Json to_json(const ShardEntry& shard) {
    Json json{{"file", shard.file},
              {shard.checksum_of_bytes ? "checksum" : "contents", shard.checksum},
              {"bytes", shard.bytes},
              {"clips", shard.clips},
              {"frames", shard.frames}};
    if (!shard.metadata.empty()) json["metadata"] = shard.metadata;
    return json;
}

ShardEntry shard_from_json(const nlohmann::json& json) {
    const bool of_bytes = !json.contains("contents");
    return {json.at("file").get<std::string>(),
            json.at(of_bytes ? "checksum" : "contents").get<std::string>(),
            whole_number<std::uint64_t>(json.at("bytes")),
            whole_number<std::uint64_t>(json.at("clips")),
            whole_number<std::uint64_t>(json.at("frames")),
            of_bytes,
            json.value("metadata", "")};
}

bool lies_below(const std::filesystem::path& file) {
    return file.is_relative() && file.has_filename() &&
           std::none_of(file.begin(), file.end(),
                        [](const std::filesystem::path& part) { return part == "." || part == ".."; });
}

std::string to_text(const DatasetFile& file) {
    const auto& header = file.header;
    Json shards = Json::array();
    std::uint64_t clips = 0, frames = 0;
    for (const auto& shard : file.shards) {
        shards.push_back(to_json(shard));
        clips += shard.clips;
        frames += shard.frames;
    }
    Json json{{"format", dataset_format},
              {"program", "actformer " ACTFORMER_VERSION},
              {"name", header.name},
              {"representation", header.representation.name()},
              {"fps", header.fps},
              {"persons", header.persons},
              {"clips", clips},
              {"frames", frames},
              {"topology", {{"names", header.topology.names}, {"parents", header.topology.parents}}},
              {"classes", header.classes},
              {"fields", header.fields},
              {"splits", splits_to_json(header.splits)},
              {"settings", file.settings},
              {"source", file.fingerprint},
              {"shards", shards}};
    if (!header.rest.empty()) json["rest"] = rest_to_json(header.rest);
    if (header.origin != DataOrigin{}) json["origin"] = to_json(header.origin);
    if (header.centre_windows) json["centre"] = "window";
    if (!file.remarks.empty()) json["remarks"] = file.remarks;
    return with_checksum(std::move(json)).dump(1) + "\n";
}

DatasetFile read_dataset_json(const std::filesystem::path& path) {
    std::vector<char> scratch;
    const auto text = read_text(path, scratch, std::uint64_t{256} << 20);
    expect_shallow_json(text, path);
    try {
        return from_json(Json::parse(text), path.string());
    } catch (const Json::exception& e) {
        throw Error("{}: damaged: {}; ingest the raw data again", path.string(), printable(e.what()));
    }
}

}  // namespace actformer::ingest
