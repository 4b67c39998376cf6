#include "scintray/source/detail/scintillation_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/count_sampling.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/optics/decay_time.hpp"
#include "scintray/source/detail/emission_lanes.hpp"
#include "scintray/source/detail/scintillation.hpp"
#include "scintray/source/photon_optics.hpp"

namespace scintray::source {

namespace {

/// Photons about a mean, with the spread of an electron of as much light.
std::uint64_t sample_about(const optics::Medium& medium, double mean, core::Rng& rng) {
  if (medium.intrinsic_fwhm > 0.0)
    mean += medium.intrinsic_fwhm / core::kFwhmPerSigma *
            std::sqrt(medium.yield_per_keV * medium.intrinsic_keV * mean) * core::sample_normal(rng);
  return core::sample_poisson(mean, rng);
}

/// Time (ns) that a particle takes to a place along its step; 0 where its velocity is not known.
double time_along(const ParticleStep& step, double along) {
  const double beta = step.beta + 0.5 * along * (step.beta_end - step.beta);
  return beta > 0.0 ? along * step.displacement.norm() / (beta * core::kSpeedOfLight_mm_per_ns) : 0.0;
}

/// Number of the light of the deposit's kind of particle in a medium; nothing where it is as of all
/// particles.
std::optional<std::size_t> light_of(const optics::Medium& medium, const Deposit& deposit) {
  const optics::Particle kind = deposit.step ? deposit.step->particle : optics::Particle::electron;
  for (std::size_t i = 0; i < medium.by_particle.size(); ++i)
    if (medium.by_particle[i].particle == kind) return i;
  return std::nullopt;
}

/// Time of emission after a deposit: by its step, its kind of particle, or the medium.
double sample_decay_of(const optics::Medium& medium, const Deposit& deposit, core::Rng& rng) {
  if (deposit.step && deposit.step->decay_ns > 0.0)
    return optics::sample_decay({{deposit.step->decay_ns, deposit.step->rise_ns, 1.0}}, rng);
  const std::optional<std::size_t> light = light_of(medium, deposit);
  const bool own = light && !medium.by_particle[*light].decay.empty();
  return optics::sample_decay(own ? medium.by_particle[*light].decay : medium.decay, rng);
}

}  // namespace

std::uint64_t sample_photon_number(const optics::Medium& medium, double energy_keV, core::Rng& rng) {
  double mean = medium.yield_per_keV * medium.relative_yield(energy_keV) * energy_keV;
  if (medium.intrinsic_fwhm > 0.0)
    mean += medium.intrinsic_fwhm / core::kFwhmPerSigma * medium.yield_per_keV *
            std::sqrt(medium.intrinsic_keV * energy_keV) * core::sample_normal(rng);
  return core::sample_poisson(mean, rng);
}

core::Curve birks_response(const optics::Medium& medium) {
  constexpr double kLowest_keV = 10.0, kStep = 1.02;
  if (medium.composition.empty())
    throw core::InputError(
        {{},
         "medium \"" + medium.name +
             "\" has a Birks constant, but its composition is not known, so neither is the "
             "energy that electrons lose per path",
         "add [composition] and [density] to its definition, or give deposits as steps with "
         "their displacement (dx, dy, dz)"});
  const ElectronStopping stopping(medium.composition, medium.density_g_per_cm3);
  const auto seen = [&](double energy_keV) {
    return 1.0 / (1.0 + medium.birks_mm_per_keV * stopping.keV_per_mm(std::max(energy_keV, kLowest_keV)));
  };
  std::vector<double> energies{0.0, kLowest_keV}, visible{0.0, kLowest_keV * seen(kLowest_keV)};
  while (energies.back() < CherenkovEmitter::kGreatestEnergy_keV) {
    const double low = energies.back(), high = low * kStep;
    visible.push_back(visible.back() +
                      (high - low) / 6.0 * (seen(low) + 4.0 * seen(0.5 * (low + high)) + seen(high)));
    energies.push_back(high);
  }
  return {std::move(energies), std::move(visible)};
}

double mean_scintillation(const optics::Medium& medium, const Deposit& deposit, const core::Curve& birks) {
  if (const std::optional<std::size_t> number = light_of(medium, deposit)) {
    const optics::ParticleLight& light = medium.by_particle[*number];
    const double from_keV =
        deposit.step ? deposit.step->kinetic_keV.value_or(deposit.energy_keV) : deposit.energy_keV;
    if (from_keV > light.photons.x().back())
      throw core::InputError(
          {{},
           fmt::format("a particle of {:g} keV in medium \"{}\", whose light is given up to "
                       "{:g} keV",
                       from_keV, medium.name, light.photons.x().back()),
           "extend photons in its [[particle_light]]"});
    return light.photons(from_keV) - light.photons(std::max(0.0, from_keV - deposit.energy_keV));
  }
  if (medium.birks_mm_per_keV > 0.0) {
    const double length_mm = deposit.step ? deposit.step->displacement.norm() : 0.0;
    const double seen_keV =
        length_mm > 0.0
            ? deposit.energy_keV / (1.0 + medium.birks_mm_per_keV * deposit.energy_keV / length_mm)
            : birks(deposit.energy_keV);
    return medium.yield_per_keV * seen_keV;
  }
  return medium.yield_per_keV * medium.relative_yield(deposit.energy_keV) * deposit.energy_keV;
}

ScintillationSource::ScintillationSource(std::unique_ptr<EventSource> events, const scene::Scene& scene,
                                         const LightOptions& options)
    : events_(std::move(events)), unpolarised_(options.unpolarised) {
  for (const scene::SceneMedium& medium : scene.media)
    emission_.push_back(medium.medium().yield_per_keV > 0.0 ? core::CurveSampler(medium.medium().emission)
                                                            : core::CurveSampler());
  for (const core::MediumId id : scene.media.ids()) {
    particle_emission_.emplace_back();
    for (const optics::ParticleLight& light : scene.media[id].medium().by_particle)
      particle_emission_.back().push_back(light.emission ? core::CurveSampler(*light.emission)
                                                         : emission_[id]);
  }
  for (const core::RegionId region : scene.regions.ids())
    if (scintillates(scene, region)) regions_.push_back(region);
  for (const scene::SceneMedium& medium : scene.media)
    birks_.push_back(medium.medium().birks_mm_per_keV > 0.0 && !events_->has_steps()
                         ? birks_response(medium.medium())
                         : core::Curve());
  if (!options.cherenkov) return;
  const auto range_nm = options.cherenkov_nm.value_or(std::array{scene.low_nm, scene.high_nm});
  if (events_->has_steps()) {
    add_steps(scene, range_nm);
    return;
  }
  const auto [low_nm, high_nm] = range_nm;
  for (const scene::SceneMedium& medium : scene.media) {
    cherenkov_.emplace_back();
    if (medium.medium().yield_per_keV > 0.0) cherenkov_.back().emplace(medium.medium(), low_nm, high_nm);
  }
}

void ScintillationSource::add_steps(const scene::Scene& scene, const std::array<double, 2>& range_nm) {
  for (const scene::SceneMedium& medium : scene.media) {
    tracks_.emplace_back();
    if (!medium.is_opaque()) tracks_.back().emplace(medium.medium(), range_nm[0], range_nm[1]);
  }
  regions_.clear();
  for (const core::RegionId region : scene.regions.ids())
    if (!scene.media[scene.regions[region].medium].is_opaque()) regions_.push_back(region);
}

std::vector<core::RegionId> ScintillationSource::regions() const { return regions_; }

std::uint64_t ScintillationSource::scintillation_photons(const optics::Medium& medium, core::MediumId at,
                                                         const Deposit& deposit, core::Rng& rng) const {
  if (deposit.step && deposit.step->scintillation) return *deposit.step->scintillation;
  if (medium.by_particle.empty() && medium.birks_mm_per_keV == 0.0)
    return sample_photon_number(medium, deposit.energy_keV, rng);
  return sample_about(medium, mean_scintillation(medium, deposit, birks_[at]), rng);
}

void ScintillationSource::begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
                                EventLight& light) const {
  light.event = events_->make(scene, event, rng);
  light.photons = 0;
  light.deposits.clear();
  for (const Deposit& deposit : light.event.deposits) {
    const core::MediumId at = scene.regions[deposit.region].medium;
    light.photons += scintillation_photons(scene.media[at].medium(), at, deposit, rng);
    light.deposits.push_back({light.photons, light.photons});
    if (!cherenkov_.empty())
      light.photons += core::sample_poisson(cherenkov_[at]->mean_photons(deposit.energy_keV), rng);
    else if (!tracks_.empty() && deposit.step)
      light.photons += deposit.step->cherenkov
                           ? *deposit.step->cherenkov
                           : core::sample_poisson(tracks_[at]->mean_photons(*deposit.step), rng);
    light.deposits.back().all = light.photons;
  }
}

