// Errors of one clip, for files in which the others may be sound.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "base/error.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// What `make` gives; where it throws Error, a broken clip: "PLACE: what is wrong", or only that where `place` is empty.
template <typename Make>
ParsedClip made_or_broken(const std::string& place, Make make) {
    try {
        return make();
    } catch (const Error& e) {
        return Rejection{Rejection::Kind::broken,
                         place.empty() ? e.what() : fmt::format("{}: {}", place, e.what())};
    }
}

}  // namespace actformer::ingest
