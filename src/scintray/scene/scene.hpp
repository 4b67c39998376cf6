#pragma once
/// The scene for transport: regions, interfaces, surfaces and sensors. Immutable once built.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "scintray/core/id_vector.hpp"
#include "scintray/core/ids.hpp"
#include "scintray/core/plain_vec.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/surface.hpp"
#include "scintray/scene/accelerator.hpp"

namespace scintray::scene {

/// The ambient region, which belongs to no part and surrounds all parts.
inline constexpr core::RegionId kAmbientRegion(0);

/// A medium of the scene, by its definition.
class SceneMedium {
 public:
  explicit SceneMedium(optics::Medium medium) : medium_(std::move(medium)) {}
  /// A medium that absorbs all light that enters it, which it does with matched indices.
  static SceneMedium opaque(std::string name = "opaque");

  const optics::Medium& medium() const { return medium_; }
  bool is_opaque() const { return opaque_; }

 private:
  optics::Medium medium_;
  bool opaque_ = false;
};

/// Record of a medium for transport: its range of SceneOptics::table, and its kind of scattering.
struct MediumRecord {
  std::uint32_t first = 0, count = 1;  ///< entries of the table; 1: the same at every wavelength
  double low_nm = 0.0, per_nm = 0.0;   ///< wavelength of the first, and entries per nm
  double last = 0.0;                   ///< position of the last entry, count - 1
  optics::ScatteringKind scattering = optics::ScatteringKind::rayleigh;
  bool opaque = false;
  bool shifts = false;     ///< has a wavelength shifter
  bool particles = false;  ///< has particles that scatter
  bool birefringent = false;
  std::uint32_t first_shift =
      0;  ///< with a shifter: first entry of SceneOptics::shifting_per_mm, `count` in all
  std::uint32_t first_birefringent =
      0;  ///< of a birefringent medium: first entry of SceneOptics::birefringent, `count` in all

  /// Of the wavelengths of the table, which are those in use.
  double middle_nm() const { return per_nm > 0.0 ? low_nm + 0.5 * last / per_nm : low_nm; }
};
static_assert(std::is_trivially_copyable_v<MediumRecord> && sizeof(MediumRecord) == 48);
static_assert(std::is_trivially_copyable_v<optics::MediumOptics>);

/// Optical properties of all media, tabulated at equal steps of wavelength, for use once per interaction.
///
/// Between two entries every property is linear. All that transport computes of a medium comes from here, so
/// that its parts and their sum agree to the last bit: curves evaluated beside it would differ from it near
/// their own points.
struct SceneOptics {
  core::IdVector<core::MediumId, MediumRecord> media;  ///< as Scene::media
  std::vector<optics::MediumOptics> table;
  std::vector<double> shifting_per_mm;  ///< absorption by the wavelength shifters alone, of media with one
  std::vector<optics::BirefringentOptics> birefringent;  ///< at the wavelengths of `table`, of such media

  /// Adds a medium, tabulated over [low_nm, high_nm] in steps of at most 0.5 nm.
  void add(const SceneMedium& medium, double low_nm, double high_nm);

  /// Optical properties of a medium at a wavelength (nm); constant beyond the table's ends.
  optics::MediumOptics at(core::MediumId medium, double wavelength_nm) const {
    const MediumRecord& record = media[medium];
    const optics::MediumOptics* entries = &table[record.first];
    if (record.count == 1) return *entries;
    const auto [i, t] = place(record, wavelength_nm);
    const optics::MediumOptics &a = entries[i], &b = entries[i + 1];
    return {a.index + t * (b.index - a.index), a.group_index + t * (b.group_index - a.group_index),
            a.absorption_per_mm + t * (b.absorption_per_mm - a.absorption_per_mm),
            a.scattering_per_mm + t * (b.scattering_per_mm - a.scattering_per_mm)};
  }
  double index(core::MediumId medium, double wavelength_nm) const {
    const MediumRecord& record = media[medium];
    return record.count == 1 ? table[record.first].index : at(medium, wavelength_nm).index;
  }
  bool is_opaque(core::MediumId medium) const { return media[medium].opaque; }
  /// A birefringent medium at the wavelength (nm) of its table that is nearest; null for a medium of one
  /// index. `at` has the means of its axes.
  const optics::BirefringentOptics* birefringent_at(core::MediumId medium, double wavelength_nm) const {
    const MediumRecord& record = media[medium];
    if (!record.birefringent) [[likely]]
      return nullptr;
    std::size_t entry = 0;
    if (record.count > 1) {
      const auto [below, share] = place(record, wavelength_nm);
      entry = below + (share < 0.5 ? 0 : 1);
    }
    return &birefringent[record.first_birefringent + entry];
  }
  /// Absorption by the wavelength shifter of a medium that has one, 1/mm: a part of `at`'s absorption, and
  /// where nothing else absorbs equal to it in every bit.
  double shifting_at(core::MediumId medium, double wavelength_nm) const {
    const MediumRecord& record = media[medium];
    const double* entries = &shifting_per_mm[record.first_shift];
    if (record.count == 1) return *entries;
    const auto [i, t] = place(record, wavelength_nm);
    return entries[i] + t * (entries[i + 1] - entries[i]);
  }

