#include "scintray/simulation/simulation_point.hpp"

#include "scintray/simulation/detail/light_timing.hpp"
#include "scintray/simulation/detail/run_mapped.hpp"
#include "scintray/simulation/simulation_options.hpp"

namespace scintray::simulation {

SimulationPoint::SimulationPoint(scene_file::SceneSpec spec, std::shared_ptr<const scene::BuiltScene> built,
                                 std::uint32_t number)
    : spec_(std::move(spec)),
      built_(std::move(built)),
      source_(source::make_light_source(spec_, built_->scene, &source_notes_)),
      plan_(built_->scene, spec_),
      settings_(run_settings(spec_.run, number)) {}

SimulationPoint::SimulationPoint(scene_file::SceneSpec spec, scene::SceneBuilder& builder,
                                 std::uint32_t number)
    : SimulationPoint(spec, std::make_shared<const scene::BuiltScene>(builder.build(spec)), number) {}

std::optional<tally::LightTiming> SimulationPoint::timing() const {
  return light_timing(scene(), spec_, *source_, plan_);
}

tally::PointResult SimulationPoint::trace(const RunHooks& hooks) const {
  tally::PointResult result = run_point(scene(), *source_, plan_, settings_, hooks);
  result.light_timing = timing();
  return result;
}

tally::PointResult SimulationPoint::trace(const MappedResponse& response, const RunHooks& hooks) const {
  tally::PointResult result = run_mapped(scene(), *source_, plan_, response, settings_, hooks);
  result.light_timing = timing();
  return result;
}

source::Photon SimulationPoint::replay(std::uint64_t event, std::uint64_t photon,
                                       const transport::StepVisitor& visit) const {
  return scintray::simulation::replay(scene(), *source_, settings_, event, photon, visit);
}

}  // namespace scintray::simulation
