#pragma once
/// Photons that stay in lanes at surfaces and from region to region.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/detail/lanes/lane_kernels.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

/// The photons of the pool of lane_pool.hpp: those in regions for surface lanes, until an event that is
/// treated for each photon separately.
class SurfaceLanes {
 public:
  /// @param kernel  of lane_pool.hpp, or null: no photon is entered
  /// @param lanes   of the scene; has to outlive this, as the scene
  SurfaceLanes(const scene::Scene& scene, const LaneScene& lanes, const PropagationLimits& limits,
               RunLanes kernel);

  /// Whether a photon in a region of LaneKind::surfaces can be entered.
  bool takes(const source::Photon& photon) const {
    if (pool_.one_wavelength && photon.wavelength_nm != at_first_.wavelength_nm) return false;
    const scene::Region& region = scene_.regions[photon.region];
    return !region.thin_gaps || lane_scene_.face_at_gap(region, photon.on_triangle).has_value();
  }
  bool has_room() const { return !free_.empty(); }
  bool empty() const { return free_.size() == LanePool::kPhotons; }
  /// Adds a photon. @pre has_room() and takes()
  /// @param name  of the photon, returned in Left::name
  void enter(std::uint32_t name, const source::Photon& photon, const core::Rng& rng);

  /// A photon that left the lanes.
  struct Left {
    std::uint32_t name = 0, slot = 0;
    double waiting_as = 0.0;     ///< lane_state
    std::uint32_t segments = 0;  ///< in the lanes, which its step does not count
  };
  /// Moves the photons until some leave. Their slots remain taken until finish().
  /// @return the photons that left; valid until the next call
  const std::vector<Left>& run();
  /// Sets photon and stream to the state at which the photon left the lanes, and completes its step.
  Step finish(const Left& left, source::Photon& photon, core::Rng& rng);

 private:
  /// Puts a photon's random stream into the pool.
  static void give_numbers(const core::Rng& rng, LanePhoton& to);
  /// Sets a random stream to where the pool has drawn up to.
  static void take_numbers(const LanePhoton& from, core::Rng& rng);
  const LaneRecord* optics_at(double wavelength_nm, std::uint32_t slot);
  Step step_at_end(const Left& left, source::Photon& photon, core::Rng& rng) const;

  const scene::Scene& scene_;
  PropagationLimits limits_;
  RunLanes run_;
  const LaneScene& lane_scene_;
  LaneScene::AtWavelength at_first_;          ///< of the first photon
  std::vector<LaneScene::AtWavelength> own_;  ///< by slot, of photons of other wavelengths
  LanePool pool_;
  std::array<std::uint32_t, LanePool::kPhotons> names_{};
  std::vector<std::uint32_t> free_;  ///< slots
  std::vector<Left> left_;
};

}  // namespace scintray::transport
