#include "ingest/formats/babel/annotations.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "base/error.hpp"
#include "base/text/html.hpp"
#include "base/text/json.hpp"
#include "base/text/loose_json.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

using Json = nlohmann::ordered_json;

std::optional<double> seconds(const Json& label, const char* key, std::size_t index) {
    const auto& value = loose::member(label, key);
    if (value.is_null()) return {};
    if (!value.is_number() || !std::isfinite(value.get<double>()))
        throw Error("label {}: '{}' is no number of seconds", index, key);
    return value.get<double>();
}

std::vector<std::string> categories(const Json& label, std::size_t index) {
    const auto& value = loose::member(label, "act_cat");
    std::vector<std::string> out;
    if (value.is_null()) return out;
    if (!value.is_array()) throw Error("label {}: 'act_cat' is no list", index);
    std::unordered_set<std::string_view> seen;
    for (const auto& one : value) {
        if (!one.is_string()) throw Error("label {}: 'act_cat' holds what is no text", index);
        const auto& name = one.get_ref<const std::string&>();
        if (seen.insert(name).second) out.push_back(name);
    }
    return out;
}

/// The labels of an annotation; those of test.json are null, for they are kept secret.
std::vector<Segment> segments(const Json& annotation) {
    std::vector<Segment> out;
    const auto& labels = loose::member(annotation, "labels");
    if (labels.is_null()) return out;
    if (!labels.is_array()) throw Error("'labels' is no list");
    for (const auto& label : labels) {
        if (!label.is_object()) throw Error("label {}: no object", out.size());
        auto text = loose::text(label, "proc_label");
        if (text.empty()) text = loose::text(label, "raw_label");
        const auto index = out.size();
        out.push_back({loose::text(label, "seg_id"), std::move(text), categories(label, index),
                       seconds(label, "start_t", index), seconds(label, "end_t", index)});
    }
    return out;
}

Sequence sequence(const std::string& id, const Json& json) {
    Sequence out{id, loose::text(json, "feat_p"), {}};
    if (out.feat_p.empty()) throw Error("'feat_p' is no text");
    const auto& frames = loose::member(json, "frame_ann");
    out.segments = segments(frames.is_null() ? loose::member(json, "seq_ann") : frames);
    return out;
}

}  // namespace

std::variant<Annotations, Rejection> read_annotations(std::string_view text) {
    if (is_html(text)) return Rejection{Rejection::Kind::broken, html_in_place_of("annotations")};
    Json json;
    if (const auto line = line_too_deep(text))
        return Rejection{Rejection::Kind::broken,
                         fmt::format("line {}: lists and objects more than {} deep", *line, deepest_json)};
    try {
        json = Json::parse(text);
    } catch (const Json::exception& e) {
        return Rejection{Rejection::Kind::broken, fmt::format("no JSON: {}", printable(e.what()))};
    }
    Annotations out;
    const bool any = json.is_object() && std::any_of(json.begin(), json.end(), [](const Json& one) {
                         return one.is_object() && one.contains("feat_p");
                     });
    if (!any)
        return Rejection{Rejection::Kind::dropped,
                         "JSON, but no annotations of BABEL: no sequence has a 'feat_p'"};
    for (const auto& [id, one] : json.items()) {
        if (one.is_object() && (one.contains("seq_anns") || one.contains("frame_anns"))) {
            out.several_annotators = true;
            continue;
        }
        try {
            out.sequences.push_back(sequence(id, one));
        } catch (const Error& e) {
            out.faults.push_back(
                {Rejection::Kind::broken, fmt::format("sequence {}: {}", printable(id), e.what())});
        }
    }
    return out;
}

}  // namespace actformer::ingest
