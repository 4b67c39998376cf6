#pragma once
/// Photons in lanes in regions that have rough faces or reflectors, and the data of those regions for the
/// lanes.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scintray/optics/lane_surface.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/transport/detail/lanes/lane_kernels.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

/// Planes and faces of the regions that photons enter, made when the first photon does. Faces depend on the
/// wavelength: those of a region's first photon serve all others of its wavelength; photons of other
/// wavelengths have faces of their own, in which only what the wavelength changes is computed again.
class LaneScene {
 public:
  explicit LaneScene(const scene::Scene& scene)
      : scene_(scene),
        planes_(scene.accelerators.size()),
        faces_(scene.regions.size()),
        own_(LanePool::kPhotons) {}

  /// Region, for its wavelength, of a photon in a region with Region::in_lanes.
  /// @param photon_index  of the pool: its last region is valid until the next call for it
  LaneRegion region_of(const source::Photon& photon, std::size_t photon_index);
  /// A triangle on a plane, by its number in the pool, of a region's boundary.
  std::uint32_t triangle(const scene::Region& region, std::size_t plane) const {
    return planes_[region.accelerator.index()]->triangles[plane];
  }

 private:
  struct Planes {
    std::vector<PlanePair> planes;
    std::vector<std::uint32_t> triangles;  ///< two per PlanePair
    std::vector<bool> mixed;               ///< likewise: it leads to several regions
  };
  /// Faces of a region at a wavelength.
  struct Faces {
    core::RegionId region;
    double wavelength_nm = 0.0;
    std::vector<LaneFace> faces;  ///< two per PlanePair; empty: not made
  };
  /// Faces of a region that have the same surface and the same medium behind it.
  struct AlikeFaces {
    scene::BoundaryLink link;  ///< of one of them
    optics::LaneSurface surface;
    const LaneTable* tables = nullptr;  ///< of a table: the first of tables_of()
    std::vector<std::uint32_t> planes;  ///< their numbers
  };
  struct RegionFaces {
    Faces at_first;                 ///< at the wavelength of the first photon
    std::vector<AlikeFaces> alike;  ///< all that depend on the wavelength
  };

  const Planes& planes_of(const scene::Region& region);
  void make_faces(const source::Photon& photon, const Planes& planes, RegionFaces& made);
  /// What of a face does not depend on the wavelength.
  LaneFace face(core::RegionId region, std::uint32_t triangle,
                const std::optional<optics::LaneSurface>& surface) const;
  AlikeFaces& alike(const scene::BoundaryLink& link, const optics::LaneSurface& surface,
                    std::vector<AlikeFaces>& of_region);
  /// Sets what depends on the wavelength, that of the photon.
  void set_wavelength(const source::Photon& photon, const std::vector<AlikeFaces>& alike,
                      std::vector<LaneFace>& faces) const;
  /// Of a table, from each of its wavelengths to the next.
  const LaneTable* tables_of(const optics::SurfaceTable& table);

  const scene::Scene& scene_;
  std::vector<std::unique_ptr<Planes>> planes_;  ///< by accelerator
  std::vector<RegionFaces> faces_;               ///< by region
  std::vector<Faces> own_;                       ///< by photon
  std::map<const optics::SurfaceTable*, std::vector<LaneTable>> tables_;
};

/// The photons of the pool of lane_pool.hpp: those in regions for surface lanes, until an event that is
/// treated for each photon separately.
class SurfaceLanes {
 public:
  /// @param kernel  of lane_pool.hpp, or null: no photon is entered
  SurfaceLanes(const scene::Scene& scene, const PropagationLimits& limits, RunLanes kernel);

  bool has_room() const { return !free_.empty(); }
  bool empty() const { return free_.size() == LanePool::kPhotons; }
  /// Adds a photon. @pre has_room()
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
