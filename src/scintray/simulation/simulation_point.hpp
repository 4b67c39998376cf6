#pragma once
/// One point of a simulation, ready to be traced.

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scintray/scene/build_scene.hpp"
#include "scintray/simulation/mapped_response.hpp"
#include "scintray/simulation/run_point.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray::simulation {

/// A built scene with its source and tallies. Immutable: it can be traced by any thread, any number of times,
/// with the same result.
class SimulationPoint {
 public:
  /// Builds the scene.
  /// @param number  of the point in its sweep: each has random streams of its own
  /// @throws InputError with every problem of the scene, or of its source, or of its tallies
  SimulationPoint(scene_file::SceneSpec spec, scene::SceneBuilder& builder, std::uint32_t number = 0);
  /// A scene that differs only in its source, tallies and run settings from the built one, so that
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
  /// Warnings about the scene, none of which prevents a run.
  const std::vector<std::string>& warnings() const { return built_->warnings; }
  /// Warnings about the source.
  const std::vector<std::string>& source_notes() const { return source_notes_; }
  /// Number of photons, or of events of an event source.
  std::uint64_t work() const { return source_->has_energy() ? source_->events() : source_->photons(); }
  /// Seed, limits, threads and random streams.
  const RunSettings& settings() const { return settings_; }
  /// Number of photons that trace() propagates at once. No result depends on it.
  int lane_width() const { return lanes().width(); }

  /// Distribution of the detection time of a photon, where it is the same for all light.
  std::optional<tally::LightTiming> timing() const;
  /// Timing, omitted effects and birth efficiency.
  tally::PointFacts facts() const;

  /// Effects that results of this point do not include: of the media in which events scintillate, of the
  /// sensors and of the electronics.
  std::vector<tally::OmittedEffect> omitted() const;

  /// Result of all photons. Indices in it and in the arguments of hooks are those of scene().
  /// @throws InternalError when a photon has no fate
  tally::PointResult trace(const RunHooks& hooks = {}) const;
  /// Traces some blocks of photons, as trace_blocks().
  tally::BlockRange trace(const tally::BlockRange& blocks, const RunHooks& hooks) const;
  /// Events from a response map; no photon is traced. @throws InputError as run_mapped
  tally::PointResult trace(const MappedResponse& response, const RunHooks& hooks = {}) const;
  /// Replays one photon of trace(); `visit` is called for every step. Returns the photon as it ended.
  /// @throws InputError when there is no such photon
  source::Photon replay(std::uint64_t event, std::uint64_t photon, const transport::StepVisitor& visit) const;
  /// The photon that replay() follows, as it starts. @throws InputError when there is no such photon
  source::Photon start(std::uint64_t event, std::uint64_t photon) const;

 private:
  /// Made by the first call.
  const transport::LanePlan& lanes() const;
  TracedPoint traced() const { return {scene(), *source_, plan_, lanes()}; }

  scene_file::SceneSpec spec_;
  std::shared_ptr<const scene::BuiltScene> built_;
  std::vector<std::string> source_notes_;
  std::unique_ptr<source::LightSource> source_;
  tally::TallyPlan plan_;
  RunSettings settings_;
  mutable std::once_flag has_lanes_;
  mutable std::unique_ptr<const transport::LanePlan> lanes_;
};

}  // namespace scintray::simulation
