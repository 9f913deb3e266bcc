// Settings and the configuration's keys that fill them, each said once: member, name, range, meaning; its preset is what the
// member is in the table's presets.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/train/config.hpp"

namespace actformer::model {

template <typename Settings>
class KeyTable {
  public:
    /// What settings are before a configuration is read.
    explicit KeyTable(Settings presets = {}) : presets_(std::move(presets)) {}

    /// A member of type bool, string, list of std::int64_t, any number, or an enum whose values `key.choices` name in order;
    /// `member` is a pointer to it, or a function that takes the settings and returns a reference.
    template <typename Access>
    KeyTable& add(Access member, Key key) {
        using Member = std::remove_cvref_t<std::invoke_result_t<Access, Settings&>>;
        key.preset = value_of(std::invoke(member, presets_), key);
        rows_.push_back({key, [member, key](const Config& config, Settings& settings) {
                             std::invoke(member, settings) = taken<Member>(config, key);
                         }});
        return *this;
    }

    std::vector<Key> keys() const {
        std::vector<Key> keys;
        for (const auto& row : rows_) keys.push_back(row.key);
        return keys;
    }

    Settings read(const Config& config) const {
        auto settings = presets_;
        for (const auto& row : rows_) row.take(config, settings);
        return settings;
    }

  private:
    struct Row {
        Key key;
        std::function<void(const Config&, Settings&)> take;
    };

    template <typename Member>
    static Value value_of(const Member& member, const Key& key) {
        if constexpr (std::is_enum_v<Member>)
            return key.choices.at(static_cast<std::size_t>(member));
        else if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>)
            return static_cast<std::int64_t>(member);
        else
            return member;
    }

    template <typename Member>
    static Member taken(const Config& config, const Key& key) {
        if constexpr (std::is_enum_v<Member>) {
            const auto& choices = key.choices;
            return static_cast<Member>(std::ranges::find(choices, config.get<std::string>(key.name)) -
                                       choices.begin());
        } else if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>) {
            return static_cast<Member>(config.get<std::int64_t>(key.name));
        } else {
            return config.get<Member>(key.name);
        }
    }

    Settings presets_;
    std::vector<Row> rows_;
};

}  // namespace actformer::model
