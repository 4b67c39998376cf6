#pragma once
/// The scene as photons see it: regions, interfaces, and what binds to them. Immutable once built.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scintray/detector/sensor.hpp"
#include "scintray/medium/medium.hpp"
#include "scintray/scene/accelerator.hpp"
#include "scintray/surface/surface.hpp"

namespace scintray {

inline constexpr std::uint32_t kAmbientRegion = 0;
inline constexpr std::int32_t kNone = -1;

/// A medium with its optics tabulated at even steps of wavelength, for use once per interaction.
class SceneMedium {
 public:
  /// Tabulates [low_nm, high_nm] in steps of at most 0.5 nm.
  SceneMedium(Medium medium, double low_nm, double high_nm);
  /// A medium that absorbs whatever enters it.
  static SceneMedium opaque();

  MediumOptics at(double wavelength_nm) const {
    if (table_.size() == 1) return table_.front();
    const double position = std::clamp((wavelength_nm - low_nm_) * per_nm_, 0.0, last_);
    const auto i = std::min(static_cast<std::size_t>(position), table_.size() - 2);
    const double t = position - static_cast<double>(i);
    const MediumOptics &a = table_[i], &b = table_[i + 1];
    return {a.index + t * (b.index - a.index), a.group_index + t * (b.group_index - a.group_index),
            a.absorption_per_mm + t * (b.absorption_per_mm - a.absorption_per_mm),
            a.scattering_per_mm + t * (b.scattering_per_mm - a.scattering_per_mm)};
  }
  double index(double wavelength_nm) const {
    return table_.size() == 1 ? table_.front().index : at(wavelength_nm).index;
  }
  const Medium& medium() const { return medium_; }
  bool is_opaque() const { return opaque_; }

 private:
  SceneMedium() = default;
  Medium medium_;
  std::vector<MediumOptics> table_;
  double low_nm_ = 0.0, per_nm_ = 0.0, last_ = 0.0;
  bool opaque_ = false;
};

/// What separates two regions over some of their boundary. Its normal points from `back` to `front`.
///
/// Light meets `back_surface` (whose inside is the back region), then, in a dry contact, a gap of no
/// thickness, then `front_surface` (whose inside is the front region). A bonded contact or a free
/// face has exactly one of the two surfaces.
struct Interface {
  std::uint32_t back = 0, front = 0;  ///< regions
  std::int32_t back_surface = kNone, front_surface = kNone;
  std::int32_t gap_medium = kNone;                         ///< dry contact: the medium in the gap
  std::int32_t back_sensor = kNone, front_sensor = kNone;  ///< sensor that light entering that region meets
  std::uint32_t back_sensor_part = 0, front_sensor_part = 0;
  std::int32_t back_face = kNone, front_face = kNone;  ///< faces of the two parts, scene-wide
  bool plain = false;                                  ///< one smooth surface and nothing else
};

inline constexpr std::uint32_t kNotSmooth = 0xffffffffu;

/// Which interface a boundary triangle belongs to, and from which side this region meets it.
struct BoundaryLink {
  std::uint32_t interface = 0;
  std::uint32_t smooth_to = kNotSmooth;  ///< medium behind a plain interface; kNotSmooth: it is not plain
  bool from_back = true;
};

/// Connected space of one medium: a part less what is nested in it, or the ambient space.
struct Region {
  std::string name;
  std::uint32_t medium = 0;
  std::int32_t part = kNone;
  std::shared_ptr<const Accelerator> accelerator;
  Vec3 centre = Vec3::Zero();                              ///< origin of the region's frame, mm
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< world = centre + rotation * local
  bool rotated = false;
  std::vector<BoundaryLink> links;  ///< per triangle of the accelerator

  Vec3 point_to_local(const Vec3& p) const {
    const Vec3 shifted = p - centre;
    return rotated ? Vec3(rotation.transpose() * shifted) : shifted;
  }
  /// Where a ray inside it leaves it.
  Exit find_exit(const Vec3& p, const Vec3& d) const {
    return accelerator->find_exit(point_to_local(p), direction_to_local(d));
  }
  Vec3 direction_to_local(const Vec3& d) const { return rotated ? Vec3(rotation.transpose() * d) : d; }
  Vec3 direction_to_world(const Vec3& d) const { return rotated ? Vec3(rotation * d) : d; }
};

struct PartInfo {
  std::string name;
  std::uint32_t region = 0;
  std::int32_t sensor = kNone;
  double volume_mm3 = 0.0;
  Eigen::AlignedBox3d bounds;
};

/// A tagged face of a part.
struct FaceInfo {
  std::string name;  ///< "part:face"
  std::uint32_t part = 0;
  std::string surface;
  double area_mm2 = 0.0;          ///< as drawn
  double contact_area_mm2 = 0.0;  ///< of it, in contact with another part
  std::size_t triangles = 0;
  Vec3 area_vector_mm2 = Vec3::Zero();  ///< sum of outward normal times area: as long as the area when flat
  std::vector<Vec3> corners;            ///< of its triangles, each once
};

struct Scene {
  std::vector<SceneMedium> media;
  std::vector<Surface> surfaces;
  std::vector<Sensor> sensors;
  std::vector<PartInfo> parts;
  std::vector<FaceInfo> faces;
  std::vector<Interface> interfaces;
  std::vector<double> interface_area_mm2;
  std::vector<Region> regions;         ///< regions[kAmbientRegion] surrounds everything
  std::size_t accelerators = 0;        ///< distinct ones; regions of one shape share
  double low_nm = 0.0, high_nm = 0.0;  ///< wavelengths in use

  /// The region that contains a point (world, mm).
  std::uint32_t locate(const Vec3& point) const;
  bool region_contains(std::uint32_t region, const Vec3& point) const;
  /// True when all of a box (world, mm) lies inside. A box that reaches beyond by rounding counts as inside;
  /// one that a slanted boundary comes near may count as not inside.
  bool region_contains(std::uint32_t region, const Eigen::AlignedBox3d& box) const;
};

}  // namespace scintray
