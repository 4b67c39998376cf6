#include "scintray/source/detail/scintillation.hpp"

namespace scintray::source {

bool scintillates(const scene::Scene& scene, core::RegionId region) {
  return scene.media[scene.regions[region].medium].medium().yield_per_keV > 0.0;
}

bool depends_on_electrons(const optics::Medium& medium, bool cherenkov) {
  return !medium.composition.empty() && (cherenkov || !medium.relative_yield.is_constant());
}

void require_scintillators(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                           const core::FileLocation& where) {
  for (const core::RegionId region : regions)
    if (!scintillates(scene, region))
      throw core::InputError(
          {where,
           "\"" + scene.region_names[region] + "\" does not scintillate: its medium \"" +
               scene.media[scene.regions[region].medium].medium().name + "\" has no light yield",
           "put the events into a scintillator, or give the medium [yield], [emission] and "
           "[[decay]]"});
}

void leave_energy(const scene::Scene& scene, const Deposit& deposit, Event& event) {
  if (deposit.energy_keV <= 0.0 && !deposit.step) return;
  if (scintillates(scene, deposit.region))
    event.deposits.push_back(deposit);
  else
    event.non_scintillating_keV += deposit.energy_keV;
}

}  // namespace scintray::source
