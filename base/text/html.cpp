#include "base/text/html.hpp"

#include <algorithm>

namespace actformer {

bool is_html(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    for (const std::string_view start : {"<!doctype html", "<html", "<head", "<!--"})
        if (text.size() >= start.size() &&
            std::equal(start.begin(), start.end(), text.begin(), [](char want, char have) {
                return want == (have >= 'A' && have <= 'Z' ? static_cast<char>(have - 'A' + 'a') : have);
            }))
            return true;
    return false;
}

std::string html_in_place_of(std::string_view wanted) {
    return "an HTML page in place of " + std::string(wanted) +
           ": the download failed, as where a link has expired or asks to log in; open it in a browser and "
           "get it again";
}

}  // namespace actformer
