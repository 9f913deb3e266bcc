// The kinds of recogniser that can be trained, by the names that configurations give them.
#pragma once

#include <optional>
#include <string_view>

namespace actformer::eval {

enum class RecogniserKind { stgcn, gru };

/// Of what a configuration's line `model:` says: "recogniser" or "stgcn", or "gru". None for any other name, which is a generator's or
/// nobody's.
constexpr std::optional<RecogniserKind> recogniser_kind_named(std::string_view model) {
    if (model == "recogniser" || model == "stgcn") return RecogniserKind::stgcn;
    if (model == "gru") return RecogniserKind::gru;
    return {};
}

}  // namespace actformer::eval
