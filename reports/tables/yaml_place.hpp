// Places in a YAML file, for messages: "sweep.yaml: line 7: ...".
#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "base/error.hpp"

namespace actformer::reports {

struct YamlPlace {
    std::string file;

    [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
        throw Error("{}: line {}: {}", file, node.Mark().line + 1, what);
    }
    void expect_map(const YAML::Node& node, const std::string& what) const {
        if (!node.IsMap()) fail(node, what + " must be a map of keys and values");
    }
    void expect_list(const YAML::Node& node, const std::string& what) const {
        if (!node.IsSequence()) fail(node, what + " must be a list");
    }
    /// `kind` says what it must be: "a whole number".
    template <typename T>
    T as(const YAML::Node& node, const std::string& key, const char* kind) const {
        try {
            return node.as<T>();
        } catch (const YAML::Exception&) {
            fail(node, fmt::format("'{}' must be {}", key, kind));
        }
    }
};

}  // namespace actformer::reports
