#include "scintray/cli/run_studies.hpp"

#include "scintray/io/study_results.hpp"
#include "scintray/scene/read_analysis.hpp"

namespace scintray::cli {

RunStudies studies_of(const std::filesystem::path& results, const RunResult& run) {
  const AnalysisSpec analysis = analysis_of_text(run.header.scene_text, run.header.scene_file);
  return {study_results(results, run, analysis), analysis.reference,
          claims_of_text(run.header.scene_text, run.header.scene_file)};
}

}  // namespace scintray::cli
