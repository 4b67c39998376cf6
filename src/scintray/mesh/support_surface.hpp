#pragma once
/// Surfaces that the triangles of round faces approximate.

#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "scintray/core/plain_vec.hpp"
#include "scintray/mesh/quadric_laws.hpp"

namespace scintray::mesh {

/// No support surface: the triangle itself is the face.
inline constexpr std::uint32_t kNoSupport = 0xffffffffu;

/// Kinds of support surface.
enum class SurfaceKind { sphere, spheroid, cylinder, paraboloid, cone, hyperboloid, torus };

/// A point next to a surface: displacement (mm) onto the surface, and its unit normal there, outwards.
struct Foot {
  core::Vec3 step, normal;
};

/// A quadric of revolution, of a cone one nappe, or a torus.
///
/// With z along the axis from the origin and rho the distance from the axis, a quadric is
///   q = rho^2 + axial z^2 - 2 slope z - radius2 = 0,
/// and q < 0 inside. The origin of a cone lies on its axis inside the nappe, not at the tip, so that a narrow
/// cone far from its tip does not lose precision. A torus is q = (rho - major)^2 + z^2 - radius2 = 0. Lengths
/// mm.
struct SupportSurface {
  core::PlainVec3 origin, axis;  ///< axis: of unit length
  double axial = 0.0;    ///< above 0: sphere (1), spheroid; 0: cylinder, paraboloid; below 0: cone (minus the
                         ///< squared slope of its wall), hyperboloid
  double slope = 0.0;    ///< mm; half the rate at which the squared radius grows along the axis at the origin
  double radius2 = 0.0;  ///< mm2; squared radius at the origin; of a torus, of its tube
  double major = 0.0;    ///< mm; above 0: a torus, the radius of the circle in the middle of its tube

  static SupportSurface sphere(const core::Vec3& centre, double radius);
  static SupportSurface cylinder(const core::Vec3& origin, const core::Vec3& axis, double radius);
  /// The cone through two circles about the axis: of `radius` (above 0) at the origin, and of `end_radius`
  /// (not negative, and not equal to `radius`) at the distance `length` along the axis.
  static SupportSurface cone(const core::Vec3& origin, const core::Vec3& axis, double radius,
                             double end_radius, double length);

  /// The quadric rho^2 = radius^2 + 2 slope z - axial z^2.
  static SupportSurface quadric(const core::Vec3& origin, const core::Vec3& axis, double axial, double slope,
                                double radius2) {
    return {origin, axis.normalized(), axial, slope, radius2};
  }
  /// The spheroid with the semi-axes `across`, perpendicular to the axis, and `along` it.
  static SupportSurface spheroid(const core::Vec3& centre, const core::Vec3& axis, double across,
                                 double along);
  /// The torus of a tube of `minor` radius about a circle of `major` radius, which is not below it.
  static SupportSurface torus(const core::Vec3& centre, const core::Vec3& axis, double major, double minor);

  SurfaceKind kind() const;
  bool is_sphere() const { return axial == 1.0 && slope == 0.0 && major == 0.0; }
  bool is_torus() const { return major > 0.0; }
  /// Whether its inside is convex.
  bool is_convex() const {
    const SurfaceKind own = kind();
    return own != SurfaceKind::hyperboloid && own != SurfaceKind::torus;
  }
  /// Kind of surface, for messages.
  const char* name() const;

