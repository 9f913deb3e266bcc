#include "base/checksum/checked_json.hpp"

#include "base/checksum/checksum.hpp"

namespace actformer {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto key = "checksum";

std::string checksum_of_members(const Json& object) {
    const nlohmann::json sorted = object;
    return checksum(sorted.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

Json with_checksum(Json object) {
    object.erase(key);
    auto sum = checksum_of_members(object);
    object[key] = std::move(sum);
    return object;
}

OwnChecksum own_checksum_of(const Json& object) {
    if (!object.is_object()) return OwnChecksum::absent;
    if (!object.contains(key)) {
        const auto program = object.find("program");
        const bool is_own = program != object.end() && program->is_string() &&
                            names_this_program(program->get_ref<const std::string&>());
        return is_own ? OwnChecksum::wrong : OwnChecksum::absent;
    }
    auto others = object;
    others.erase(key);
    return object[key] == checksum_of_members(others) ? OwnChecksum::right : OwnChecksum::wrong;
}

}  // namespace actformer
