#include "scintray/mesh/support_surface.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::mesh {

namespace {

constexpr std::size_t kPoints = 12;

/// Nodes and weights of Gauss-Legendre quadrature on [0, 1], by Newton's method on the Legendre polynomial
/// (Press et al., Numerical Recipes, section 4.6).
struct GaussRule {
  std::array<double, kPoints> node{}, weight{};

  GaussRule() {
    constexpr auto n = static_cast<double>(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      double x = std::cos(core::kPi * (static_cast<double>(i) + 0.75) / (n + 0.5)), derivative = 1.0;
      for (int step = 0; step < 8; ++step) {
        double p = 1.0, before = 0.0;
        for (std::size_t k = 0; k < kPoints; ++k) {
          const auto j = static_cast<double>(k);
          const double next = ((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0);
          before = p;
          p = next;
        }
        derivative = n * (x * p - before) / (x * x - 1.0);
        x -= p / derivative;
      }
      node[i] = 0.5 * (1.0 - x);
      weight[i] = 1.0 / ((1.0 - x * x) * derivative * derivative);
    }
  }
};

/// Radius (mm) of the circle at z, and the length of the wall there per length along z.
struct WallAt {
  double radius, length;
};
WallAt wall_at(const SupportSurface& s, double z) {
  const double radius = std::sqrt(std::max(0.0, s.radius2 + (2.0 * s.slope - s.axial * z) * z));
  const double rise = radius > 0.0 ? (s.slope - s.axial * z) / radius : std::sqrt(-s.axial);
  return {radius, std::sqrt(1.0 + rise * rise)};
}

}  // namespace

SupportSurface SupportSurface::sphere(const core::Vec3& centre, double radius) {
  return {centre, core::Vec3(0.0, 0.0, 1.0), 1.0, 0.0, radius * radius};
}

SupportSurface SupportSurface::cylinder(const core::Vec3& origin, const core::Vec3& axis, double radius) {
  return {origin, axis.normalized(), 0.0, 0.0, radius * radius};
}

SupportSurface SupportSurface::cone(const core::Vec3& origin, const core::Vec3& axis, double radius,
                                    double end_radius, double length) {
  const double slope = (end_radius - radius) / length;
  return {origin, axis.normalized(), -slope * slope, radius * slope, radius * radius};
}

SupportSurface SupportSurface::spheroid(const core::Vec3& centre, const core::Vec3& axis, double across,
                                        double along) {
  const double ratio = across / along;
  return {centre, axis.normalized(), ratio * ratio, 0.0, across * across};
}

SupportSurface SupportSurface::torus(const core::Vec3& centre, const core::Vec3& axis, double major,
                                     double minor) {
  return {centre, axis.normalized(), 0.0, 0.0, minor * minor, major};
}

SurfaceKind SupportSurface::kind() const {
  if (is_torus()) return SurfaceKind::torus;
  if (is_sphere()) return SurfaceKind::sphere;
  if (axial > 0.0) return SurfaceKind::spheroid;
  if (axial == 0.0) return slope == 0.0 ? SurfaceKind::cylinder : SurfaceKind::paraboloid;
  constexpr double kRounding = 1e-9;
  const double slope2 = slope * slope;
  return std::abs(axial * radius2 + slope2) <= kRounding * slope2 ? SurfaceKind::cone
                                                                  : SurfaceKind::hyperboloid;
}

const char* SupportSurface::name() const {
  constexpr const char* kNames[] = {"sphere", "spheroid",    "cylinder", "paraboloid",
                                    "cone",   "hyperboloid", "torus"};
  return kNames[static_cast<std::size_t>(kind())];
}

bool SupportSurface::is_on_sheet(const core::Vec3& point) const {
  if (axial >= 0.0) return true;
  constexpr double kRounding = 1e-9;
  if (slope * slope < -axial * radius2 * (1.0 - kRounding)) return true;  // a hyperboloid of one sheet
  const double between = slope / axial;
  return (axis.dot(point - origin) - between) * between <= 0.0;
}

double SupportSurface::most_change(const core::Vec3& point, double within_mm) const {
  const Place at = place(point);
  const double rho = at.rho.norm();
  // The distance from the circle, and those along and from the axis, change by as much as the point moves.
  if (is_torus()) return (2.0 * std::hypot(rho - major, at.z) + within_mm) * within_mm;
  return (2.0 * rho + within_mm + std::abs(axial) * (2.0 * std::abs(at.z) + within_mm) +
          2.0 * std::abs(slope)) *
         within_mm;
}

Foot SupportSurface::nearest(const core::Vec3& point) const {
  const auto vectors = [](const FootOf<double>& at) {
    return Foot{core::vec(at.step), core::vec(at.normal)};
  };
  if (is_cylinder()) [[likely]]
    return vectors(numbers<QuadricShape::cylinder>().nearest(core::triple(point)));
  if (!is_torus()) return vectors(numbers().nearest(core::triple(point)));
  const core::Vec3 outwards = gradient(point);
  const double length = outwards.norm();
  if (!(length > 0.0)) return {core::Vec3::Zero(), axis.vec()};
  const core::Vec3 normal = outwards / length;
  return {(-0.5 * value(point) / length) * normal, normal};
}

double SupportSurface::distance(const core::Vec3& point) const {
  const Place at = place(point);
  const double radius = std::sqrt(radius2);
  switch (kind()) {
    case SurfaceKind::sphere:
      return (point - origin).norm() - radius;
    case SurfaceKind::cylinder:
      return at.rho.norm() - radius;
    case SurfaceKind::cone:
      return (at.rho.norm() - radius - slope / radius * at.z) / std::sqrt(1.0 - axial);
    case SurfaceKind::torus:
      return std::hypot(at.rho.norm() - major, at.z) - radius;
    default:
      break;
  }
  const double q = value(point), slope_of_q = 2.0 * gradient(point).norm();
  return slope_of_q > 0.0 ? q / slope_of_q : -std::sqrt(std::abs(q));
}

std::optional<SupportSurface> SupportSurface::moved(const Eigen::Affine3d& motion) const {
  const Eigen::Matrix3d linear = motion.linear();
  const double scale = std::cbrt(std::abs(linear.determinant()));
  constexpr double kRounding = 1e-12;
  if (!(scale > 0.0) ||
      !(linear.transpose() * linear).isApprox(scale * scale * Eigen::Matrix3d::Identity(), kRounding))
    return std::nullopt;
  SupportSurface result = *this;
  result.origin = motion * origin.vec();
  result.axis = core::Vec3(linear * axis.vec()).normalized();
  result.slope *= scale;
  result.radius2 *= scale * scale;
  result.major *= scale;
  return result;
}

bool SupportSurface::is_same(const SupportSurface& other) const {
  constexpr double kRounding = 1e-10;
  const double size = std::max(std::sqrt(std::max(radius2, other.radius2)), major);
  const auto near = [](double a, double b, double scale) { return std::abs(a - b) <= kRounding * scale; };
  return near(radius2, other.radius2, size * size) && near(axial, other.axial, 1.0) &&
         near(slope, other.slope, size) && near(major, other.major, size) &&
         (axis.vec() - other.axis.vec()).norm() <= kRounding &&
         (origin.vec() - other.origin.vec()).norm() <= kRounding * (size + origin.norm());
}

bool SupportSurface::agrees_with(const SupportSurface& other, const std::array<core::Vec3, 3>& points,
                                 double tolerance_mm) const {
  if (is_sphere() != other.is_sphere() || is_torus() != other.is_torus()) return false;
  const double radius = std::sqrt(radius2);
  return std::all_of(points.begin(), points.end(), [&](const core::Vec3& corner) {
    core::Vec3 point = corner;  // of a facet's side where a contact cut it, off the surface
    for (int step = 0; step < 3; ++step) point += correction(point);
    // Over an angle in which two surfaces of different axis or radius are apart by more than the tolerance.
    return std::abs(other.distance(point)) <= tolerance_mm &&
           (normal(point) - other.normal(point)).norm() * std::max(radius, 1e-300) <= 2.0 * tolerance_mm;
  });
}

namespace {

/// Where the inside of a triangle, or of a side, intersects the axis of a quadric of revolution.
std::optional<core::Vec3> crossing_of_axis(const SupportSurface& surface,
                                           const std::array<core::Vec3, 3>& triangle) {
  const core::Vec3 axis = surface.axis.vec();
  const core::Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double along = normal.dot(axis);
  if (!(std::abs(along) > 1e-6 * normal.norm())) return std::nullopt;
  const core::Vec3 crossing =
      surface.origin.vec() + normal.dot(triangle[0] - surface.origin.vec()) / along * axis;
  constexpr double kAtCorner = 1e-9, kInside = -1e-12;
  for (std::size_t k = 0; k < 3; ++k) {
    const core::Vec3 side = triangle[(k + 1) % 3] - triangle[k];
    const double share = side.cross(crossing - triangle[k]).dot(normal) / normal.squaredNorm();
    if (share < kInside || (crossing - triangle[k]).norm() <= kAtCorner * side.norm()) return std::nullopt;
  }
  return crossing;
}

/// Area and volume of a quadric of revolution from the height of a point of its axis to the pole that is
/// nearest to it.
PatchExcess cap_beyond(const SupportSurface& s, const core::Vec3& on_axis) {
  static const GaussRule rule;
  const double from = s.axis.vec().dot(on_axis - s.origin.vec());
  double pole = -s.radius2 / (2.0 * s.slope);
  if (s.axial != 0.0) {
    const double middle = s.slope / s.axial, root = std::sqrt(middle * middle + s.radius2 / s.axial);
    pole = from > middle ? middle + root : middle - root;
  }
  PatchExcess cap;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double z = from + rule.node[i] * (pole - from), weight = rule.weight[i] * std::abs(pole - from);
    const double rho2 = s.radius2 + 2.0 * s.slope * z - s.axial * z * z, slope = s.slope - s.axial * z;
    cap.area_mm2 += weight * core::kTwoPi * std::sqrt(rho2 + slope * slope);
    cap.volume_mm3 += weight * core::kPi * rho2;
  }
  return cap;
}

}  // namespace

