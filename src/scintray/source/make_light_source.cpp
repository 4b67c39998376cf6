#include "scintray/source/detail/photon_source.hpp"
#include "scintray/source/detail/scintillation_source.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/source/make_event_source.hpp"

namespace scintray::source {

std::unique_ptr<LightSource> make_light_source(const scene_file::SceneSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes) {
  if (!spec.energy_source) return std::make_unique<PhotonSource>(spec.source, scene);
  const scene_file::GammaSpec& source = *spec.energy_source;
  try {
    return std::make_unique<ScintillationSource>(make_event_source(source, scene, notes), scene,
                                                 source.unpolarised, source.cherenkov);
  } catch (const core::InputError& error) {
    core::Problems problems;
    for (core::Problem problem : error.problems()) {
      if (problem.where.file.empty()) problem.where = source.where;
      problems.add(problem);
    }
    problems.throw_if_any();
    throw;
  }
}

}  // namespace scintray::source
