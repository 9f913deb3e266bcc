#include "reports/page/page.hpp"

#include <map>

#include "base/error.hpp"
#include "reports/page/html.hpp"
#include "reports/page/page_part.hpp"

namespace actformer::reports {
namespace {

/// The data as JSON that no HTML parser can take for markup.
std::string embedded(const nlohmann::ordered_json& data) {
    const auto text = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string out;
    out.reserve(text.size());
    for (const char c : text)
        if (c == '<')
            out += "\\u003c";
        else
            out += c;
    return out;
}

/// The template with {{name}} replaced by what `parts` has under it; what is put in is not looked at again.
std::string filled(std::string_view page, const std::map<std::string, std::string, std::less<>>& parts) {
    std::string out;
    while (!page.empty()) {
        const auto from = page.find("{{"), to = page.find("}}", from);
        if (to == std::string_view::npos) break;
        const auto part = parts.find(page.substr(from + 2, to - from - 2));
        if (part == parts.end())
            throw Error("reports/page/assets/page.html: nothing is called {}",
                        page.substr(from, to - from + 2));
        out += page.substr(0, from);
        out += part->second;
        page.remove_prefix(to + 2);
    }
    return out += page;
}

}  // namespace

std::string page(const std::string& title, const std::vector<FilledTable>& tables,
                 const std::vector<std::string>& notices, const nlohmann::ordered_json& data) {
    std::string script;
    for (const auto* name : {"data.js", "charts.js", "body.js", "paint.js", "viewer.js", "page.js"})
        script += page_part(name);
    return filled(page_part("page.html"), {{"title", escaped(title)},
                                           {"style", std::string(page_part("page.css"))},
                                           {"links", html_links(tables)},
                                           {"note", html_note(tables, notices)},
                                           {"tables", html_tables(tables)},
                                           {"data", embedded(data)},
                                           {"script", script}});
}

}  // namespace actformer::reports