PatchExcess patch_excess(const SupportSurface& surface, const std::array<core::Vec3, 3>& triangle) {
  const SurfaceKind kind = surface.kind();
  if (kind == SurfaceKind::spheroid || kind == SurfaceKind::paraboloid)
    if (const std::optional<core::Vec3> crossing = crossing_of_axis(surface, triangle)) {
      // Around the axis the projection at constant z leaves out the cap beyond the crossing.
      const PatchExcess cap = cap_beyond(surface, *crossing);
      const core::Vec3 axis = surface.axis.vec();
      const bool outwards =
          (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).dot(surface.gradient(triangle[0])) >
          0.0;
      PatchExcess sum;
      for (std::size_t k = 0; k < 3; ++k) {
        const core::Vec3 &a = triangle[k], &b = triangle[(k + 1) % 3];
        const core::Vec3 to_a = (a - *crossing).cross(axis), to_b = (b - *crossing).cross(axis);
        if (!((a - *crossing).cross(b - *crossing).norm() > 1e-12 * (b - a).squaredNorm())) continue;
        const double turn = std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b)) / core::kTwoPi;
        const PatchExcess part = patch_excess(surface, {*crossing, a, b});
        sum.area_mm2 += part.area_mm2 + turn * cap.area_mm2;
        sum.volume_mm3 += part.volume_mm3 + (outwards ? turn : -turn) * cap.volume_mm3;
      }
      return sum;
    }
  static const GaussRule rule;
  // From the corner that is nearest to the axis: at the tip of a cone the integrand depends on the direction.
  const auto from_axis = [&](const core::Vec3& corner) { return (corner - surface.middle(corner)).norm(); };
  std::size_t first = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (from_axis(triangle[k]) < from_axis(triangle[first])) first = k;
  const core::Vec3& corner = triangle[first];
  const core::Vec3 u = triangle[(first + 1) % 3] - corner, v = triangle[(first + 2) % 3] - corner;
  const core::Vec3 doubled = u.cross(v);
  PatchExcess sum;
  for (std::size_t i = 0; i < kPoints; ++i)
    for (std::size_t j = 0; j < kPoints; ++j) {
      // The square onto the triangle (Duffy): s from the first corner, t across.
      const double s = rule.node[i], t = rule.node[j], weight = rule.weight[i] * rule.weight[j] * s;
      const core::Vec3 point = corner + s * ((1.0 - t) * u + t * v) - surface.origin;
      if (surface.is_sphere()) {
        const double rho2 = point.squaredNorm(), rho = std::sqrt(rho2), radius = std::sqrt(surface.radius2);
        const double solid_angle = weight * doubled.dot(point) / (rho2 * rho);
        sum.area_mm2 += std::abs(solid_angle) * surface.radius2;
        sum.volume_mm3 += solid_angle * (radius * surface.radius2 - rho * rho2) / 3.0;
      } else if (surface.is_torus()) {
        // By the angles about the axis and in the tube: d = r (major + r cos) dangle dangle.
        const core::Vec3 in_tube = surface.origin + point - surface.middle(surface.origin + point);
        const double z = surface.axis.dot(point), rho = (point - z * surface.axis.vec()).norm();
        const double far = in_tube.norm(), cosine = (rho - surface.major) / far,
                     radius = std::sqrt(surface.radius2);
        const double angles = weight * doubled.dot(in_tube) / (far * far * rho);
        sum.area_mm2 += std::abs(angles) * radius * (surface.major + radius * cosine);
        sum.volume_mm3 += angles * (surface.major * 0.5 * (surface.radius2 - far * far) +
                                    cosine * (radius * surface.radius2 - far * far * far) / 3.0);
      } else {
        const double z = surface.axis.dot(point);
        const core::Vec3 rho = point - z * surface.axis.vec();
        const WallAt wall = wall_at(surface, z);
        const double turn = weight * doubled.dot(rho) / rho.squaredNorm();  // angle times height
        sum.area_mm2 += std::abs(turn) * wall.radius * wall.length;
        sum.volume_mm3 += turn * 0.5 * (wall.radius * wall.radius - rho.squaredNorm());
      }
    }
  sum.area_mm2 -= 0.5 * doubled.norm();
  return sum;
}

