#include "scintray/simulation/simulation_point.hpp"

#include "scintray/simulation/simulation_options.hpp"
#include "scintray/trace/light_timing.hpp"
#include "scintray/trace/run_mapped.hpp"

namespace scintray {

SimulationPoint::SimulationPoint(SceneSpec spec, std::shared_ptr<const BuiltScene> built,
                                 std::uint32_t number)
    : spec_(std::move(spec)),
      built_(std::move(built)),
      source_(make_light_source(spec_, built_->scene, &source_notes_)),
      plan_(built_->scene, spec_),
      settings_(run_settings(spec_.run, number)) {}

SimulationPoint::SimulationPoint(SceneSpec spec, SceneBuilder& builder, std::uint32_t number)
    : SimulationPoint(spec, std::make_shared<const BuiltScene>(builder.build(spec)), number) {}

std::optional<LightTiming> SimulationPoint::timing() const {
  return light_timing(scene(), spec_, *source_, plan_);
}

PointResult SimulationPoint::trace(const RunHooks& hooks) const {
  PointResult result = run_point(scene(), *source_, plan_, settings_, hooks);
  result.light_timing = timing();
  return result;
}

PointResult SimulationPoint::trace(const MappedResponse& response, const RunHooks& hooks) const {
  PointResult result = run_mapped(scene(), *source_, plan_, response, settings_, hooks);
  result.light_timing = timing();
  return result;
}

Photon SimulationPoint::replay(std::uint64_t event, std::uint64_t photon, const StepVisitor& visit) const {
  return scintray::replay(scene(), *source_, settings_, event, photon, visit);
}

}  // namespace scintray
