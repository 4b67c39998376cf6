#include "scintray/report/pages/pages.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/report/acceptance.hpp"
#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/pages/detail/sections.hpp"
#include "scintray/report/pages/event_section.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/plots/detail/grid_map.hpp"
#include "scintray/report/plots/detail/hemisphere_map.hpp"
#include "scintray/report/plots/detail/light_curves.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"
#include "scintray/report/text/sweep_view.hpp"

namespace scintray::report {

namespace {

using namespace report;

constexpr const char* kReportStyle = R"css(
:root { --panel:#f6f8fa; --alarm:#8a1c00; --alarm-paper:#fdeee9;
  --f0:#0072b2; --f1:#7fb8d8; --f2:#c9a227; --f3:#b0562a; --f4:#66727c; --f5:#a34f7e; }
@media screen and (prefers-color-scheme: dark) {
:root { --panel:#1c2227; --alarm:#ffb4a0; --alarm-paper:#40180d;
  --f0:#2678b0; --f1:#2f5f7d; --f2:#a9861a; --f3:#a8562f; --f4:#66727c; --f5:#a3578a; } }
h3 { font-size: 1rem; margin: 1.25rem 0 .25rem; }
.headline { font-size: 1.15rem; margin: 1.5rem 0 0; } .headline b { font-size: 2rem; color: var(--f0); }
.partial { margin: 1rem 0; padding: .75rem 1rem; border-left: 5px solid var(--alarm); background: var(--alarm-paper);
  color: var(--alarm); }
table { font-size: .85rem; margin: .5rem 0; } th, td { padding: .3rem .65rem; white-space: nowrap; } td.why { white-space: normal; }
thead th, thead .n { font-weight: 600; vertical-align: bottom; white-space: normal; }
tr.sum th, tr.sum td { font-weight: 600; border-top: 2px solid var(--soft); }
table.pairs td { white-space: normal; } table.pairs th { color: var(--soft); }
figure { margin: 0 0 1rem; }
.omitted { color: var(--soft); font-size: .88rem; margin: .25rem 0; }
figcaption { color: var(--soft); font-size: .88rem; font-weight: 400; margin: 0; }
.grid { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(24rem, 100%), 1fr)); gap: 1.25rem; }
.grid figure { max-width: 36rem; }
.claims td, .claims th { white-space: normal; }
.bars { display: grid; grid-template-columns: max-content 1fr; gap: .35rem .9rem; align-items: center; }
.who { font-size: .88rem; } .bar { display: flex; height: 1.5rem; border-radius: 3px; overflow: hidden; }
.bar span { color: #fff; font-size: .75rem; line-height: 1.5rem; text-align: center; overflow: hidden;
  white-space: nowrap; box-shadow: inset -1px 0 0 var(--paper); }
.bar .f1, .bar .f2 { color: #10161b; }
@media screen and (prefers-color-scheme: dark) { .bar .f1 { color: #fff; } }
.f0 { background: var(--f0); } .f1 { background: var(--f1); } .f2 { background: var(--f2); }
.f3 { background: var(--f3); } .f4 { background: var(--f4); } .f5 { background: var(--f5); }
.key { display: flex; flex-wrap: wrap; gap: .25rem 1.25rem; font-size: .88rem; margin: 0 0 .6rem; }
.key i { display: inline-block; width: .85rem; height: .85rem; margin-right: .4rem; border-radius: 2px;
  vertical-align: -1px; }
details { margin-top: .75rem; } summary { cursor: pointer; color: var(--soft); }
pre { background: var(--panel); padding: 1rem; overflow-x: auto; font-size: .85rem; line-height: 1.45; }
@media (max-width: 40rem) { table.pairs th { white-space: normal; } .bars { grid-template-columns: 1fr; } .who { margin-bottom: -.2rem; }
  .headline b { font-size: 1.6rem; } }
@media print { .bar span, .key i { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)css";

std::string partial_banner(const tally::RunResult& run) {
  if (run.complete()) return "";
  std::uint64_t wanted = 0, traced = 0;
  for (const tally::PointResult& point : run.points) {
    wanted += point.photons_requested;
    traced += point.emitted;
  }
  return "<p class=\"partial\"><b>Partial result.</b> " +
         escape_html(run.partial_reason.empty() ? "Not every point was finished" : run.partial_reason) +
         ". " + grouped(traced) + " of the " + grouped(wanted) +
         " photons of the points below were traced.</p>\n";
}

/// Crystals of a flood map in its plane, from the parts of a view.
std::vector<std::array<double, 4>> crystal_outlines(const tally::RunResult& run,
                                                    const analysis::EventAnalysis& analysis,
                                                    const SceneView& view) {
  std::vector<std::array<double, 4>> outlines;
  if (!analysis.flood) return outlines;
  for (const core::PartId id : analysis.flood->crystals) {
    const auto part = std::find_if(view.parts.begin(), view.parts.end(), [&](const ViewPart& shown) {
      return run.header.parts.contains(id) && shown.name == run.header.parts[id];
    });
    if (part == view.parts.end() || part->mesh->vertices.empty()) continue;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    auto& [x_low, y_low, x_high, y_high] = outlines.emplace_back(std::array{kFar, kFar, -kFar, -kFar});
    for (const core::Vec3& vertex : part->mesh->vertices) {
      const double x = vertex.dot(analysis.across_x), y = vertex.dot(analysis.across_y);
      x_low = std::min(x_low, x);
      x_high = std::max(x_high, x);
      y_low = std::min(y_low, y);
      y_high = std::max(y_high, y);
    }
  }
  return outlines;
}

std::string events(const tally::RunResult& run, const RunAnalysis& analyses, const RunView& view) {
  if (analyses.points.empty()) return "";
  std::vector<PointAnalysis> points;
  for (std::size_t i = 0; i < std::min(analyses.points.size(), run.points.size()); ++i)
    points.push_back({point_label(run.points[i]), analyses.points[i], run.points[i].omitted});
  if (view.view && !points.empty())  // the view is of the first point
    points.front().crystals = crystal_outlines(run, points.front().analysis, *view.view);
  return event_section(points, run.header.parts);
}

std::string answer(const tally::RunResult& run, const RunAnalysis& analyses) {
  if (run.points.empty()) return "<p>No point was finished.</p>\n";
  if (run.points.size() == 1) return run.traced_photons() ? headline(run.points.front()) : "";
  const auto view = view_sweep(run);
  if (!view) return "";
  const std::string left_out = omission_note(omitted_anywhere(run), Figure::fraction);
  if (analyses.points.size() == run.points.size())
    return light_section(*view, analyses.points, analyses.reference) + left_out;
  return sweep_section(run, *view) + left_out;
}

}  // namespace

std::string html_report(const tally::RunResult& run, const RunAnalysis& analyses, const RunView& view) {
  const std::string title = run.header.title.empty() ? "ScintRay run" : run.header.title;
  std::string page;
  page += partial_banner(run) + answer(run, analyses) + criterion_section(evaluate(run, analyses)) +
          goniometer_sections(analyses.surfaces) + events(run, analyses, view);
  if (run.traced_photons())
    page += fate_section(run) + shift_section(run) + sensor_section(run) + angle_section(run) +
            tally_section(run) + path_section(run);
  page += view_section(view, run) + condition_section(run);
  page += "<section>\n<h2>Scene</h2>\n<pre tabindex=\"0\" role=\"group\" aria-label=\"scene file\">" +
          escape_html(run.header.scene_text) + "</pre>\n</section>\n";
  return html_frame(
      title, "ScintRay " + run.header.version + " · " + run.header.scene_file,
      kReportStyle + grid_map_style() + hemisphere_map_style() + std::string(view.view ? view_style() : ""),
      page, view.view ? view_scripts() : std::vector<std::string_view>());
}

void write_report(const std::filesystem::path& path, const tally::RunResult& run, const RunAnalysis& analyses,
                  const RunView& view) {
  core::write_whole_file(path, html_report(run, analyses, view), "the report");
}

}  // namespace scintray::report
