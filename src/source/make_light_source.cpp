#include "scintray/source/light_source.hpp"
#include "scintray/source/make_event_source.hpp"
#include "scintray/source/photon_source.hpp"
#include "scintray/source/scintillation_source.hpp"

namespace scintray {

std::unique_ptr<LightSource> make_light_source(const SceneSpec& spec, const Scene& scene,
                                               std::vector<std::string>* notes) {
  if (!spec.energy_source) return std::make_unique<PhotonSource>(spec.source, scene);
  const GammaSpec& source = *spec.energy_source;
  try {
    return std::make_unique<ScintillationSource>(make_event_source(source, scene, notes), scene,
                                                 source.unpolarised, source.cherenkov);
  } catch (const InputError& error) {
    Problems problems;
    for (Problem problem : error.problems()) {
      if (problem.where.file.empty()) problem.where = source.where;
      problems.add(problem);
    }
    problems.throw_if_any();
    throw;
  }
}

}  // namespace scintray
