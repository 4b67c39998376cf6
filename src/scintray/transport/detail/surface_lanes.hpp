#pragma once
/// Photons in lanes in regions that have rough faces or reflectors.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

/// The photons of the pool of lane_pool.hpp: those in regions for surface lanes, until something happens to
/// them that is done for each alone.
class SurfaceLanes {
 public:
  /// @param kernel  of lane_pool.hpp, or null: no photon is entered
  SurfaceLanes(const scene::Scene& scene, const PropagationLimits& limits, RunLanes kernel);

  bool has_room() const { return !free_.empty(); }
  bool empty() const { return free_.size() == LanePool::kPhotons; }
  /// Takes a photon in, where there is room.
  /// @param name  of the photon, by which it is found again
  void enter(std::uint32_t name, const source::Photon& photon, const core::Rng& rng);

  /// A photon that left the lanes.
  struct Left {
    std::uint32_t name = 0, slot = 0;
    double waiting_as = 0.0;  ///< lane_state
  };
  /// Moves the photons until some leave. Their slots remain taken until finish().
  /// @return those; valid until the next call
  const std::vector<Left>& run();
  /// Sets photon and stream to where the photon left the lanes, and takes the rest of its step.
  /// @return the step, with the segments in the lanes too
  Step finish(const Left& left, source::Photon& photon, core::Rng& rng);

 private:
  void give_numbers(std::size_t slot, const core::Rng& rng);
  void take_numbers(std::size_t slot, core::Rng& rng) const;
  Step rest_of_step(const Left& left, source::Photon& photon, core::Rng& rng) const;
  Step step_at_end(const Left& left, source::Photon& photon, core::Rng& rng) const;

  const scene::Scene& scene_;
  PropagationLimits limits_;
  RunLanes run_;
  LaneScene lane_scene_;
  LanePool pool_;
  std::array<std::uint32_t, LanePool::kPhotons> names_{};
  std::vector<std::uint32_t> free_;  ///< slots
  std::vector<Left> left_;
};

}  // namespace scintray::transport
