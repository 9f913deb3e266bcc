// What a command prints with --json.
#pragma once

#include <fmt/format.h>

#include <cstdio>

namespace actformer::cli {

/// In ASCII: other characters, which a terminal may obey, as \u and their number; bytes that are no UTF-8, as in names of files, as
/// U+FFFD.
template <typename Json>
void say_json(const Json& json) {
    fmt::print("{}\n", json.dump(2, ' ', true, Json::error_handler_t::replace));
}

}  // namespace actformer::cli