const core::CurveSampler& ScintillationSource::spectrum_of(const scene::Scene& scene, core::MediumId medium,
                                                           const Deposit& deposit) const {
  const std::optional<std::size_t> light = light_of(scene.media[medium].medium(), deposit);
  return light ? particle_emission_[medium][*light] : emission_[medium];
}

void ScintillationSource::emit_cherenkov(const Deposit& deposit, core::MediumId medium, Photon& photon,
                                         core::Rng& rng) const {
  const ParticleStep& step = *deposit.step;
  const CherenkovTrack::Emission emission = tracks_[medium]->sample(step, rng);
  photon.position = deposit.position + emission.along * step.displacement;
  photon.ray.direction = emission.direction;
  photon.ray.polarisation = unpolarised_ ? core::Vec3(core::Vec3::Zero()) : emission.polarisation;
  photon.wavelength_nm = emission.wavelength_nm;
  photon.time_ns = deposit.time_ns + time_along(step, emission.along);
}

ScintillationSource::Cause ScintillationSource::cause_of(const scene::Scene& scene, const EventLight& light,
                                                         std::uint64_t number) {
  const auto from = std::upper_bound(
      light.deposits.begin(), light.deposits.end(), number,
      [](std::uint64_t photon, const EventLight::DepositEnd& end) { return photon < end.all; });
  const Deposit& deposit = light.event.deposits[static_cast<std::size_t>(from - light.deposits.begin())];
  return {&deposit, number >= from->scintillation, scene.regions[deposit.region].medium};
}

