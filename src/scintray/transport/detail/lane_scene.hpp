#pragma once
/// Regions of a scene in the form in which photons in lanes see them.

#include <memory>
#include <vector>

#include "scintray/scene/scene.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/transport/detail/lanes/lane_pool.hpp"

namespace scintray::transport {

/// Planes and faces of the regions that photons enter, made when the first one does. Faces depend on the
/// wavelength: those of a region's first photon serve all others of its wavelength; photons of other
/// wavelengths have faces of their own.
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
  struct Faces {
    core::RegionId region;
    double wavelength_nm = 0.0;
    std::vector<LaneFace> faces;  ///< two per PlanePair; empty: not made
  };

  const Planes& planes_of(const scene::Region& region);
  void make_faces(const source::Photon& photon, const Planes& planes, Faces& faces) const;
  LaneFace face(const source::Photon& photon, std::uint32_t triangle) const;

  const scene::Scene& scene_;
  std::vector<std::unique_ptr<Planes>> planes_;  ///< by accelerator
  std::vector<Faces> faces_;                     ///< by region
  std::vector<Faces> own_;                       ///< by photon
};

}  // namespace scintray::transport
