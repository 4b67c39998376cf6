#include "scintray/report/pages/detail/html_parts.hpp"

#include "scintray/report/text/format.hpp"

namespace scintray::report {

std::string cell(const std::string& text, const char* tag, const char* kind) {
  const std::string open = *kind == '\0' ? std::string(tag) : std::string(tag) + " class=\"" + kind + "\"";
  return "<" + open + ">" + escape_html(text) + "</" + tag + ">";
}

std::string number_cell(const std::string& text) { return cell(text, "td", "n"); }

std::string scroll_area(const std::string& name) {
  return "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"" + escape_html(name) + "\">";
}

namespace {

/// Rows above which a table is folded.
constexpr std::size_t kLongTable = 16;

std::size_t rows_in(const std::string& rows) {
  std::size_t count = 0;
  for (std::size_t at = rows.find("</tr>"); at != std::string::npos; at = rows.find("</tr>", at + 1)) ++count;
  return count;
}

}  // namespace

std::string table(const std::vector<std::string>& head, const std::string& rows, std::size_t first_number,
                  bool fold) {
  const std::string name = head.empty() ? "table" : "table by " + head.front();
  std::string out = scroll_area(name) + "<table>\n<thead><tr>";
  for (std::size_t i = 0; i < head.size(); ++i) out += cell(head[i], "th", i < first_number ? "" : "n");
  out += "</tr></thead>\n<tbody>\n" + rows + "</tbody></table></div>\n";
  const std::size_t count = rows_in(rows);
  return count <= kLongTable || !fold ? out
                                      : "<details><summary>Table of " + std::to_string(count) +
                                            " rows</summary>\n" + out + "</details>\n";
}

std::string section(const std::string& title, const std::string& body) {
  return "<section>\n<h2>" + escape_html(title) + "</h2>\n" + body + "</section>\n";
}

}  // namespace scintray::report
