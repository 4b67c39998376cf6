#include "scintray/simulation/detail/light_timing.hpp"

#include <algorithm>

namespace scintray::simulation {

namespace {

bool same_decay(const std::vector<optics::DecayComponent>& a, const std::vector<optics::DecayComponent>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const optics::DecayComponent& one, const optics::DecayComponent& other) {
                      return one.decay_ns == other.decay_ns && one.rise_ns == other.rise_ns &&
                             one.fraction == other.fraction;
                    });
}

bool any_shifts(const scene::Scene& scene) {
  return std::any_of(scene.media.begin(), scene.media.end(),
                     [](const scene::SceneMedium& medium) { return medium.medium().shifter != nullptr; }) ||
         std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                     [](const optics::Surface& surface) { return surface.shifts(); });
}

}  // namespace

std::optional<tally::LightTiming> light_timing(const scene::Scene& scene, const scene_file::SceneSpec& spec,
                                               const source::LightSource& source,
                                               const tally::TallyPlan& plan) {
  if (!source.has_energy() || spec.energy_source->cherenkov || plan.readout.empty() || any_shifts(scene))
    return std::nullopt;
  const std::vector<core::RegionId> regions = source.regions();
  if (regions.empty()) return std::nullopt;
  const auto decay_in = [&](core::RegionId region) -> const std::vector<optics::DecayComponent>& {
    return scene.media[scene.regions[region].medium].medium().decay;
  };
  const auto spread_of = [&](const tally::ReadoutChannel& channel) {
    return scene.sensors[channel.sensor].time_spread_ns;
  };
  tally::LightTiming timing{decay_in(regions.front()), spread_of(plan.channels.list.front())};
  for (const core::RegionId region : regions)
    if (!same_decay(decay_in(region), timing.decay)) return std::nullopt;
  for (const tally::ReadoutChannel& channel : plan.channels.list)
    if (spread_of(channel) != timing.time_spread_ns) return std::nullopt;
  if (timing.decay.empty()) return std::nullopt;
  return timing;
}

}  // namespace scintray::simulation
