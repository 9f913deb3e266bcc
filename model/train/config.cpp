#include "model/train/config.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/nearest_word.hpp"
#include "base/text/printable.hpp"
#include "base/text/yaml.hpp"

namespace actformer::model {
namespace {

template <typename T>
std::optional<T> number_of(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<bool> truth_of(const std::string& text) {
    if (text == "true" || text == "yes" || text == "on") return true;
    if (text == "false" || text == "no" || text == "off") return false;
    return std::nullopt;
}

std::string range_of(const Key& key) {
    const bool bounded = key.least > std::numeric_limits<double>::lowest();
    if (key.most < std::numeric_limits<double>::max())
        return fmt::format(" from {:g} to {:g}", key.least, key.most);
    return bounded ? fmt::format(" of at least {:g}", key.least) : "";
}

std::string what_is_wanted(const Key& key) {
    struct Say {
        const Key& key;
        std::string operator()(bool) const { return "true or false"; }
        std::string operator()(std::int64_t) const { return "a whole number" + range_of(key); }
        std::string operator()(double) const { return "a number" + range_of(key); }
        std::string operator()(const std::string&) const {
            if (key.choices.empty()) return "text in UTF-8";
            return fmt::format("one of {}", fmt::join(key.choices, ", "));
        }
        std::string operator()(const std::vector<std::int64_t>&) const {
            return "a list of whole numbers" + range_of(key) + ", as in [10, 50]";
        }
    };
    return std::visit(Say{key}, key.preset);
}

bool in_range(const Key& key, double value) {
    return value >= key.least && value <= key.most;
}

std::string scalar(const YAML::Node& node) {
    return node.IsScalar() ? node.Scalar() : std::string();
}

std::string quoted(const std::string& text) {
    YAML::Emitter out;
    out << YAML::DoubleQuoted << text;
    return out.c_str();
}

/// False where it comes back changed: bytes that are no UTF-8, of which YAML's library takes what it does not write.
bool can_be_written(const std::string& text) {
    return YAML::Load(quoted(text)).Scalar() == text;
}

/// The node's value in the key's type; none where it is of another type or out of range.
std::optional<Value> parse(const Key& key, const YAML::Node& node) {
    struct As {
        const Key& key;
        const YAML::Node& node;
        std::optional<Value> operator()(bool) const { return truth_of(scalar(node)); }
        std::optional<Value> operator()(std::int64_t) const {
            const auto number = number_of<std::int64_t>(scalar(node));
            if (!number || !in_range(key, static_cast<double>(*number))) return std::nullopt;
            return *number;
        }
        std::optional<Value> operator()(double) const {
            const auto number = number_of<double>(scalar(node));
            if (!number || !std::isfinite(*number) || !in_range(key, *number)) return std::nullopt;
            return *number;
        }
        std::optional<Value> operator()(const std::string&) const {
            if (node.IsNull()) return std::string();
            if (!node.IsScalar()) return std::nullopt;
            const auto& text = node.Scalar();
            const auto& known = key.choices;
            const bool is_known = known.empty() || std::ranges::find(known, text) != known.end();
            return is_known && can_be_written(text) ? std::optional<Value>(text) : std::nullopt;
        }
        std::optional<Value> operator()(const std::vector<std::int64_t>&) const {
            if (!node.IsSequence()) return std::nullopt;
            std::vector<std::int64_t> numbers;
            for (const auto& item : node) {
                const auto number = number_of<std::int64_t>(scalar(item));
                if (!number || !in_range(key, static_cast<double>(*number))) return std::nullopt;
                numbers.push_back(*number);
            }
            return numbers;
        }
    };
    return std::visit(As{key, node}, key.preset);
}

Value parsed(const Key& key, const YAML::Node& node, const std::string& where) {
    if (auto value = parse(key, node)) return *value;
    YAML::Emitter given;
    given << YAML::Flow << node;
    throw Error("{}: {} must be {}, not {}", where, key.name, what_is_wanted(key), in_quotes(given.c_str()));
}

std::string text_of(const Value& value) {
    struct Say {
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return std::to_string(v); }
        std::string operator()(double v) const { return fmt::format("{}", v); }
        std::string operator()(const std::string& v) const { return quoted(v); }
        std::string operator()(const std::vector<std::int64_t>& v) const {
            return fmt::format("[{}]", fmt::join(v, ", "));
        }
    };
    return std::visit(Say{}, value);
}

/// None where it is not there. Throws Error where it cannot be read, or is larger than any configuration.
std::optional<std::string> configuration_text(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    std::vector<char> scratch;
    return std::string(read_text(file, scratch, largest_yaml));
}

}  // namespace

std::string model_named_in(const std::filesystem::path& file) try {
    const auto text = configuration_text(file);
    if (!text) return {};
    const auto root = YAML::Load(*text);
    return root.IsMap() && root["model"] ? scalar(root["model"]) : "";
} catch (const YAML::Exception&) {
    return {};
}

Config::Config(std::string model, std::vector<Key> keys, std::vector<std::string> other_names)
    : model_(std::move(model)), keys_(std::move(keys)), other_names_(std::move(other_names)) {
    for (const auto& key : keys_) values_.push_back(key.preset);
}

std::size_t Config::index_of(const std::string& name, const std::string& where) const {
    std::vector<std::string> names{"model"};
    for (std::size_t i = 0; i < keys_.size(); ++i) {
        if (keys_[i].name == name) return i;
        names.push_back(keys_[i].name);
    }
    const auto nearest = nearest_word(name, names);
    if (nearest.empty()) {
        std::sort(names.begin(), names.end());
        throw Error("{}: there is no key '{}'; the keys are {}", where, printable(name),
                    fmt::join(names, ", "));
    }
    throw Error("{}: there is no key '{}'; did you mean '{}'?", where, printable(name), nearest);
}

bool Config::has(const std::string& name) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const Key& key) { return key.name == name; });
}