 private:
  /// Entry below a wavelength, and the relative position from there to the next.
  struct Place {
    std::size_t entry = 0;
    double share = 0.0;
  };
  static Place place(const MediumRecord& record, double wavelength_nm) {
    const double position = std::clamp((wavelength_nm - record.low_nm) * record.per_nm, 0.0, record.last);
    const auto entry = std::min(static_cast<std::size_t>(position), std::size_t{record.count} - 2);
    return {entry, position - static_cast<double>(entry)};
  }
};

/// The interface of two regions over a part of their boundary. Its normal points from `back` to `front`.
///
/// From back to front, light interacts with `back_surface` (whose inside is the back region), then, in a dry
/// contact, crosses a gap of no thickness, then interacts with `front_surface` (whose inside is the front
/// region). A bonded contact or a free face has exactly one of the two surfaces, for light of both
/// directions; where it has two and no gap medium, each is for light that leaves the region on its inside.
struct Interface {
  core::RegionId back, front;
  core::SurfaceId back_surface, front_surface;
  core::MediumId gap_medium;                 ///< dry contact: the medium in the gap
  core::SensorId back_sensor, front_sensor;  ///< sensor reached by light that enters that region
  core::PartId back_sensor_part, front_sensor_part;
  core::FaceId back_face, front_face;  ///< of the two parts
  bool plain = false;                  ///< a single smooth surface between media of one index
};
static_assert(std::is_trivially_copyable_v<Interface> && sizeof(Interface) == 48);

/// The interface of a boundary triangle, and the side of this region on it.
struct BoundaryLink {
  core::InterfaceId interface;
  core::MediumId smooth_to;  ///< medium behind a plain interface between media of one index; none: another,
                             ///< or phases are kept
  bool from_back = true;
};
static_assert(std::is_trivially_copyable_v<BoundaryLink> && sizeof(BoundaryLink) == 12);

/// What decides on total reflection at a boundary where it depends on the angle of incidence alone
/// (total_reflection.hpp).
struct TotalReflection {
  enum class By : std::uint8_t {
    nothing,         ///< there is none, or the surface is not smooth
    critical_angle,  ///< of a plain interface
    fresnel,         ///< Fresnel's equations at a smooth surface with more behind it
  };
  By by = By::nothing;
  core::MediumId behind;   ///< medium behind the surface
  core::SurfaceId gap_of;  ///< or its gap is
  bool operator==(const TotalReflection&) const = default;
};
static_assert(std::is_trivially_copyable_v<TotalReflection>);

/// How photons in a region are traced in the lanes of vector registers, where that is faster.
enum class LaneKind : std::uint8_t {
  none,      ///< they are traced one by one
  smooth,    ///< they are propagated in lanes, through total reflections (transport's lane_kernel.hpp)
  surfaces,  ///< they stay in lanes at surfaces, and from region to region (lane_pool.hpp)
};

/// Connected space of one medium: a part less the parts nested in it, or the ambient space.
struct Region {
  core::MediumId medium;
  core::PartId part;  ///< none: the ambient space
  core::AcceleratorId accelerator;
  std::uint32_t first_link = 0;     ///< of its triangles', in SceneRecords::links
  bool rotated = false;             ///< `rotation` is not the identity
  LaneKind lanes = LaneKind::none;  ///< at a width that has kernels of its kind
  /// Its boundary is a box of which most reflects totally: total reflections in it are passed many at once
  /// (transport's box_reflections.hpp), in lanes and without.
  bool unfolds = false;
  bool curved = false;     ///< its accelerator has exact bodies
  bool thin_gaps = false;  ///< it has some: photons in it keep the triangle of the flat face that they are on
  core::PlainVec3 centre = core::Vec3(core::Vec3::Zero());       ///< origin of the region's frame, mm
  core::PlainMatrix3 rotation = core::PlainMatrix3::identity();  ///< world = centre + rotation * local

