#include "scintray/source/detail/scintillation_source.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/count_sampling.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/optics/decay_time.hpp"
#include "scintray/source/detail/scintillation.hpp"

namespace scintray::source {

std::uint64_t sample_photon_number(const optics::Medium& medium, double energy_keV, core::Rng& rng) {
  double mean = medium.yield_per_keV * medium.relative_yield(energy_keV) * energy_keV;
  if (medium.intrinsic_fwhm > 0.0)
    mean += medium.intrinsic_fwhm / core::kFwhmPerSigma * medium.yield_per_keV *
            std::sqrt(medium.intrinsic_keV * energy_keV) * core::sample_normal(rng);
  return core::sample_poisson(mean, rng);
}

ScintillationSource::ScintillationSource(std::unique_ptr<EventSource> events, const scene::Scene& scene,
                                         const LightOptions& options)
    : events_(std::move(events)), unpolarised_(options.unpolarised) {
  for (const scene::SceneMedium& medium : scene.media)
    emission_.push_back(medium.medium().yield_per_keV > 0.0 ? core::CurveSampler(medium.medium().emission)
                                                            : core::CurveSampler());
  for (const core::RegionId region : scene.regions.ids())
    if (scintillates(scene, region)) regions_.push_back(region);
  if (!options.cherenkov) return;
  const auto [low_nm, high_nm] = options.cherenkov_nm.value_or(std::array{scene.low_nm, scene.high_nm});
  for (const scene::SceneMedium& medium : scene.media) {
    cherenkov_.emplace_back();
    if (medium.medium().yield_per_keV > 0.0) cherenkov_.back().emplace(medium.medium(), low_nm, high_nm);
  }
}

std::vector<core::RegionId> ScintillationSource::regions() const { return regions_; }

void ScintillationSource::begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
                                EventLight& light) const {
  light.event = events_->make(scene, event, rng);
  light.photons = 0;
  light.deposits.clear();
  for (const Deposit& deposit : light.event.deposits) {
    const core::MediumId at = scene.regions[deposit.region].medium;
    light.photons += sample_photon_number(scene.media[at].medium(), deposit.energy_keV, rng);
    light.deposits.push_back({light.photons, light.photons});
    if (cherenkov_.empty()) continue;
    light.photons += core::sample_poisson(cherenkov_[at]->mean_photons(deposit.energy_keV), rng);
    light.deposits.back().all = light.photons;
  }
}

Photon ScintillationSource::emit(const scene::Scene& scene, const EventLight& light, std::uint64_t number,
                                 core::Rng& rng) const {
  const auto from = std::upper_bound(
      light.deposits.begin(), light.deposits.end(), number,
      [](std::uint64_t photon, const EventLight::DepositEnd& end) { return photon < end.all; });
  const Deposit& deposit = light.event.deposits[static_cast<std::size_t>(from - light.deposits.begin())];
  const bool prompt = number >= from->scintillation;
  const core::MediumId medium = scene.regions[deposit.region].medium;
  Photon photon;
  photon.position = deposit.position;
  photon.region = deposit.region;
  photon.ray.direction = core::sample_isotropic(rng);
  photon.ray.polarisation =
      unpolarised_ ? core::Vec3(core::Vec3::Zero()) : core::sample_polarisation(photon.ray.direction, rng);
  photon.wavelength_nm = prompt ? cherenkov_[medium]->sample_wavelength(deposit.energy_keV, rng)
                                : emission_[medium].sample(rng.uniform());
  photon.time_ns =
      deposit.time_ns + (prompt ? 0.0 : optics::sample_decay(scene.media[medium].medium().decay, rng));
  photon.optics = scene.optics.at(medium, photon.wavelength_nm);
  photon.optical_depth = core::sample_exponential(rng);
  return photon;
}

}  // namespace scintray::source
