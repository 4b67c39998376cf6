#pragma once
/// A scene of the benchmark, built, and traced as often as wanted.

#include <cstdint>
#include <memory>
#include <optional>

#include "scene_list.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::bench {

/// Work done by one trace, and the time that it took.
struct Trace {
  std::uint64_t segments = 0;  ///< straight segments of photons
  std::uint64_t photons = 0;
  std::uint64_t events = 0;  ///< of an event source; else 0
  std::uint64_t lost = 0;    ///< photons without a fate
  double wall_s = 0.0;
  double cpu_s = 0.0;  ///< processor time: of the calling thread for one thread, else of the process
  int lane_width = 1;  ///< photons that a thread propagated at once
};

/// Resources that building a scene took.
struct BuildCost {
  double seconds = 0.0;
  double megabytes = 0.0;  ///< resident memory, less that before
};

/// Immutable once built.
class Workload {
 public:
  /// Builds the scene. @throws InputError for errors in its file
  /// @param lane_width  of core::lane_widths(); nothing: the default
  explicit Workload(const BenchScene& scene, std::optional<int> lane_width = {});

  /// Traces the first photons, or the first events of an event source, of the scene.
  /// @param work        number of photons or events, at least 1
  /// @param threads     at least 1
  /// @param lane_width  of core::lane_widths(); nothing: that of the scene as built
  Trace trace(std::uint64_t work, int threads, std::optional<int> lane_width = {}) const;

  /// True when work counts events, not photons.
  bool has_events() const { return point_->source().has_energy(); }
  /// Number of photons or events in the smallest piece of work that one thread is given.
  std::uint64_t block() const { return has_events() ? 1 : 1024; }
  std::size_t regions() const { return point_->scene().regions.size(); }
  /// Triangles of all distinct accelerators.
  std::size_t triangles() const;
  const BuildCost& build_cost() const { return build_; }
  /// The scene with its source, as traced.
  const simulation::SimulationPoint& point() const { return *point_; }

 private:
  BuildCost build_;
  std::unique_ptr<const simulation::SimulationPoint> point_;
};

}  // namespace scintray::bench
