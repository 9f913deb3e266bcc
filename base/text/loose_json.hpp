// Reading JSON that may be anything: what is not there, or is something else, is empty.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace actformer::loose {

/// What the file says; discarded (neither object nor list) where it cannot be read or is no JSON. Throws Error where it has
/// more than 256 MiB and, naming the line, where lists and objects are too deep (see deepest_json).
nlohmann::ordered_json read(const std::filesystem::path& path);

/// The member of an object; null where there is none. Refers into `object`.
const nlohmann::ordered_json& member(const nlohmann::ordered_json& object, const char* key);

/// The member where it is a list, else an empty one. Refers into `object`.
const nlohmann::ordered_json& list(const nlohmann::ordered_json& object, const char* key);

/// The member where it is a text, else an empty one.
std::string text(const nlohmann::ordered_json& object, const char* key);

}  // namespace actformer::loose
