#include "scintray/cli/run_studies.hpp"

#include "scintray/io/results.hpp"
#include "scintray/report/claims.hpp"
#include "scintray/report/surface_claims.hpp"
#include "scintray/scene/read_analysis.hpp"
#include "scintray/simulation/study_results.hpp"

namespace scintray::cli {

void check_claims(const SceneFile& scene) {
  const SceneSpec spec = scene.spec(0);
  report::check_surface_claims(spec.benches, spec.claims);
  if (spec.claims.empty() && spec.analysis.reference.empty()) return;
  RunResult points;
  points.header.sweep_keys = scene.sweep_keys();
  points.points.resize(scene.points());
  for (std::size_t i = 0; i < scene.points(); ++i) points.points[i].parameters = scene.parameters(i);
  report::check_curves(points, spec.analysis.reference, spec.claims);
}

RunStudies studies_of(const std::filesystem::path& results, const RunResult& run) {
  const AnalysisSpec analysis = analysis_of_text(run.header.scene_text, run.header.scene_file);
  return {study_results(results, run, analysis), analysis.reference,
          claims_of_text(run.header.scene_text, run.header.scene_file), read_surfaces(results)};
}

}  // namespace scintray::cli