double segment_area(const SupportSurface& surface, const core::Vec3& normal, const core::Vec3& a,
                    const core::Vec3& b) {
  constexpr double kUpright = 1e-9;
  const bool in_tube = surface.is_torus() && std::abs(surface.axis.dot(normal)) <= kUpright &&
                       std::abs(normal.dot(a - surface.origin)) <= kUpright * surface.major;
  if (!in_tube && !surface.is_sphere() && surface.axis.cross(normal).norm() > kUpright) return 0.0;
  const core::Vec3 centre = in_tube ? surface.middle(a) : surface.origin.vec();
  const core::Vec3 to_a = a - centre, to_b = b - centre;
  const core::Vec3 ra = to_a - normal.dot(to_a) * normal, rb = to_b - normal.dot(to_b) * normal;
  const double cross = ra.cross(rb).norm(), dot = ra.dot(rb);
  // Of the circle, on which corners that a contact made in the middle of a facet's side are not.
  const double z = surface.is_sphere() || in_tube ? normal.dot(to_a) : surface.axis.dot(to_a);
  const double circle2 = surface.is_sphere() ? surface.radius2 - z * z
                         : in_tube           ? surface.radius2
                                   : surface.radius2 + (2.0 * surface.slope - surface.axial * z) * z;
  const double area = 0.5 * (std::atan2(cross, dot) * circle2 - cross);
  return normal.cross(b - a).dot(centre - a) > 0.0 ? area : -area;
}

FacetDeviation facet_deviation(const SupportSurface& surface, const std::array<core::Vec3, 3>& triangle) {
  FacetDeviation largest;
  const core::Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
  const auto add = [&](const core::Vec3& point) {
    largest.distance_mm = std::max(largest.distance_mm, std::abs(surface.distance(point)));
  };
  add((triangle[0] + triangle[1] + triangle[2]) / 3.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const core::Vec3& corner = triangle[i];
    add(0.5 * (corner + triangle[(i + 1) % 3]));
    const double cosine = std::abs(normal.dot(surface.normal(corner)));
    const double sine = normal.cross(surface.normal(corner)).norm();
    largest.angle_rad = std::max(largest.angle_rad, std::atan2(sine, cosine));
  }
  return largest;
}

}  // namespace scintray::mesh
