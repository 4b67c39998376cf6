#include "scintray/cli/run_analysis.hpp"

#include <iostream>

#include "scintray/cli/progress.hpp"
#include "scintray/cli/scene_view.hpp"
#include "scintray/report/acceptance.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/surface_acceptance.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "scintray/results/results.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/simulation/analyze_results.hpp"

namespace scintray::cli {

void check_criteria(const scene_file::SceneFile& scene) {
  const scene_file::SceneSpec spec = scene.spec(0);
  report::check_surface_criteria(spec.goniometers, spec.criteria);
  if (spec.criteria.empty() && spec.analysis.reference.empty()) return;
  tally::RunResult points;
  points.header.sweep_keys = scene.sweep_keys();
  points.points.resize(scene.points());
  for (std::size_t i = 0; i < scene.points(); ++i) points.points[i].parameters = scene.parameters(i);
  report::check_curves(points, spec.analysis.reference, spec.criteria);
}

report::RunAnalysis analysis_of(const std::filesystem::path& results, const tally::RunResult& run) {
  const scene_file::AnalysisSpec analysis =
      scene_file::analysis_of_text(run.header.scene_text, run.header.scene_file);
  return {with_progress("analysing the events",
                        [&] { return simulation::analyze_results(results, run, analysis); }),
          analysis.reference, scene_file::criteria_of_text(run.header.scene_text, run.header.scene_file),
          results::read_surfaces(results)};
}

void add_no_view_flag(CLI::App& command, bool& no_view) {
  command.add_flag("--no-view", no_view, "write the page without the scene in three dimensions, 0.9 MB less");
}

report::RunAnalysis show_results(const std::filesystem::path& results, const tally::RunResult& run,
                                 const ShownResults& shown) {
  report::RunAnalysis analyses = analysis_of(results, run);
  if (shown.summary) std::cout << report::text_summary(run, analyses);
  std::cout << "results  " << results.string() << "\n";
  if (shown.page)
    write_page(std::filesystem::path(results).replace_extension(".html"), {results, run}, analyses,
               shown.view);
  return analyses;
}

void write_page(const std::filesystem::path& page, const RunFile& results,
                const report::RunAnalysis& analyses, bool view) {
  with_progress("writing " + page.string(), [&] {
    const SceneOfResults scene = view ? scene_of_results(results.path, results.run) : SceneOfResults();
    report::write_report(page, results.run, analyses, scene.view);
  });
  std::cout << "report   " << page.string() << "\n";
}

}  // namespace scintray::cli
