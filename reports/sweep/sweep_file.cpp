#include "reports/sweep/sweep_file.hpp"

#include <yaml-cpp/depthguard.h>

#include <algorithm>

#include "base/files/file.hpp"
#include "base/files/regular_file.hpp"
#include "base/text/printable.hpp"
#include "base/text/suggestion.hpp"
#include "base/text/utf8.hpp"
#include "base/text/yaml.hpp"
#include "ingest/formats/formats.hpp"
#include "reports/sweep/configuration.hpp"
#include "reports/tables/own_tables.hpp"

namespace actformer::reports {
namespace {

using Node = YAML::Node;
using Place = YamlPlace;

/// An entry's keys with those of what it is like, each with the node that says it.
using Entry = std::map<std::string, Node>;

/// Whether an entry says anything of a key: `split: ~` does not.
bool says(const Entry& entry, const std::string& key) {
    const auto found = entry.find(key);
    return found != entry.end() && !found->second.IsNull();
}

/// A setting of `above` without a value takes the one below away.
Node joined_settings(const Node& below, const Node& above) {
    Node out(YAML::NodeType::Map);
    for (const auto& item : below) out[item.first.Scalar()] = item.second;
    for (const auto& item : above) {
        if (item.second.IsNull())
            out.remove(item.first.Scalar());
        else
            out[item.first.Scalar()] = item.second;
    }
    return out;
}

void lay_over(Entry& entry, const std::string& key, const Node& value) {
    const auto found = entry.find(key);
    const bool joins = key == "set" && found != entry.end() && found->second.IsMap() && value.IsMap();
    const auto node = joins ? joined_settings(found->second, value) : value;
    entry.erase(key);  // to assign to a node would change it in all entries that share it
    entry.emplace(key, node);
}

/// Of an entry's settings too each key once, before they are joined with others.
void expect_entry(const Place& place, const Node& node, const std::string& what) {
    place.expect_map(node, what);
    if (const auto set = node["set"]; set && set.IsMap()) place.expect_keys(set, what + ", set");
}

/// One section's entries with `like` resolved.
class Section {
  public:
    Section(const Place& place, const Node& node, std::string name, Entry base)
        : place_(place), node_(node), name_(std::move(name)), base_(std::move(base)) {}

    Entry entry(const std::string& name) {
        if (std::find(path_.begin(), path_.end(), name) != path_.end()) {
            std::string circle;
            for (const auto& step : path_) circle += step + " -> ";
            place_.fail(node_[name], fmt::format("{}: a circle of like: {}{}", name_, circle, name));
        }
        constexpr std::size_t deepest = 64;
        if (path_.size() == deepest)
            place_.fail(node_[name],
                        fmt::format("{}: more than {} entries like each other in a row; say what they share "
                                    "in base",
                                    name_, deepest));
        const auto own = node_[name];
        expect_entry(place_, own, fmt::format("{}: '{}'", name_, name));
        path_.push_back(name);
        Entry out = base_;
        if (const auto like = own["like"]; like && !like.IsNull()) {
            const auto other = place_.as<std::string>(like, "like", "a name");
            if (!node_[other])
                place_.fail(like, fmt::format("{}: there is no '{}' to be like{}", name_, other,
                                              suggestion(other, names())));
            out = entry(other);
            out.erase("fills");
        }
        path_.pop_back();
        for (const auto& item : own)
            if (item.first.Scalar() != "like") lay_over(out, item.first.Scalar(), item.second);
        return out;
    }

  private:
    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const auto& item : node_) out.push_back(item.first.Scalar());
        return out;
    }

    const Place& place_;
    Node node_;
    std::string name_;
    Entry base_;
    std::vector<std::string> path_;
};

/// Takes an entry's keys one by one; what is left at the end nobody knows.
class Taker {
  public:
    Taker(const Place& place, Entry entry) : place_(place), entry_(std::move(entry)) {}