  /// q (mm2) at a point: negative inside, but positive in a cone's other nappe, too.
  double value(const core::Vec3& point) const {
    if (!is_torus()) [[likely]]
      return numbers().value(numbers().place(core::triple(point)));
    const Place at = place(point);
    return (at.rho.norm() - major) * (at.rho.norm() - major) + at.z * at.z - radius2;
  }
  /// Upper bound of the difference of q (mm2) between a point and any other within a distance (mm).
  double most_change(const core::Vec3& point, double within_mm) const;
  /// Half the gradient of q (mm), which points outwards; zero at the tip of a cone.
  core::Vec3 gradient(const core::Vec3& point) const {
    if (!is_torus()) [[likely]]
      return core::vec(numbers().gradient(numbers().place(core::triple(point))));
    return point - circle_point(place(point));
  }
  /// Whether a point of the surface is on the sheet around its origin: not in the other nappe of a cone.
  bool is_on_sheet(const core::Vec3& point) const;
  /// Unit normal at a point of the surface, outwards; at the tip of a cone, along its axis.
  core::Vec3 normal(const core::Vec3& point) const { return nearest(point).normal; }
  /// Distance (mm) of a point from the surface, to first order; negative inside.
  double distance(const core::Vec3& point) const;
  /// Displacement (mm) onto the surface of a point next to it: one step of Newton's method.
  core::Vec3 correction(const core::Vec3& point) const { return nearest(point).step; }
  /// Both, as QuadricOf::nearest; of a torus as well.
  Foot nearest(const core::Vec3& point) const;

  bool is_cylinder() const { return axial == 0.0 && slope == 0.0 && major == 0.0; }
  /// The numbers of a quadric.
  template <QuadricShape kShape = QuadricShape::any>
  QuadricOf<double, kShape> numbers() const {
    return {core::triple(origin), core::triple(axis), axial, slope, radius2};
  }

  /// The centre of a sphere; of a torus the nearest point of the circle in its tube; of other surfaces the
  /// point of the axis at the same z.
  core::Vec3 middle(const core::Vec3& point) const {
    if (is_torus()) return circle_point(place(point));
    return is_sphere() ? origin.vec() : core::Vec3(point - place(point).rho);
  }

  /// The surface after a transformation that preserves angles; nothing after any other.
  std::optional<SupportSurface> moved(const Eigen::Affine3d& motion) const;

  /// Whether the two have the same numbers, to rounding.
  bool is_same(const SupportSurface& other) const;
  /// Whether the two are one surface: within `tolerance_mm` of each other at these points of the first.
  bool agrees_with(const SupportSurface& other, const std::array<core::Vec3, 3>& points,
                   double tolerance_mm) const;

 private:
  struct Place {
    core::Vec3 rho;  ///< from the axis
    double z;
  };
  Place place(const core::Vec3& point) const {
    const core::Vec3 from_origin = point - origin;
    const double z = axis.dot(from_origin);
    return {from_origin - z * axis.vec(), z};
  }
  core::Vec3 circle_point(const Place& at) const {
    const double rho = at.rho.norm();
    return origin + (rho > 0.0 ? core::Vec3(major / rho * at.rho) : core::Vec3(core::Vec3::Zero()));
  }
};
static_assert(std::is_trivially_copyable_v<SupportSurface>);

/// Area and volume of a patch of a surface in excess of the triangle that approximates it.
struct PatchExcess {
  double area_mm2 = 0.0;    ///< of the patch, less that of the triangle
  double volume_mm3 = 0.0;  ///< between the triangle and the patch; negative on the wall of a hole
};

/// Excess of the patch above a triangle whose corners lie on the surface: the triangle is projected from the
/// centre of a sphere, from the circle in a torus, and at constant z from the axis of other surfaces.
/// Gauss-Legendre quadrature, 12 points in each direction: exact to rounding for triangles that span up to 30
/// degrees.
PatchExcess patch_excess(const SupportSurface& surface, const std::array<core::Vec3, 3>& triangle);

/// Area (mm2) between a chord from a to b, or a part of one, and the circle in which the surface intersects
/// the plane through it with the unit normal `normal`, against which the circle's centre is on the left of
/// the chord; negative where it is on the right. Zero where that is no circle: a surface, not a sphere, that
/// is cut obliquely, but for a torus in a plane through its axis.
double segment_area(const SupportSurface& surface, const core::Vec3& normal, const core::Vec3& a,
                    const core::Vec3& b);

/// Deviation of a triangle from the surface that it approximates.
struct FacetDeviation {
  double distance_mm = 0.0;  ///< largest distance, at its middle or the middle of a side
  double angle_rad = 0.0;    ///< largest angle between its normal and the surface's, at its corners
};
FacetDeviation facet_deviation(const SupportSurface& surface, const std::array<core::Vec3, 3>& triangle);

}  // namespace scintray::mesh
