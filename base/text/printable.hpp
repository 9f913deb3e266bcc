// Text out of raw files, made fit for messages and for JSON.
#pragma once

#include <string>
#include <string_view>

namespace actformer {

/// `bytes` as they are where they are printable UTF-8; every other byte becomes \xNN, so that different names
/// stay different. Marks that end lines or turn the direction of writing are not printable.
std::string printable(std::string_view bytes);

/// The same between quotes, cut after 40 bytes: for quoting a file in a message of one line.
std::string in_quotes(std::string_view bytes);

}  // namespace actformer
