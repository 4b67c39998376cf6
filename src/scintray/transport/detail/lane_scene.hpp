#pragma once
/// The regions of a scene in which photons stay in the lanes of lanes/lane_pool.hpp, as the lanes need them.

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "scintray/optics/lane_surface.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/transport/detail/lanes/lane_pool.hpp"
#include "scintray/transport/lane_plan.hpp"

namespace scintray::transport {

/// Planes, gaps and faces of the regions of LaneKind::surfaces. What depends on the wavelength is apart, as
/// photons of many wavelengths share the faces.
class LaneScene {
 public:
  LaneScene(const scene::Scene& scene, const LaneKinds& kinds);

  const LaneRegion& region(core::RegionId id) const { return regions_[id].region; }
  std::size_t face_count(core::RegionId id) const { return regions_[id].faces.size(); }
  /// Planes of a region, and faces, for lanes in which neither is used.
  LaneRegion any_planes() const;
  /// Whether some region has gaps.
  bool has_gaps() const { return has_gaps_; }
  /// Whether all light has one wavelength.
  bool has_one_wavelength() const { return scene_.low_nm == scene_.high_nm; }
  /// Number of the face, at a gap, of a triangle of a region with thin gaps; nothing where there is no gap in
  /// front of it, and for kNoTriangle.
  std::optional<std::uint32_t> face_at_gap(const scene::Region& region, std::uint32_t triangle) const;
  /// A triangle on a face of a region's boundary.
  std::uint32_t triangle(core::RegionId region, std::size_t face) const {
    return shapes_[scene_.regions[region].accelerator].triangles[face];
  }

  /// What depends on the wavelength, as LanePhoton::optics.
  struct AtWavelength {
    double wavelength_nm = 0.0;
    std::vector<LaneRecord> records;
  };
  void set_wavelength(double wavelength_nm, AtWavelength& to) const;

 private:
  /// Planes or gaps around regions of one shape.
  struct Shape {
    std::vector<PlanePair> planes;  ///< one without a plane where there are gaps
    std::vector<LaneGap> gaps;
    std::vector<std::uint32_t> triangles;         ///< of each face; two per PlanePair
    std::vector<bool> mixed;                      ///< likewise: the face leads to several regions
    std::vector<scene::ThinGaps::Range> gaps_of;  ///< likewise, of `gaps`
    std::vector<std::uint32_t> face_of;           ///< at gaps, by triangle
  };
  struct Region {
    LaneRegion region;
    std::vector<LaneFace> faces;
  };
  /// Faces that have the same surface between the same media.
  struct AlikeFaces {
    scene::BoundaryLink link;  ///< of one of them
    core::MediumId here;
    optics::LaneSurface surface;
    const LaneTable* tables = nullptr;  ///< of a table: the first of tables_of()
    LaneFaceOptics constant;            ///< what does not depend on the wavelength; the rest is 0
  };

  static void add_planes(const scene::Boundary& boundary, Shape& shape);
  static void add_gaps(const scene::Accelerator& accelerator, Shape& shape);
  const Shape& shape_of(const scene::Region& region);
  void make_faces(core::RegionId id);
  LaneFace face(const scene::Region& region, const Shape& shape, std::uint32_t number);
  /// Places among AtWavelength::records: of a face that has no surface for lanes, and of those alike.
  std::size_t no_surface() const { return scene_.optics.media.size(); }
  std::size_t place_of(std::size_t alike) const { return no_surface() + (alike + 1) * kRecords; }
  /// Place of the faces alike.
  std::size_t alike(const scene::BoundaryLink& link, core::MediumId here, const optics::LaneSurface& surface);
  /// Sets what is behind the faces of a region.
  void link_faces(core::RegionId id, const LaneKinds& kinds);
  /// Of a table, from each of its wavelengths to the next.
  const LaneTable* tables_of(const optics::SurfaceTable& table);

  /// Of a LaneFaceOptics.
  static constexpr std::size_t kRecords = sizeof(LaneFaceOptics) / sizeof(LaneRecord);

  const scene::Scene& scene_;
  core::IdVector<core::AcceleratorId, Shape> shapes_;  ///< without triangles: not made
  core::IdVector<core::RegionId, Region> regions_;
  LaneRegion any_planes_;
  bool has_gaps_ = false;
  std::vector<AlikeFaces> alike_;
  std::vector<core::MediumId> media_;
  std::map<const optics::SurfaceTable*, std::vector<LaneTable>> tables_;
};

}  // namespace scintray::transport
