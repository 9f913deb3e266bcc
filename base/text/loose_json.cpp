#include "base/text/loose_json.hpp"

#include <unistd.h>

#include <vector>

#include "base/files/file.hpp"
#include "base/text/json.hpp"

namespace actformer::loose {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::uint64_t largest_file = std::uint64_t{256} << 20;

}  // namespace

nlohmann::ordered_json read(const std::filesystem::path& path) {
    if (std::error_code ignored;
        !std::filesystem::is_regular_file(path, ignored) || ::access(path.c_str(), R_OK) != 0)
        return Json(Json::value_t::discarded);
    std::vector<char> scratch;
    const auto text = read_text(path, scratch, largest_file);
    expect_shallow_json(text, path);
    return Json::parse(text, nullptr, false);
}

const nlohmann::ordered_json& member(const Json& object, const char* key) {
    static const Json none;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() ? *found : none;
}

const nlohmann::ordered_json& list(const Json& object, const char* key) {
    static const Json none = Json::array();
    const auto& found = member(object, key);
    return found.is_array() ? found : none;
}

std::string text(const Json& object, const char* key) {
    const auto& found = member(object, key);
    return found.is_string() ? found.get<std::string>() : "";
}

}  // namespace actformer::loose
