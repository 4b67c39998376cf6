#include "scintray/source/detail/event_sources.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/source/detail/gamma/decay.hpp"
#include "scintray/source/detail/gamma/transport.hpp"
#include "scintray/source/detail/scintillation.hpp"

namespace scintray::source {

namespace {

constexpr int kLutetium = 71;

}  // namespace

GammaEventSource::GammaEventSource(const scene_file::EmitterSpec& spec, std::uint64_t events,
                                   const scene::Scene& scene)
    : emission_(spec.emission),
      energy_keV_(spec.energy_keV),
      direction_(spec.direction),
      acollinearity_sigma_rad_(spec.acollinearity_rad / core::kFwhmPerSigma),
      decay_(spec.emission),
      transport_(scene, spec.matter, spec.fluorescence, spec.origin_where),
      events_(events) {
  if (const auto* plane = std::get_if<scene_file::PlaneSpec>(&spec.origin))
    plane_ = *plane;
  else if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec.origin))
    origin_.emplace(*region, scene);
  else
    origin_.emplace(std::get<core::Vec3>(spec.origin), scene);
  if (emission_ == scene_file::Emission::lutetium) check_lutetium(spec, scene);
  for (const core::RegionId region : scene.regions.ids())
    if (scintillates(scene, region)) return;
  throw core::InputError({spec.origin_where, "no part of the scene scintillates, so gammas make no light",
                          "give a part a medium with [yield], [emission] and [[decay]], as LSO"});
}

void GammaEventSource::check_lutetium(const scene_file::EmitterSpec& spec, const scene::Scene& scene) const {
  const auto has_lutetium = [&](core::RegionId region) {
    const optics::Composition& made_of = scene.media[scene.regions[region].medium].medium().composition;
    return std::any_of(made_of.begin(), made_of.end(),
                       [](const optics::ElementShare& share) { return share.atomic_number == kLutetium; });
  };
  if (!origin_)
    throw core::InputError({spec.origin_where, "176Lu decays inside a crystal, not on a plane",
                            "write region = { part = \"...\" } with the part that holds lutetium"});
  for (const core::RegionId region : origin_->regions())
    if (!has_lutetium(region))
      throw core::InputError(
          {spec.origin_where,
           "there is no lutetium in \"" + scene.region_names[region] + "\", where 176Lu is to decay",
           "name parts of LSO or LYSO"});
}

Place GammaEventSource::sample_place(const scene::Scene& scene, core::Rng& rng) const {
  if (origin_) return origin_->sample(scene, rng);
  const double x = rng.uniform() - 0.5, y = rng.uniform() - 0.5;
  const core::Vec3 position = plane_.centre + x * plane_.x + y * plane_.y;
  return {position, scene.locate(position)};
}

void GammaEventSource::add_pair(Gamma gamma, core::Rng& rng, std::vector<Gamma>& gammas) const {
  gamma.energy_keV = core::kElectronMass_keV;
  gamma.direction = sample_direction(direction_, rng);
  gammas.push_back(gamma);
  const core::Frame frame = core::Frame::about(gamma.direction);
  gamma.direction = -gamma.direction;
  if (acollinearity_sigma_rad_ > 0.0) {
    const double x = acollinearity_sigma_rad_ * core::sample_normal(rng);
    const double y = acollinearity_sigma_rad_ * core::sample_normal(rng);
    gamma.direction = (gamma.direction + x * frame.x + y * frame.y).normalized();
  }
  gammas.push_back(gamma);
}

GammaEventSource::Start GammaEventSource::start(const scene::Scene& scene, core::Rng& rng) const {
  Start start;
  start.place = sample_place(scene, rng);
  const Emitted emitted = decay_.sample(rng);
  start.electrons_keV = emitted.electrons_keV;
  Gamma gamma;
  gamma.position = start.place.position;
  gamma.region = start.place.region;
  if (emission_ == scene_file::Emission::gamma) {
    gamma.energy_keV = energy_keV_;
    gamma.direction = sample_direction(direction_, rng);
    start.gammas.push_back(gamma);
  }
  for (const double energy_keV : emitted.gammas_keV) {
    gamma.energy_keV = energy_keV;
    gamma.direction = core::sample_isotropic(rng);
    start.gammas.push_back(gamma);
  }
  if (emitted.pair) add_pair(gamma, rng, start.gammas);
  return start;
}

Event GammaEventSource::make(const scene::Scene& scene, std::uint64_t, core::Rng& rng) const {
  Start begin = start(scene, rng);
  Event event;
  event.energy_keV = begin.local_keV();
  for (const Gamma& gamma : begin.gammas) event.energy_keV += gamma.energy_keV;
  for (const double energy_keV : begin.electrons_keV)
    leave_energy(scene, {begin.place.position, begin.place.region, energy_keV, 0.0}, event);
  transport_.follow(scene, std::move(begin.gammas), rng, event);
  return event;
}

}  // namespace scintray::source
