#include "scintray/source/light_source.hpp"
#include "scintray/source/make_event_source.hpp"
#include "scintray/source/photon_source.hpp"
#include "scintray/source/scintillation_source.hpp"

namespace scintray {

std::unique_ptr<LightSource> make_light_source(const SceneSpec& spec, const Scene& scene,
                                               std::vector<std::string>* notes) {
  if (!spec.energy_source) return std::make_unique<PhotonSource>(spec.source, scene);
  return std::make_unique<ScintillationSource>(make_event_source(*spec.energy_source, scene, notes), scene,
                                               spec.energy_source->unpolarised);
}

}  // namespace scintray
