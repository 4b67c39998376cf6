#include "scintray/source/detail/event_sources.hpp"

#include "scintray/source/detail/scintillation.hpp"

namespace scintray::source {

SpectrumEventSource::SpectrumEventSource(const scene_file::SpectrumSpec& spec, std::uint64_t events,
                                         const scene::Scene& scene)
    : origin_(spec.origin, scene), energy_keV_(spec.energy_keV.value_or(0.0)), events_(events) {
  if (!spec.energy_keV) spectrum_.emplace(spec.spectrum);
  require_scintillators(scene, origin_.regions(), spec.origin_where);
}

Event SpectrumEventSource::make(const scene::Scene& scene, std::uint64_t, core::Rng& rng) const {
  const Place place = origin_.sample(scene, rng);
  Event event;
  event.energy_keV = spectrum_ ? spectrum_->sample(rng.uniform()) : energy_keV_;
  event.deposits.push_back({place.position, place.region, event.energy_keV, 0.0});
  return event;
}

}  // namespace scintray::source
