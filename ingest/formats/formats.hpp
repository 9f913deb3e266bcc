// The formats there are.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// A format as `actformer ingest` lists it.
struct FormatEntry {
    std::string_view name;      ///< of the command
    std::string_view help;      ///< what it reads and what comes of it
    std::string_view examples;  ///< the end of its --help
    std::unique_ptr<IngestCommand> (*command)() = nullptr;
};

std::span<const FormatEntry> formats();

}  // namespace actformer::ingest
