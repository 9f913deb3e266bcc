#include "base/text/loose_json.hpp"

#include <fstream>
#include <iterator>

#include "base/text/json.hpp"

namespace actformer::loose {

using Json = nlohmann::ordered_json;

nlohmann::ordered_json read(const std::filesystem::path& path) {
    if (std::error_code ignored; !std::filesystem::is_regular_file(path, ignored))
        return Json(Json::value_t::discarded);
    std::ifstream file(path, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
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