    void text(const char* key, std::string& to) {
        take(key, [&](const Node& n) { to = place_.as<std::string>(n, key, "a text"); });
    }
    void number(const char* key, std::uint64_t& to) {
        take(key, [&](const Node& n) { to = place_.as<std::uint64_t>(n, key, "a whole number"); });
    }
    void at_least_one(const char* key, std::uint64_t& to) {
        take(key, [&](const Node& n) {
            to = place_.as<std::uint64_t>(n, key, "a whole number");
            if (to == 0) place_.fail(n, fmt::format("'{}' must be at least 1", key));
        });
    }
    template <typename T>
    void list(const char* key, std::vector<T>& to, const char* kind) {
        take(key, [&](const Node& n) {
            to.clear();
            if (n.IsScalar()) return to.push_back(place_.as<T>(n, key, kind));
            place_.expect_list(n, fmt::format("'{}'", key));
            for (const auto& item : n) to.push_back(place_.as<T>(item, key, kind));
        });
    }
    void settings(const char* key, Settings& to) {
        take(key, [&](const Node& n) {
            place_.expect_map(n, fmt::format("'{}'", key));
            for (const auto& item : n)
                if (!item.second.IsNull())
                    to[item.first.Scalar()] =
                        place_.as<std::string>(item.second, item.first.Scalar(), "one value");
        });
    }
    void end(const std::string& of) {
        known_.emplace_back("like");
        for (const auto& [key, node] : entry_)
            place_.fail(node, fmt::format("{} has no key '{}'{}; it takes {}", of, key,
                                          suggestion(key, known_), fmt::join(known_, ", ")));
    }

  private:
    template <typename Use>
    void take(const char* key, Use use) {
        known_.emplace_back(key);
        const auto found = entry_.find(key);
        if (found == entry_.end()) return;
        if (!found->second.IsNull()) use(found->second);
        entry_.erase(found);
    }

    const Place& place_;
    Entry entry_;
    std::vector<std::string> known_;  ///< the keys that were asked for
};

void check_format(const Place& place, const Node& where, const std::string& dataset,
                  const std::string& format) {
    std::vector<std::string> known;
    for (const auto& one : ingest::formats()) known.emplace_back(one.name);
    if (std::ranges::find(known, format) == known.end())
        place.fail(where, fmt::format("dataset '{}': there is no format '{}'{}; there are {}", dataset,
                                      format, suggestion(format, known), fmt::join(known, ", ")));
}

/// Keys that say nothing of a dataset that is `there` by that key.
void refuse_beside(const Place& place, const std::string& name, const Entry& entry, const char* there,
                   std::initializer_list<const char*> keys) {
    if (!says(entry, there)) return;
    for (const char* key : keys)
        if (says(entry, key))
            place.fail(entry.at(key),
                       fmt::format("dataset '{}': '{}' says nothing beside '{}'; leave it out, or take "
                                   "an inherited one away with `{}: ~`",
                                   name, key, there, key));
}

/// A setting that is overwritten by what the entry's key `instead` says.
void refuse_in_set(const Place& place, const std::string& of, const Entry& entry, const char* setting,
                   const char* instead) {
    const auto set = entry.find("set");
    if (set == entry.end() || !set->second.IsMap()) return;
    if (const auto said = set->second[setting]; said && !said.IsNull())
        place.fail(said,
                   fmt::format("{}: '{}' says nothing in 'set'; say {} beside it", of, setting, instead));
}

/// Motions that are there need no generator. A configuration may come from the base, or from the row that this one is like.
void refuse_beside_motions(const Place& place, const Node& own, const std::string& name, const Entry& entry) {
    if (!says(entry, "motions")) return;
    const auto refuse = [&](const Node& node, const char* key) {
        place.fail(node,
                   fmt::format("row '{}': '{}' says nothing beside 'motions'; leave one of them out (`~` "
                               "takes an inherited one away)",
                               name, key));
    };
    if (says(entry, "weights")) refuse(entry.at("weights"), "weights");
    if (const auto config = own["config"]; config && !config.IsNull()) refuse(config, "config");
}

