#pragma once
/// One scene, ready to be traced.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/scene/build_scene.hpp"
#include "scintray/simulation/mapped_response.hpp"
#include "scintray/simulation/run_point.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray::simulation {

/// A built scene, its source bound to it, and what is counted. Immutable: it can be traced by any thread, as
/// often as one likes, and each time has the same result.
class SimulationPoint {
 public:
  /// Builds the scene.
  /// @param number  of the point in its sweep: each has random streams of its own
  /// @throws InputError with every problem of the scene, or of its source, or of its tallies
  SimulationPoint(scene_file::SceneSpec spec, scene::SceneBuilder& builder, std::uint32_t number = 0);
  /// A scene that differs in its source, tallies and run settings only from the one that was built, so that
  /// nothing is built again.
  SimulationPoint(scene_file::SceneSpec spec, std::shared_ptr<const scene::BuiltScene> built,
                  std::uint32_t number = 0);
  SimulationPoint(const SimulationPoint&) = delete;
  SimulationPoint& operator=(const SimulationPoint&) = delete;

  const scene_file::SceneSpec& spec() const { return spec_; }
  const scene::Scene& scene() const { return built_->scene; }
  /// The scene with its parts as they were placed.
  const std::shared_ptr<const scene::BuiltScene>& built() const { return built_; }
  const source::LightSource& source() const { return *source_; }
  const tally::TallyPlan& plan() const { return plan_; }
  /// What a user should know of the scene, none of which stops a run.
  const std::vector<std::string>& warnings() const { return built_->warnings; }
  /// The same of the source.
  const std::vector<std::string>& source_notes() const { return source_notes_; }
  /// Photons, or events of a source of energy.
  std::uint64_t work() const { return source_->has_energy() ? source_->events() : source_->photons(); }
  /// Seed, limits, threads and random streams.
  const RunSettings& settings() const { return settings_; }

  /// When one photon of an event is detected, where it is one for all light.
  std::optional<tally::LightTiming> timing() const;

  /// Traces all photons. Indices in what it returns and in what hooks receive are those of scene().
  /// @throws InternalError when a photon has no fate
  tally::PointResult trace(const RunHooks& hooks = {}) const;
  /// Makes the events from a response map; no photon is traced. @throws InputError as run_mapped does
  tally::PointResult trace(const MappedResponse& response, const RunHooks& hooks = {}) const;
  /// Follows one photon of trace() again; `visit` sees every step. Returns the photon as it ended.
  /// @throws InputError when there is no such photon
  source::Photon replay(std::uint64_t event, std::uint64_t photon, const transport::StepVisitor& visit) const;

 private:
  scene_file::SceneSpec spec_;
  std::shared_ptr<const scene::BuiltScene> built_;
  std::vector<std::string> source_notes_;
  std::unique_ptr<source::LightSource> source_;
  tally::TallyPlan plan_;
  RunSettings settings_;
};

}  // namespace scintray::simulation
