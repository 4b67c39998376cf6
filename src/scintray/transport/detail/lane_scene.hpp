#pragma once
/// The regions of a scene as the lanes need them, and the photons that stay in lanes at surfaces and from
/// region to region.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "scintray/optics/lane_surface.hpp"
#include "scintray/scene/accelerator.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/transport/batch.hpp"
#include "scintray/transport/detail/lanes/lane_kernels.hpp"

namespace scintray::transport {

/// The faces around a shape of region, for the kernels of lane_kernel.hpp: planes, or those of one convex
/// body, numbered as in LaneWork.
class LaneFaces {
 public:
  LaneFaces() = default;
  /// @param region  not rotated; bounded by planes, or one convex body. The scene must outlive this
  LaneFaces(const scene::Scene& scene, const scene::Region& region);

  struct Face {
    std::uint32_t triangle;  ///< of the region's boundary, on it
    bool mixed;              ///< leads to several regions
  };
  const std::vector<Face>& list() const { return list_; }
  bool has_quadrics() const { return !numbers_.empty(); }
  LanePlanes planes() const;
  LaneBody body() const;
  /// Per face, where all are planes.
  const LaneNormal* normals() const { return normals_.data(); }
  /// As of LaneWork, per face.
  struct Optics {
    double *least_sin2, *index_behind;
  };
  /// Sets those of a photon in one of the regions of this shape.
  /// @param refracts  there is a kernel for Fresnel's equations
  void set_optics(const scene::Scene& scene, const source::Photon& photon, bool refracts,
                  Optics optics) const;
  /// The face that a triangle is on, as LaneWork::left: kNoFace for planes, and for no triangle.
  double left_at(std::uint32_t triangle) const;

 private:
  const scene::Boundary* boundary_ = nullptr;
  std::vector<Face> list_;
  std::vector<LaneBody::Face> numbers_;  ///< of a body
  std::vector<LaneNormal> normals_;
  std::uint32_t flat_ = 0;  ///< of these, the first: planes
  bool cylinders_ = false;  ///< all others are cylinders
};

/// Planes, gaps and faces of the regions of LaneKind::surfaces. What depends on the wavelength is apart, as
/// photons of many wavelengths share the faces.
class LaneScene {
 public:
  LaneScene(const scene::Scene& scene, const LaneKinds& kinds);

  const LaneRegion& region(core::RegionId id) const { return regions_[id].region; }
  std::size_t face_count(core::RegionId id) const { return regions_[id].faces.size(); }
  /// Planes and faces for lanes without a photon, in which neither is used.
  LaneRegion any_planes() const;
  /// Whether all regions bounded by planes are boxes, as of scene::Boundary::is_box.
  bool has_boxes_alone() const { return has_boxes_alone_; }
  /// Whether all regions bounded by planes have one shape.
  bool has_one_shape() const { return has_one_shape_; }
  /// Whether some region unfolds.
  bool unfolds() const { return unfolds_; }
  /// Whether some region has gaps.
  bool has_gaps() const { return has_gaps_; }
  /// Whether some face has a region behind it that is in lanes as well.
  bool has_neighbours() const { return has_neighbours_; }
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
    std::vector<PlanePair> planes;  ///< none where there are gaps
    LaneBoxPlaces box{};            ///< of a box
    std::vector<LaneGap> gaps;
    std::vector<std::uint32_t> triangles;         ///< of each face; two per PlanePair
    std::vector<bool> mixed;                      ///< likewise: the face leads to several regions
    std::vector<scene::ThinGaps::Range> gaps_of;  ///< likewise, of `gaps`
    std::vector<std::uint32_t> face_of;           ///< at gaps, by triangle
  };
  struct MadeRegion {
    LaneRegion region;
    std::vector<LaneFace> faces;
  };
  /// Faces that have the same surface between the same media.
  struct AlikeFaces {
    scene::BoundaryLink link;     ///< of one of them
    core::MediumId here, behind;  ///< behind: of scene::medium_behind_surface(); none: as here
    optics::LaneSurface surface;
    const LaneTable* tables = nullptr;       ///< of a table: the first of tables_of()
    LaneFaceOptics constant{};               ///< what does not depend on the wavelength; the rest is 0
    const core::Curve* gap_index = nullptr;  ///< of the gap behind the surface; null: there is none
    bool plain = false;                      ///< scene::Interface::plain
    scene::TotalReflection total = {};
  };

  void add_planes(const scene::Boundary& boundary, Shape& shape);
  static void add_gaps(const scene::Accelerator& accelerator, Shape& shape);
  const Shape& shape_of(const scene::Region& region);
  void make_faces(core::RegionId id);
  /// Where the total reflections of a region that unfolds come from; requires all faces.
  void make_mirrors(MadeRegion& region);
  /// Adds one of those whose numbers depend on the wavelength, unless it is there; none is not added.
  void add_medium(core::MediumId medium);
  LaneFace face(const scene::Region& region, const Shape& shape, std::uint32_t number);
  /// Places among AtWavelength::records: of a face that has no surface for lanes, and of those alike.
  std::size_t no_surface() const { return scene_.optics.media.size(); }
  std::size_t place_of(std::size_t alike) const { return no_surface() + (alike + 1) * kRecords; }
  /// Place of the records of a region that unfolds: behind all those of faces.
  std::size_t place_of_mirrors(std::size_t mirrors) const { return place_of(alike_.size()) + 2 * mirrors; }
  /// Place of the faces alike.
  std::size_t alike(const scene::BoundaryLink& link, core::MediumId here, const optics::LaneSurface& surface);
  /// AtWavelength::records, whose numbers that depend on the wavelength are not set.
  std::vector<LaneRecord> initial_records() const;
  /// Sets what is behind the faces of a region.
  void link_faces(core::RegionId id, const LaneKinds& kinds);
  /// Of a table, from each of its wavelengths to the next.
  const LaneTable* tables_of(const optics::SurfaceTable& table);

  /// Of a LaneFaceOptics.
  static constexpr std::size_t kRecords = sizeof(LaneFaceOptics) / sizeof(LaneRecord);

  const scene::Scene& scene_;
  core::IdVector<core::AcceleratorId, Shape> shapes_;  ///< without triangles: not made
  core::IdVector<core::RegionId, MadeRegion> regions_;
  LaneRegion any_planes_;
  bool has_boxes_alone_ = true, has_one_shape_ = true, has_gaps_ = false, has_neighbours_ = false,
       unfolds_ = false;
  std::vector<AlikeFaces> alike_;
  using Mirrors = std::array<std::size_t, 6>;
  std::vector<Mirrors> mirrors_;  ///< of regions that unfold: place of the LaneFaceOptics of each face
  std::vector<core::MediumId> media_;
  std::vector<LaneRecord> initial_;  ///< initial_records()
  std::map<const optics::SurfaceTable*, std::vector<LaneTable>> tables_;
};

/// The photons of the pool of lane_pool.hpp: those in regions for surface lanes, until an event that is
/// treated for each photon separately.
class SurfaceLanes {
 public:
  /// @param kernel  of lane_pool.hpp, or null: no photon is entered
  /// @param lanes   of the scene; has to outlive this, as the scene
  SurfaceLanes(const scene::Scene& scene, const LaneScene& lanes, const PropagationLimits& limits,
               RunLanes kernel);

  /// Whether a photon in a region of LaneKind::surfaces can be entered: in scenes of one wavelength all have
  /// that one.
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