SweepDataset dataset(const Place& place, const Node& where, const std::string& name, Entry entry) {
    refuse_beside(place, name, entry, "path", {"format", "arguments", "seed", "actions", "use"});
    refuse_beside(place, name, entry, "raw", {"seed", "actions"});
    Taker take(place, std::move(entry));
    SweepDataset out;
    take.text("path", out.path);
    take.text("format", out.format);
    take.list("raw", out.raw, "paths");
    take.list("arguments", out.arguments, "words");
    take.number("clips", out.clips);
    take.number("seed", out.seed);
    take.text("actions", out.actions);
    take.text("use", out.use);
    take.end("a dataset");
    if (!out.path.empty() + !out.raw.empty() + (out.clips > 0) != 1)
        place.fail(where, fmt::format("dataset '{}' must say one of path, raw and clips", name));
    check_format(place, where, name, out.format);
    return out;
}

SweepRecogniser recogniser(const Place& place, const Node& where, const std::string& name, Entry entry) {
    refuse_in_set(place, fmt::format("recogniser '{}'", name), entry, "data", "data");
    Taker take(place, std::move(entry));
    SweepRecogniser out;
    take.text("data", out.data);
    take.text("config", out.config);
    take.text("weights", out.weights);
    take.settings("set", out.set);
    take.end("a recogniser");
    if (out.weights.empty() && (out.data.empty() || out.config.empty()))
        place.fail(where, fmt::format("recogniser '{}' must say data and config, or weights", name));
    return out;
}

SweepRow row(const Place& place, const Node& where, const std::string& name, Entry entry) {
    for (const auto& [setting, instead] : {std::pair{"seed", "seeds"}, {"data", "data"}})
        refuse_in_set(place, fmt::format("row '{}'", name), entry, setting, instead);
    refuse_beside_motions(place, where, name, entry);
    Taker take(place, std::move(entry));
    SweepRow out;
    out.name = name;
    take.text("data", out.data);
    take.text("recogniser", out.recogniser);
    take.text("single_recogniser", out.single_recogniser);
    take.text("config", out.config);
    take.text("weights", out.weights);
    take.list("motions", out.motions, "paths");
    take.settings("set", out.set);
    take.list("seeds", out.seeds, "whole numbers");
    take.at_least_one("repeats", out.repeats);
    take.at_least_one("per_class", out.per_class);
    take.at_least_one("window", out.window);
    take.text("split", out.split);
    take.text("device", out.device);
    take.list("fills", out.fills, "cells");
    take.end("a row");
    if (out.data.empty() || (out.recogniser.empty() && out.single_recogniser.empty()))
        place.fail(where, fmt::format("row '{}' must say data and recogniser, or single_recogniser", name));
    if (out.config.empty() && out.weights.empty() && out.motions.empty())
        place.fail(where,
                   fmt::format("row '{}' must say config, or weights of a generator, or motions", name));
    if (out.seeds.empty()) place.fail(where, fmt::format("row '{}' has no seeds", name));
    for (auto seed = out.seeds.begin(); seed != out.seeds.end(); ++seed)
        if (std::find(out.seeds.begin(), seed, *seed) != seed)
            place.fail(where, fmt::format("row '{}' has seed {} twice: the same training is no second one",
                                          name, *seed));
    return out;
}

Entry entry_of(const Node& node) {
    Entry out;
    for (const auto& item : node) out.emplace(item.first.Scalar(), item.second);
    return out;
}

/// Calls `use(name, node, entry)` for every entry of a section, in the file's order.
template <typename Use>
void each(const Place& place, const Node& root, const std::string& name, const Entry& base, Use use) {
    const auto node = root[name];
    if (!node) return;
    place.expect_map(node, name);
    Section section(place, node, name, base);
    for (const auto& item : node) {
        const auto key = item.first.Scalar();
        use(key, item.second, section.entry(key));
    }
}