void ScintillationSource::set_colour(const scene::Scene& scene, const Cause& from, Photon& photon,
                                     core::Rng& rng) const {
  const auto& [cause, prompt, medium] = from;
  const Deposit& deposit = *cause;
  photon.wavelength_nm = prompt ? cherenkov_[medium]->sample_wavelength(deposit.energy_keV, rng)
                                : spectrum_of(scene, medium, deposit).sample(rng.uniform());
  photon.time_ns =
      deposit.time_ns + (prompt ? 0.0 : sample_decay_of(scene.media[medium].medium(), deposit, rng));
}

Photon ScintillationSource::emit(const scene::Scene& scene, const EventLight& light, std::uint64_t number,
                                 core::Rng& rng) const {
  const Cause from = cause_of(scene, light, number);
  const auto& [cause, prompt, medium] = from;
  const Deposit& deposit = *cause;
  Photon photon;
  photon.region = deposit.region;
  photon.ray.keeps_phases = scene.keeps_phases;
  if (prompt && deposit.step) {
    emit_cherenkov(deposit, medium, photon, rng);
  } else {
    // A charged particle emits uniformly along its step, a neutral one deposits at its end.
    const double along = !deposit.step ? 0.0 : deposit.step->charge == 0.0 ? 1.0 : rng.uniform();
    photon.position = deposit.position;
    if (deposit.step) photon.position = deposit.position + along * deposit.step->displacement;
    photon.ray.direction = core::sample_isotropic(rng);
    photon.ray.polarisation =
        unpolarised_ ? core::Vec3(core::Vec3::Zero()) : core::sample_polarisation(photon.ray.direction, rng);
    set_colour(scene, from, photon, rng);
    if (deposit.step) photon.time_ns += time_along(*deposit.step, along);
  }
  photon.optics = scene.optics.at(medium, photon.wavelength_nm);
  photon.optical_depth = core::sample_exponential(rng);
  if (prompt && deposit.step)
    take_mode(scene, photon, rng);
  else
    emit_isotropic(scene, photon, rng);
  return photon;
}

void ScintillationSource::emit_together(const scene::Scene& scene, const EventLight& light,
                                        std::span<EmittedPhoton* const> photons, int lane_width) const {
  const EmissionLanes lanes(lane_width);
  if (!lanes.take(photons.size())) return LightSource::emit_together(scene, light, photons, lane_width);
  std::array<Cause, kEmitted> causes;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    causes[i] = cause_of(scene, light, photons[i]->number);
    if (causes[i].deposit->step) return LightSource::emit_together(scene, light, photons, lane_width);
  }
  for (EmittedPhoton* const emitted : photons) emitted->photon = {};
  lanes.emit_isotropic(photons, unpolarised_);
  for (std::size_t i = 0; i < photons.size(); ++i) {
    Photon& photon = photons[i]->photon;
    photon.position = causes[i].deposit->position;
    photon.region = causes[i].deposit->region;
    photon.ray.keeps_phases = scene.keeps_phases;
    set_colour(scene, causes[i], photon, photons[i]->rng);
    photon.optics = scene.optics.at(causes[i].medium, photon.wavelength_nm);
  }
  lanes.draw_depths(photons);
  for (EmittedPhoton* const emitted : photons) source::emit_isotropic(scene, emitted->photon, emitted->rng);
}

}  // namespace scintray::source
