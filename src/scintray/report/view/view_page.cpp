#include "scintray/report/view/view_page.hpp"

#include <map>

#include "scintray/core/error.hpp"
#include "scintray/report/detail/embedded_file.hpp"
#include "scintray/report/pages/detail/html_document.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/view/detail/view_data.hpp"

SCINTRAY_EMBED(scintray_view_page_style, SCINTRAY_VIEW_FOLDER "/view_page.css");
SCINTRAY_EMBED(scintray_view_section, SCINTRAY_VIEW_FOLDER "/scene_view.html");
SCINTRAY_EMBED(scintray_view_style, SCINTRAY_VIEW_FOLDER "/scene_view.css");
SCINTRAY_EMBED(scintray_view_script, SCINTRAY_VIEW_SCRIPT);
#ifdef SCINTRAY_THREE_JS
SCINTRAY_EMBED(scintray_three, SCINTRAY_THREE_JS);
SCINTRAY_EMBED(scintray_three_controls, SCINTRAY_ORBIT_CONTROLS_JS);
#endif

namespace scintray::report {

namespace {

/// A text with the marks "@@NAME@@" replaced.
std::string filled(std::string_view page, const std::map<std::string, std::string_view>& texts) {
  std::string result;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t mark = page.find("@@", at), end = mark == page.npos ? mark : page.find("@@", mark + 2);
    if (end == page.npos) return result.append(page.substr(at));
    result.append(page.substr(at, mark - at))
        .append(texts.at(std::string(page.substr(mark + 2, end - mark - 2))));
    at = end + 2;
  }
  return result;
}

constexpr const char* kOpen =
    "<button type=\"button\" class=\"view-open\">Show the scene in three dimensions</button>";

/// Counts of a view, as "290 parts and 500 photon paths".
std::string counts_of(const SceneView& view) {
  std::string text = grouped(view.parts.size()) + (view.parts.size() == 1 ? " part" : " parts");
  if (!view.paths.empty())
    text +=
        " and the paths of " + grouped(view.paths.size()) + (view.paths.size() == 1 ? " photon" : " photons");
  return text;
}

}  // namespace

bool can_view() {
#ifdef SCINTRAY_THREE_JS
  return true;
#else
  return false;
#endif
}

std::string_view view_style() { return {scintray_view_style, scintray_view_style_end}; }

std::vector<std::string_view> view_scripts() {
  std::vector<std::string_view> scripts;
#ifdef SCINTRAY_THREE_JS
  scripts.emplace_back(scintray_three, scintray_three_end);
  scripts.emplace_back(scintray_three_controls, scintray_three_controls_end);
  scripts.emplace_back(scintray_view_script, scintray_view_script_end);
#endif
  return scripts;
}

std::string view_page(const SceneView& view) {
  if (!can_view())
    throw core::SystemError(
        "this ScintRay was built without three.js, which draws scenes in three dimensions; on Debian install "
        "libjs-three and build again");
  const std::string data = view_data(view, nullptr), head = "<h1>" + escape_html(view.title) + "</h1>";
  const std::string section = filled({scintray_view_section, scintray_view_section_end},
                                     {{"KIND", "alone"}, {"HEAD", head}, {"OPEN", ""}, {"DATA", data}});
  return html_document({.title = view.title,
                        .style = "\n" + filled({scintray_view_page_style, scintray_view_page_style_end},
                                               {{"STYLE", view_style()}}),
                        .body = "<main>\n" + section + "\n</main>\n",
                        .scripts = view_scripts()});
}

std::string view_section(const RunView& view, const tally::RunResult& run) {
  const std::string missing =
      !view.view.has_value() || can_view() ? view.missing : "this ScintRay was built without three.js";
  const std::string heading = "<section>\n<h2>The scene in three dimensions</h2>\n";
  if (!missing.empty())
    return heading + "<p class=\"omitted\">The scene is not shown: " + escape_html(missing) +
           ".</p>\n</section>\n";
  if (!view.view) return "";
  const std::string data = view_data(*view.view, &run);
  const std::string paths =
      view.view->paths.empty() ? " Photon paths are shown where [run] of the scene has paths = 500." : "";
  return heading + "<p>" + counts_of(*view.view) +
         (run.points.size() > 1 ? ", of the first point of the sweep." : ".") + paths + "</p>\n" +
         filled({scintray_view_section, scintray_view_section_end},
                {{"KIND", "within"}, {"HEAD", ""}, {"OPEN", kOpen}, {"DATA", data}}) +
         "</section>\n";
}

}  // namespace scintray::report