void check_references(const Place& place, const Node& root, const Sweep& sweep,
                      const std::vector<PaperTable>& tables) {
    const auto known = [&](const auto& map, const std::string& name, const Node& where, const char* what) {
        if (name.empty() || map.contains(name)) return;
        std::vector<std::string> names;
        for (const auto& [one, unused] : map) names.push_back(one);
        place.fail(where, fmt::format("there is no {} '{}'{}", what, name, suggestion(name, names)));
    };
    for (const auto& [name, r] : sweep.recognisers)
        known(sweep.datasets, r.data, root["recognisers"][name], "dataset");
    std::map<std::string, std::string> filled;
    for (const auto& r : sweep.rows) {
        const auto where = root["rows"][r.name];
        known(sweep.datasets, r.data, where, "dataset");
        known(sweep.recognisers, r.recogniser, where, "recogniser");
        known(sweep.recognisers, r.single_recogniser, where, "recogniser");
        for (const auto& cell : r.fills) {
            try {
                find_cell(cell, tables);
            } catch (const Error& e) {
                place.fail(where, fmt::format("row '{}': {}", r.name, e.what()));
            }
            const auto [other, first] = filled.try_emplace(cell, r.name);
            if (!first)
                place.fail(where,
                           fmt::format("cell '{}' is filled by '{}' and '{}'", cell, other->second, r.name));
        }
    }
}

/// Results and jobs are told in JSON, which holds no other text.
void refuse_other_than_utf8(std::string_view text, const std::string& file) {
    int line = 1;
    while (!text.empty()) {
        const auto character = first_character(text);
        if (!character) throw Error("{}: line {}: not UTF-8; save it as that", file, line);
        line += text[0] == '\n';
        text.remove_prefix(character->bytes);
    }
}

Node load(const std::filesystem::path& file) {
    refuse_irregular(file);
    std::vector<char> scratch;
    const auto text = read_text(file, scratch, largest_yaml);
    refuse_other_than_utf8(text, file.string());
    try {
        return YAML::Load(std::string(text));
    } catch (const YAML::DeepRecursion& e) {
        throw Error("{}: line {}: lists and maps too deep; is it the right file?", file.string(),
                    e.mark.line + 1);
    } catch (const YAML::Exception& e) {
        throw Error("{}: line {}: {}", file.string(), e.mark.line + 1, e.msg);
    }
}

}  // namespace

Sweep read_sweep(const std::filesystem::path& file) {
    const Place place{file.string()};
    const auto root = load(file);
    const std::vector<std::string> known{"name", "datasets", "recognisers", "base", "tables", "rows"};
    if (!root.IsMap()) throw Error("{}: holds no sweep: {}", file.string(), fmt::join(known, ", "));
    place.expect_keys(root, "a sweep");
    for (const auto& item : root) {
        const auto key = item.first.Scalar();
        if (std::ranges::find(known, key) == known.end())
            place.fail(item.first, fmt::format("a sweep has no key '{}'{}; it takes {}", key,
                                               suggestion(key, known), fmt::join(known, ", ")));
    }
    Sweep out;
    const auto own_name = root["name"];
    out.name = own_name && !own_name.IsNull() ? place.as<std::string>(own_name, "name", "a text")
                                              : printable(file.stem().string());  // as results tell it
    if (root["base"]) expect_entry(place, root["base"], "base");
    each(place, root, "datasets", {}, [&](const std::string& name, const Node& node, Entry entry) {
        out.datasets[name] = dataset(place, node, name, std::move(entry));
    });
    each(place, root, "recognisers", {}, [&](const std::string& name, const Node& node, Entry entry) {
        out.recognisers[name] = recogniser(place, node, name, std::move(entry));
    });
    const auto base = root["base"] ? entry_of(root["base"]) : Entry{};
    each(place, root, "rows", base, [&](const std::string& name, const Node& node, Entry entry) {
        out.rows.push_back(row(place, node, name, std::move(entry)));
    });
    if (out.rows.empty()) throw Error("{}: has no rows", file.string());
    const auto own = root["tables"];
    if (own) out.tables = YAML::Dump(own);
    check_references(place, root, out, own ? with_own_tables(paper_tables(), own, place) : paper_tables());
    return out;
}

}  // namespace actformer::reports
