// Configurations: flat YAML files of known keys, `key=value` overrides on top, and errors that say where and what instead.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace YAML {
class Node;
}

namespace actformer::model {

using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<std::int64_t>>;

/// One key that a configuration may hold. The preset's type is the key's type.
struct Key {
    std::string name = {};
    Value preset = {};
    std::string meaning = {};
    double least = std::numeric_limits<double>::lowest(), most = std::numeric_limits<double>::max();
    std::vector<std::string> choices = {};  ///< for text; empty allows any
    bool free =
        false;  ///< may change when a training goes on: where it runs, how long, and how it is watched
};

class Config {
  public:
    /// Every key at its preset. `model` names what is trained, as in "recogniser": a file must say `model: recogniser`, or
    /// one of `other_names`; where an empty one is among these the line may be missing.
    Config(std::string model, std::vector<Key> keys, std::vector<std::string> other_names = {});

    const std::string& model() const { return model_; }

    /// Takes the values of a YAML file. Throws Error naming file, line and key: an unknown key (with the nearest known one),
    /// a key given twice, a value of another type or out of range, a file for another model.
    void load(const std::filesystem::path& file);

    /// The same of a text that `where` names.
    void load_text(const std::string& text, const std::string& where);

    /// Takes one "key=value" of the command line. Throws Error as load does.
    void override_with(const std::string& assignment);

    bool has(const std::string& name) const;

    template <typename T>
    const T& get(const std::string& name) const {
        return std::get<T>(value(name));
    }

    /// The whole configuration, key by key with its meaning: load() reads it back to the same values.
    std::string yaml() const;

    /// "batch is 64 there and 32 here" for each key that differs from `other`, those that are free to change apart.
    std::vector<std::string> differences(const Config& other) const;

    /// The same keys at their presets.
    Config blank() const { return {model_, keys_, other_names_}; }

  private:
    const Value& value(const std::string& name) const;
    void take(const YAML::Node& root, const std::string& where);
    std::size_t index_of(const std::string& name, const std::string& where) const;

    std::string model_;
    std::vector<Key> keys_;
    std::vector<Value> values_;
    std::vector<std::string> other_names_;
};

/// What a configuration's line `model:` says; empty where there is none, or no such file.
std::string model_named_in(const std::filesystem::path& file);

}  // namespace actformer::model