  core::Vec3 point_to_local(const core::PlainVec3& p) const {
    if (!rotated) [[likely]]
      return p - centre;
    return rotation.matrix().transpose() * (p - centre);
  }
  core::Vec3 direction_to_local(const core::PlainVec3& d) const {
    if (!rotated) [[likely]]
      return d.vec();
    return rotation.matrix().transpose() * d.vec();
  }
  core::Vec3 direction_to_world(const core::PlainVec3& d) const {
    if (!rotated) [[likely]]
      return d.vec();
    return rotation.matrix() * d.vec();
  }
};
static_assert(std::is_trivially_copyable_v<Region> && sizeof(Region) == 120);

/// Records of a scene for transport, as plain data in arrays with indices between them, without names or
/// pointers. Together with the boundaries of the accelerators they can be copied to another process or device
/// unchanged.
struct SceneRecords {
  core::IdVector<core::RegionId, Region> regions;
  std::vector<BoundaryLink> links;  ///< one per triangle of a region's boundary, region after region
  std::vector<std::uint32_t>
      twins;  ///< likewise: the triangle in the boundary of the region on its other side
  core::IdVector<core::InterfaceId, Interface> interfaces;
  /// For light that leaves the front and the back region of each interface; empty where no region unfolds.
  std::vector<TotalReflection> total_reflections;
  SceneOptics optics;

  /// Links of the triangles of a region's boundary, in their order.
  const BoundaryLink* links_of(const Region& region) const { return links.data() + region.first_link; }
  const BoundaryLink& link(const Region& region, std::uint32_t triangle) const {
    return links_of(region)[triangle];
  }
  /// Region behind a boundary.
  core::RegionId behind(const BoundaryLink& link) const {
    const Interface& interface = interfaces[link.interface];
    return link.from_back ? interface.front : interface.back;
  }
  const TotalReflection& total_reflection(const BoundaryLink& link) const {
    return total_reflections[2 * link.interface.index() + (link.from_back ? 1 : 0)];
  }
  std::uint32_t twin(const Region& region, std::uint32_t triangle) const {
    return twins[region.first_link + triangle];
  }
};

struct PartInfo {
  std::string name;
  core::RegionId region;
  core::SensorId sensor;  ///< none: not a sensor
  double volume_mm3 = 0.0;
  Eigen::AlignedBox3d bounds;  ///< around the exact body
  bool curved = false;         ///< its round faces are exact
  std::string facets_because;  ///< reason why known round faces stay facets; empty: none do
};

/// A tagged face of a part.
struct FaceInfo {
  std::string name;  ///< "part:face"
  core::PartId part;
  std::string surface;
  double area_mm2 = 0.0;          ///< as defined, contacts included
  double contact_area_mm2 = 0.0;  ///< of this, in contact with another part
  std::size_t triangles = 0;
  core::Vec3 area_vector_mm2 =
      core::Vec3::Zero();           ///< sum of outward normal times area: as long as the area when flat
  std::vector<core::Vec3> corners;  ///< of its triangles, each once
  std::string curve;                ///< kind of the surface that it approximates; empty: none is known
  bool exact = false;               ///< that surface replaces its triangles in ray tracing
  mesh::FacetDeviation deviation;   ///< largest of its triangles from that surface
};

/// Middle and axes of a sensor's face over which its efficiency varies.
struct SensorFaceFrame {
  core::Vec3 middle_mm = core::Vec3::Zero();                    ///< of the face's box along the axes, world
  core::Vec3 x = core::Vec3::UnitX(), y = core::Vec3::UnitY();  ///< of unit length, world
  double mean_factor = 1.0;                                     ///< over the area