const Value& Config::value(const std::string& name) const {
    return values_[index_of(name, "configuration")];
}

void Config::load(const std::filesystem::path& file) {
    const auto text = configuration_text(file);
    if (!text) throw Error("{}: cannot be read; is the path right?", file.string());
    load_text(*text, file.string());
}

void Config::load_text(const std::string& text, const std::string& where) {
    try {
        take(YAML::Load(text), where);
    } catch (const YAML::Exception& e) {
        throw Error("{}:{}: no YAML: {}", where, e.mark.line + 1, e.msg);
    }
}

void Config::take(const YAML::Node& root, const std::string& file) {
    if (!root.IsMap()) throw Error("{}: not a list of `key: value` lines", file);
    if (const auto bad = bad_key(root)) throw Error("{}:{}: {}", file, bad->line, bad->what);
    for (const auto& entry : root) {
        const auto where = fmt::format("{}:{}", file, entry.first.Mark().line + 1);
        const auto name = scalar(entry.first);
        if (name == "model") {
            const auto named = scalar(entry.second);
            if (named == model_ || (!named.empty() && std::ranges::count(other_names_, named) > 0)) continue;
            throw Error("{}: a configuration for model {}, not '{}'", where, in_quotes(named), model_);
        }
        const auto i = index_of(name, where);
        values_[i] = parsed(keys_[i], entry.second, where);
    }
    if (!root["model"] && std::ranges::count(other_names_, "") == 0)
        throw Error("{}: the line `model: {}` is missing", file, model_);
}

void Config::override_with(const std::string& assignment) {
    const auto where = fmt::format("'{}'", printable(assignment));
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) throw Error("{}: overrides are written key=value", where);
    if (assignment.substr(0, equals) == "model")
        throw Error("{}: a configuration's model cannot be overridden; choose a configuration of it with -c",
                    where);
    const auto i = index_of(assignment.substr(0, equals), where);
    const auto text = assignment.substr(equals + 1);
    YAML::Node node(text);
    if (std::holds_alternative<std::vector<std::int64_t>>(keys_[i].preset)) try {
            node = YAML::Load(text.starts_with('[') ? text : "[" + text + "]");
        } catch (const YAML::Exception&) {
            throw Error("{}: {} must be {}", where, keys_[i].name, what_is_wanted(keys_[i]));
        }
    values_[i] = parsed(keys_[i], node, where);
}

std::string Config::yaml() const {
    std::string out = fmt::format("model: {}\n", model_);
    for (std::size_t i = 0; i < keys_.size(); ++i)
        out += fmt::format("{}: {}  # {}\n", keys_[i].name, text_of(values_[i]), keys_[i].meaning);
    return out;
}

std::vector<std::string> Config::differences(const Config& other) const {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < keys_.size(); ++i) {
        if (keys_[i].free || values_[i] == other.values_[i]) continue;
        out.push_back(fmt::format("{} is {} there and {} here", keys_[i].name, text_of(other.values_[i]),
                                  text_of(values_[i])));
    }
    return out;
}

}  // namespace actformer::model
