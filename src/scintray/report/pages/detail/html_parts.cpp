#include "scintray/report/pages/detail/html_parts.hpp"

#include "scintray/report/text/format.hpp"

namespace scintray::report {

std::string cell(const std::string& text, const char* tag, const char* kind) {
  const std::string open = *kind == '\0' ? std::string(tag) : std::string(tag) + " class=\"" + kind + "\"";
  return "<" + open + ">" + escape_html(text) + "</" + tag + ">";
}

std::string number_cell(const std::string& text) { return cell(text, "td", "n"); }

std::string table(const std::vector<std::string>& head, const std::string& rows, std::size_t first_number) {
  std::string out = "<div class=\"scroll\"><table>\n<thead><tr>";
  for (std::size_t i = 0; i < head.size(); ++i) out += cell(head[i], "th", i < first_number ? "" : "n");
  return out + "</tr></thead>\n<tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string section(const std::string& title, const std::string& body) {
  return "<section>\n<h2>" + escape_html(title) + "</h2>\n" + body + "</section>\n";
}

}  // namespace scintray::report