  /// Factor on the efficiency at a point of the face (world, mm).
  double factor(const detector::FaceResponse& response, const core::Vec3& point) const {
    const core::Vec3 from_middle = point - middle_mm;
    return response.at(from_middle.dot(x), from_middle.dot(y));
  }
};

/// A scene: its records for transport, and the objects to which these refer by index.
struct Scene : SceneRecords {
  core::IdVector<core::MediumId, SceneMedium> media;
  core::IdVector<core::SurfaceId, optics::Surface> surfaces;
  core::IdVector<core::SensorId, detector::Sensor> sensors;
  /// Distinct accelerators; regions of one shape share one. A copy of a scene shares them.
  core::IdVector<core::AcceleratorId, std::shared_ptr<const Accelerator>> accelerators;

  core::IdVector<core::RegionId, std::string> region_names;
  core::IdVector<core::PartId, PartInfo> parts;
  core::IdVector<core::FaceId, FaceInfo> faces;
  core::IdVector<core::InterfaceId, double> interface_area_mm2;
  /// Per face; empty where no sensor's efficiency depends on the place.
  core::IdVector<core::FaceId, SensorFaceFrame> sensor_frames;
  double low_nm = 0.0, high_nm = 0.0;  ///< wavelengths in use
  /// Photons keep the phase between the two polarisations. No link then has a smooth_to: total reflection,
  /// which shifts that phase, is an interaction like any other.
  bool keeps_phases = false;

  const Accelerator& accelerator(const Region& region) const { return *accelerators[region.accelerator]; }
  /// The point at which a ray inside a region leaves it.
  /// @param p  world, mm; @param d  of unit length
  Exit find_exit(const Region& region, const core::PlainVec3& p, const core::PlainVec3& d) const {
    return accelerator(region).find_exit(region.point_to_local(p), region.direction_to_local(d));
  }
  /// Normal of a triangle of a region's boundary (world), out of the region.
  core::Vec3 normal(const Region& region, std::uint32_t triangle) const {
    return region.direction_to_world(accelerator(region).normal(triangle));
  }
  /// As normal(), of the exact face at a point next to the triangle (world, mm).
  core::Vec3 normal_at(const Region& region, std::uint32_t triangle, const core::PlainVec3& point) const {
    if (!region.curved) [[likely]]
      return normal(region, triangle);
    return region.direction_to_world(accelerator(region).normal_at(triangle, region.point_to_local(point)));
  }
  /// The face of a part on one of its interfaces: one of the two faces there.
  core::FaceId sensor_face(const Interface& interface, core::PartId part) const {
    const bool at_front = interface.front_face.has_value() && faces[interface.front_face].part == part;
    return at_front ? interface.front_face : interface.back_face;
  }
  /// Frame of the face, on an interface, of a sensor with a face response. @param part  of the sensor
  const SensorFaceFrame& sensor_frame(const Interface& interface, core::PartId part) const {
    return sensor_frames[sensor_face(interface, part)];
  }
  /// True when light that enters a region through an interface reaches the sensor there, rather than passing
  /// it.
  bool reaches_sensor(const Interface& interface, bool from_back) const {
    const core::SensorId id = from_back ? interface.front_sensor : interface.back_sensor;
    if (!id.has_value()) return false;
    const detector::Sensor& sensor = sensors[id];
    if (sensor.converts == detector::ConvertedLight::entering) [[likely]]
      return true;
    const core::PartId part = from_back ? interface.front_sensor_part : interface.back_sensor_part;
    return sensor.converts_entering() && regions[from_back ? interface.front : interface.back].part == part;
  }
  /// A triangle of a region's boundary (world, mm).
  BoundaryTriangle triangle(const Region& region, std::uint32_t number) const;

  /// The region that contains a point (world, mm).
  core::RegionId locate(const core::Vec3& point) const;
  bool region_contains(core::RegionId region, const core::Vec3& point) const;
  /// True when a whole box (world, mm) lies inside the region. A box that extends beyond it by rounding
  /// counts as inside; one near an oblique boundary may count as not inside.
  bool region_contains(core::RegionId region, const Eigen::AlignedBox3d& box) const;
};

}  // namespace scintray::scene
