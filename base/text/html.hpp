// Web pages where a download was expected: what a browser or a script saves when a link has gone bad.
#pragma once

#include <string>
#include <string_view>

namespace actformer {

/// The text begins as an HTML page does.
bool is_html(std::string_view text);

/// "an HTML page in place of an archive: ..."
std::string html_in_place_of(std::string_view wanted);

}  // namespace actformer
