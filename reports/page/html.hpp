// Tables as HTML. Whatever comes from files is text in it, never markup.
#pragma once

#include <string>
#include <string_view>

#include "reports/page/tables.hpp"

namespace actformer::reports {

/// `text` with what HTML reads as markup escaped, fit for elements and for attributes in quotes; broken UTF-8 and control
/// characters made visible.
std::string escaped(std::string_view text);

/// What the data is that the tables were measured on, and what is amiss: a div of paragraphs.
std::string html_note(const std::vector<FilledTable>& tables, const std::vector<std::string>& notices);

/// A link to each table of a paper, "1" for Table 1, and one to those of all rows.
std::string html_links(const std::vector<FilledTable>& tables);

/// A section a table (the classes of its elements are those that reports/page/assets/page.css styles).
std::string html_tables(const std::vector<FilledTable>& tables);

}  // namespace actformer::reports
