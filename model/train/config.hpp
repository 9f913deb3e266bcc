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
    std::string name;
    Value preset;
    std::string meaning;
    double least = std::numeric_limits<double>::lowest(), most = std::numeric_limits<double>::max();
    std::vector<std::string> choices = {};  ///< for text; empty allows any
};

class Config {
  public:
    /// Every key at its preset. `model` names what is trained, as in "recogniser": a file must say `model: recogniser`.
    Config(std::string model, std::vector<Key> keys);

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

    /// "batch is 64 there and 32 here" for each key that differs from `other`, those in `ignored` apart.
    std::vector<std::string> differences(const Config& other, const std::vector<std::string>& ignored) const;

  private:
    const Value& value(const std::string& name) const;
    void take(const YAML::Node& root, const std::string& where);
    std::size_t index_of(const std::string& name, const std::string& where) const;

    std::string model_;
    std::vector<Key> keys_;
    std::vector<Value> values_;
};

/// What a configuration's line `model:` says; empty where there is none, or no such file.
std::string model_named_in(const std::filesystem::path& file);

}  // namespace actformer::model
