#include "ingest/dataset/origin.hpp"

#include "base/error.hpp"

namespace actformer::ingest {

std::string_view name_of(DataOrigin::Kind kind) {
    switch (kind) {
        case DataOrigin::Kind::recorded:
            return "recorded";
        case DataOrigin::Kind::synthetic:
            return "synthetic";
        case DataOrigin::Kind::stand_in:
            return "stand-in";
    }
    return "recorded";
}

DataOrigin::Kind origin_named(std::string_view name, const std::string& where) {
    using enum DataOrigin::Kind;
    for (const auto kind : {recorded, synthetic, stand_in})
        if (name == name_of(kind)) return kind;
    throw Error("{}: origin '{}' is none of recorded, synthetic, stand-in", where, name);
}

std::string DataOrigin::text() const {
    std::string text(kind ? name_of(*kind) : "");
    if (skeleton.empty()) return text;
    if (!text.empty()) text += ", ";
    return text + (skeleton == "generic" ? "generic skeleton" : "skeleton of " + skeleton);
}

}  // namespace actformer::ingest
