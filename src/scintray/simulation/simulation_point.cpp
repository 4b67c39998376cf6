#include "scintray/simulation/simulation_point.hpp"

#include <algorithm>

#include "scintray/simulation/detail/goal_watch.hpp"
#include "scintray/simulation/simulation_options.hpp"

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

/// True when the time of emission depends on the particle, or comes with each deposit.
bool decay_by_deposit(const scene::Scene& scene, const scene_file::GammaSpec& source) {
  constexpr auto kDecay = static_cast<std::size_t>(scene_file::StepColumn::decay);
  const auto* hits = std::get_if<scene_file::HitsSpec>(&source.kind);
  if (hits && (!hits->steps[kDecay].empty() || (hits->columns && !hits->columns->steps[kDecay].empty())))
    return true;
  return std::any_of(scene.media.begin(), scene.media.end(), [](const scene::SceneMedium& medium) {
    const std::vector<optics::ParticleLight>& lights = medium.medium().by_particle;
    return std::any_of(lights.begin(), lights.end(),
                       [](const optics::ParticleLight& light) { return !light.decay.empty(); });
  });
}

/// Emission and time spread of the sensors, where all light of events has the same: one decay in all media
/// that scintillate, sensors of one time spread behind a readout, no Cherenkov light and no wavelength
/// shifter. Empty otherwise.
std::optional<tally::LightTiming> light_timing(const scene::Scene& scene, const scene_file::SceneSpec& spec,
                                               const source::LightSource& source,
                                               const tally::TallyPlan& plan) {
  if (!source.has_energy() || spec.energy_source->cherenkov || plan.readout.empty() || any_shifts(scene))
    return std::nullopt;
  if (std::holds_alternative<scene_file::PhotonListSpec>(spec.energy_source->kind)) return std::nullopt;
  if (decay_by_deposit(scene, *spec.energy_source)) return std::nullopt;
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

/// True when nothing is recorded of photons that are not detected but their fates.
bool only_detected_count(const tally::TallyPlan& plan) {
  constexpr std::uint32_t kDetected = 1u << static_cast<unsigned>(core::StepEvent::detected);
  if (plan.history) return false;
  for (std::size_t i = 0; i < plan.counts.size(); ++i)
    if (plan.counts[i].fates != kDetected && plan.events_of[i] != kDetected) return false;
  return true;
}

RunSettings settings_of(const scene_file::SceneSpec& spec, const scene::Scene& scene,
                        const tally::TallyPlan& plan, std::uint32_t number) {
  RunSettings settings = run_settings(spec.run, number);
  if (spec.run.efficiency_at_birth && only_detected_count(plan))
    settings.birth_efficiency = efficiency_bound(scene);
  return settings;
}

}  // namespace

SimulationPoint::SimulationPoint(scene_file::SceneSpec spec, std::shared_ptr<const scene::BuiltScene> built,
                                 std::uint32_t number)
    : spec_(std::move(spec)),
      built_(std::move(built)),
      source_(source::make_light_source(spec_, built_->scene, &source_notes_)),
      plan_(built_->scene, spec_),
      settings_(settings_of(spec_, built_->scene, plan_, number)) {
  if (spec_.run.until) detail::goal_bin(*spec_.run.until, plan_);  // a bin that does not exist
  if (plan_.history && multiplies_light(built_->scene))
    throw core::InputError(core::Problem{
        spec_.run.where,
        "photon_history with a wavelength shifter that may re-emit several photons for one: the history of a "
        "detected photon would be that of its parent",
        "remove photon_history, or state statistics = \"single\" for the shifter"});
}

SimulationPoint::SimulationPoint(scene_file::SceneSpec spec, scene::SceneBuilder& builder,
                                 std::uint32_t number)
    : SimulationPoint(spec, std::make_shared<const scene::BuiltScene>(builder.build(spec)), number) {}

std::optional<tally::LightTiming> SimulationPoint::timing() const {
  return light_timing(scene(), spec_, *source_, plan_);
}

tally::PointFacts SimulationPoint::facts() const { return {timing(), omitted(), settings_.birth_efficiency}; }

const transport::LanePlan& SimulationPoint::lanes() const {
  std::call_once(has_lanes_, [this] { lanes_ = lane_plan_of(scene(), *source_, plan_, settings_); });
  return *lanes_;
}

tally::PointResult SimulationPoint::trace(const RunHooks& hooks) const {
  tally::PointResult result = run_point(traced(), settings_, hooks);
  static_cast<tally::PointFacts&>(result) = facts();
  return result;
}

tally::BlockRange SimulationPoint::trace(const tally::BlockRange& blocks, const RunHooks& hooks) const {
  return trace_blocks(traced(), settings_, blocks, hooks);
}

tally::PointResult SimulationPoint::trace(const MappedResponse& response, const RunHooks& hooks) const {
  tally::PointResult result = run_mapped(scene(), *source_, plan_, response, settings_, hooks);
  static_cast<tally::PointFacts&>(result) = facts();
  return result;
}

source::Photon SimulationPoint::replay(std::uint64_t event, std::uint64_t photon,
                                       const transport::StepVisitor& visit) const {
  return scintray::simulation::replay(scene(), *source_, settings_, {event, photon}, visit);
}

source::Photon SimulationPoint::start(std::uint64_t event, std::uint64_t photon) const {
  return start_of_photon(scene(), *source_, settings_, {event, photon});
}

}  // namespace scintray::simulation
