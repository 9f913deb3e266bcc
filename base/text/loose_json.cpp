#include "base/text/loose_json.hpp"

#include <fstream>

#include "base/error.hpp"
#include "base/text/json.hpp"

namespace actformer::loose {

using Json = nlohmann::ordered_json;

nlohmann::ordered_json read(const std::filesystem::path& path) {
    constexpr std::uintmax_t mib = std::uintmax_t{1} << 20, most = 256;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return Json(Json::value_t::discarded);
    const auto size = std::filesystem::file_size(path, ignored);
    if (!ignored && size > most * mib)
        throw Error("{}: {} MiB, and a file of this kind has at most {} MiB; is it the right one?",
                    path.string(), (size + mib - 1) / mib, most);
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
