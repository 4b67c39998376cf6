#include "scintray/source/detail/event_sources.hpp"

#include "scintray/source/detail/gamma/transport.hpp"
#include "scintray/source/detail/scintillation.hpp"

namespace scintray::source {

SpectrumEventSource::SpectrumEventSource(const scene_file::SpectrumSpec& spec, std::uint64_t events,
                                         bool cherenkov, const scene::Scene& scene)
    : origin_(spec.origin, scene), energy_keV_(spec.energy_keV.value_or(0.0)), events_(events) {
  if (!spec.energy_keV) spectrum_.emplace(spec.spectrum);
  require_scintillators(scene, origin_.regions(), spec.origin_where);
  if (spec.particle == scene_file::Depositing::electron) return;
  std::vector<core::RegionId> regions;
  for (const core::RegionId region : origin_.regions())
    if (depends_on_electrons(scene.media[scene.regions[region].medium].medium(), cherenkov))
      regions.push_back(region);
  if (!regions.empty()) gammas_.emplace(scene, regions);
}

Event SpectrumEventSource::make(const scene::Scene& scene, std::uint64_t, core::Rng& rng) const {
  const Place place = origin_.sample(scene, rng);
  Event event;
  event.energy_keV = spectrum_ ? spectrum_->sample(rng.uniform()) : energy_keV_;
  if (gammas_ && gammas_->matter(place.region) && event.energy_keV >= scene_file::kLowestGamma_keV &&
      event.energy_keV <= scene_file::kHighestGamma_keV) {
    const Gamma gamma{place.position, core::Vec3::UnitZ(), event.energy_keV, 0.0, place.region};
    gammas_->absorb_all(scene, gamma, rng, event);
  } else {
    event.deposits.push_back({place.position, place.region, event.energy_keV, 0.0});
  }
  return event;
}

}  // namespace scintray::source
