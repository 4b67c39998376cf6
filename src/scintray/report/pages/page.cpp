#include "scintray/report/pages/page.hpp"

#include "scintray/core/output_file.hpp"
#include "scintray/core/version.hpp"
#include "scintray/report/pages/detail/html_document.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr const char* kPageStyle = R"css(
:root { color-scheme: light dark; --paper:#ffffff; --ink:#1b1f24; --soft:#5c6670; --rule:#e3e7eb; }
@media screen and (prefers-color-scheme: dark) {
:root { --paper:#14181c; --ink:#e6e9ec; --soft:#9aa5af; --rule:#2c333a; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 66rem; padding: 2rem 1.5rem 4rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .25rem; }
h2 { font-size: 1.2rem; margin: 2.5rem 0 .75rem; padding-bottom: .3rem; border-bottom: 1px solid var(--rule); }
.under { color: var(--soft); margin: 0; }
figure { margin: 0; break-inside: avoid; } figcaption { font-weight: 600; margin-bottom: .3rem; }
figcaption span { color: var(--soft); font-weight: 400; }
.scroll { overflow-x: auto; } .scroll:focus-visible, pre:focus-visible { outline: 2px solid var(--c0); }
.contents ol { columns: 16rem; margin: .75rem 0 0; padding-left: 1.4rem; font-size: .9rem; } .contents a { color: inherit; }
@media (max-width: 40rem) { body { padding: 1.25rem 1rem 3rem; } h1 { font-size: 1.4rem; }
  .contents ol { columns: auto; }
  .canvas svg.plot { min-width: 30rem; } .canvas svg.plot[data-wide] { min-width: 42rem; } }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .88rem; }
th, td { padding: .25rem .65rem; text-align: left; border-bottom: 1px solid var(--rule); }
thead th { color: var(--soft); } .n { text-align: right; white-space: nowrap; } tbody th { font-weight: 500; }
td.why { color: var(--soft); min-width: 7.5rem; white-space: normal; font-size: .8rem; line-height: 1.35; }
.small-spectrum { display: block; } .small-spectrum path { fill: var(--c0); }
)css";

// After all other styles, which it overrides. Nothing scrolls on paper: wide tables break their lines.
constexpr const char* kPrintStyle = R"css(
@media print { :root { color-scheme: light; } .contents { display: none; } body { max-width: none; padding: 0; font-size: 11pt; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; } .scroll { overflow: visible; } table { font-size: .72rem; }
  th, td, .n { padding: .2rem .4rem; white-space: normal; } td.why { min-width: 0; } }
)css";

/// Sections from which on a page has a list of them.
constexpr std::size_t kListedSections = 4;

/// A page's content with an id on every heading of a section, after a list of links to them.
std::string with_contents(const std::string& body) {
  const std::string opening = "<h2>", closing = "</h2>";
  std::string content, links;
  std::size_t count = 0, done = 0;
  for (std::size_t at = body.find(opening); at != std::string::npos; at = body.find(opening, done)) {
    const std::size_t start = at + opening.size(), end = body.find(closing, start);
    const std::string id = "section-" + std::to_string(++count);
    content += body.substr(done, at - done) + "<h2 id=\"" + id + "\">";
    links += "<li><a href=\"#" + id + "\">" + body.substr(start, end - start) + "</a></li>\n";
    done = start;
  }
  content += body.substr(done);
  if (count < kListedSections) return content;
  return "<nav class=\"contents\" aria-label=\"contents\"><ol>\n" + links + "</ol></nav>\n" + content;
}

}  // namespace

std::string html_frame(const std::string& title, const std::string& under, const std::string& style,
                       const std::string& body, const std::vector<std::string_view>& scripts) {
  const std::string header = "<header>\n<h1>" + escape_html(title) + "</h1>\n<p class=\"under\">" +
                             escape_html(under) + "</p>\n</header>\n";
  return html_document(
      {.title = title,
       .style = kPageStyle + style + svg_plot_style() + std::string(page_script_style()) + kPrintStyle,
       .body = header + "<main>\n" + with_contents(body) + "</main>\n",
       .scripts = scripts,
       .page_script = true});
}

std::string html_page(const std::string& title, const std::string& under, const std::string& style,
                      const std::string& body) {
  return html_frame(title, under + " · ScintRay " + core::version(), style, body);
}

void write_page(const std::filesystem::path& path, const std::string& content) {
  core::write_whole_file(path, content);
}

}  // namespace scintray::report
