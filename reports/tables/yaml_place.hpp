// Places in a YAML file, for messages: "sweep.yaml: line 7: ...".
#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "base/error.hpp"
#include "base/text/yaml.hpp"

namespace actformer::reports {

struct YamlPlace {
    std::string file;

    [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
        throw Error("{}: line {}: {}", file, node.Mark().line + 1, what);
    }
    void expect_map(const YAML::Node& node, const std::string& what) const {
        if (!node.IsMap()) fail(node, what + " must be a map of keys and values");
        expect_keys(node, what);
    }
    /// Text alone, each once.
    void expect_keys(const YAML::Node& map, const std::string& what) const {
        if (const auto bad = bad_key(map))
            throw Error("{}: line {}: {}: {}", file, bad->line, what, bad->what);
    }
    void expect_list(const YAML::Node& node, const std::string& what) const {
        if (!node.IsSequence()) fail(node, what + " must be a list");
    }
    /// `kind` says what it must be: "a whole number". Nothing (`~`) is of no kind; the library takes it for the text "null".
    template <typename T>
    T as(const YAML::Node& node, const std::string& key, const char* kind) const {
        try {
            if (!node.IsNull()) return node.as<T>();
        } catch (const YAML::Exception&) {  // of another kind
        }
        fail(node, fmt::format("'{}' must be {}", key, kind));
    }
};

}  // namespace actformer::reports
