#pragma once
/// What commands show of the events of a results file.

#include <filesystem>

#include "scintray/report/run_studies.hpp"
#include "scintray/scene/read_scene.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::cli {

/// Finds before a run what its page would find too late: curves that the scene does not have.
void check_claims(const SceneFile& scene);

/// Studies of the file's events, with the [analysis] and the claims of the scene that the run is of.
RunStudies studies_of(const std::filesystem::path& results, const RunResult& run);

}  // namespace scintray::cli
