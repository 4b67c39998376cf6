#include "scintray/mesh/detail/surface_fits.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/linear_solutions.hpp"

namespace scintray::mesh {

namespace {

/// Steps of the Gauss-Newton method, which converges within a few where the surface fits.
constexpr int kWallSteps = 12;

/// Cylinder or cone by its axis, and the radius along it: radius + slope z.
struct FittedWall {
  core::Vec3 origin, axis;
  double radius, slope;
};

/// Axis to which all facets have one angle (cone) or a right angle (cylinder).
core::Vec3 axis_of_wall(const FacetPatch& patch, bool cone) {
  core::Vec3 mean = core::Vec3::Zero();
  double area = 0.0;
  for (const std::uint32_t t : patch.triangles) {
    mean += patch.areas[t] * patch.normals[t];
    area += patch.areas[t];
  }
  mean = cone ? core::Vec3(mean / area) : core::Vec3::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::uint32_t t : patch.triangles) {
    const core::Vec3 d = patch.normals[t] - mean;
    covariance += patch.areas[t] * d * d.transpose();
  }
  return core::principal_axes(covariance).directions.col(0);
}

std::optional<SupportSurface> surface_of_wall(const FittedWall& wall, const std::vector<core::Vec3>& points,
                                              double within_mm, double tolerance_mm) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const core::Vec3& p : points) {
    const double z = wall.axis.dot(p - wall.origin);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  SupportSurface result = SupportSurface::cylinder(wall.origin, wall.axis, wall.radius);
  if (wall.slope != 0.0) {
    // From the wider end, where the radius is above zero.
    const double at = wall.slope > 0.0 ? high : low, to = wall.slope > 0.0 ? low : high;
    const double radius = wall.radius + wall.slope * at;
    const double end = std::max(0.0, wall.radius + wall.slope * to);
    if (!(radius > 0.0) || end == radius) return std::nullopt;
    const double length = (end - radius) / wall.slope;
    result = SupportSurface::cone(wall.origin + at * wall.axis, wall.axis, radius, end, length);
  }
  return is_surface_of(result, points, within_mm, tolerance_mm) ? std::optional(result) : std::nullopt;
}

/// |p|^2 = 2 p . c + a + b z + g z^2 across the axis is linear, with radius^2 = a + |c|^2 and
/// b = 2 radius slope.
std::optional<FittedWall> first_wall(const std::vector<core::Vec3>& points, const core::Vec3& mean,
                                     const core::Vec3& axis, bool cone) {
  const core::Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
  Eigen::MatrixXd left(static_cast<Eigen::Index>(points.size()), cone ? 5 : 3);
  Eigen::VectorXd right(left.rows());
  for (Eigen::Index i = 0; i < left.rows(); ++i) {
    const core::Vec3 p = points[static_cast<std::size_t>(i)] - mean;
    const double px = x.dot(p), py = y.dot(p), z = axis.dot(p);
    left(i, 0) = 2.0 * px;
    left(i, 1) = 2.0 * py;
    left(i, 2) = 1.0;
    if (cone) {
      left(i, 3) = z;
      left(i, 4) = z * z;
    }
    right[i] = px * px + py * py;
  }
  // Of two rings z and z^2 are not independent: the least solution does as a start.
  const Eigen::VectorXd s = core::least_solution(left, right).x;
  const double radius2 = s[2] + s[0] * s[0] + s[1] * s[1];
  if (!(radius2 > 0.0) || !std::isfinite(radius2)) return std::nullopt;
  const double radius = std::sqrt(radius2);
  return FittedWall{mean + s[0] * x + s[1] * y, axis, radius, cone ? s[3] / (2.0 * radius) : 0.0};
}

/// What the Gauss-Newton method may change.
struct FreeOfWall {
  bool slope, axis;
};

/// One step of the Gauss-Newton method on the distances across the axis.
std::optional<FittedWall> improved_wall(const std::vector<core::Vec3>& points, const FittedWall& wall,
                                        FreeOfWall free) {
  const core::Vec3 x = wall.axis.unitOrthogonal(), y = wall.axis.cross(x);
  // Normal equations: of large faces a matrix of all slopes takes more memory than the mesh.
  Eigen::Matrix<double, 6, 1> slope, sums = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
  for (const core::Vec3& point : points) {
    const core::Vec3 p = point - wall.origin;
    const double px = x.dot(p), py = y.dot(p), z = wall.axis.dot(p), rho = std::hypot(px, py);
    // The tip of a cone has no direction across the axis.
    const double cosine = rho > 0.0 ? px / rho : 0.0, sine = rho > 0.0 ? py / rho : 0.0;
    const double off = rho - wall.radius - wall.slope * z;
    // The axis turned by small angles towards x and y takes z from the distance, and adds to z. Of what is
    // not free, no change is the least solution.
    const double turn = free.axis ? 1.0 : 0.0;
    slope << -cosine, -sine, -turn * (z * cosine + wall.slope * px), -turn * (z * sine + wall.slope * py),
        -1.0, free.slope ? -z : 0.0;
    products += slope * slope.transpose();
    sums -= off * slope;
  }
  const Eigen::Matrix<double, 6, 1> change = core::least_solution(products, sums).x;
  if (!change.allFinite()) return std::nullopt;
  FittedWall next = wall;
  next.origin += change[0] * x + change[1] * y;
  next.axis = (wall.axis + change[2] * x + change[3] * y).normalized();
  next.radius += change[4];
  next.slope += change[5];
  return next.radius > 0.0 ? std::optional(next) : std::nullopt;
}

std::optional<SupportSurface> fit_wall_of_kind(const FacetPatch& patch, bool cone, double tolerance_mm) {
  std::optional<FittedWall> wall =
      first_wall(patch.corners, middle_of(patch.corners), axis_of_wall(patch, cone), cone);
  // The axis of facets whose corners are on the surface is exact, and poorly known from few rings of
  // corners: it is turned only where it does not fit.
  for (int step = 0; wall && step < kWallSteps; ++step)
    wall = improved_wall(patch.corners, *wall, {cone, false});
  if (!wall) return std::nullopt;
  if (const std::optional<SupportSurface> exact =
          surface_of_wall(*wall, patch.corners, 0.1 * tolerance_mm, tolerance_mm))
    return exact;
  for (int step = 0; wall && step < kWallSteps; ++step)
    wall = improved_wall(patch.corners, *wall, {cone, true});
  return wall ? surface_of_wall(*wall, patch.corners, tolerance_mm, tolerance_mm) : std::nullopt;
}

}  // namespace

core::Vec3 middle_of(const std::vector<core::Vec3>& points) {
  core::Vec3 sum = core::Vec3::Zero();
  for (const core::Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

bool is_surface_of(const SupportSurface& surface, const std::vector<core::Vec3>& points, double within_mm,
                   double tolerance_mm) {
  for (const core::Vec3& p : points)
    if (!(std::abs(surface.distance(p)) <= within_mm)) return false;
  const core::Vec3 mean = middle_of(points);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const core::Vec3& p : points) covariance += (p - mean) * (p - mean).transpose();
  const core::Vec3 thin = core::principal_axes(covariance).directions.col(0);
  double low = 0.0, high = 0.0;
  for (const core::Vec3& p : points) {
    low = std::min(low, thin.dot(p - mean));
    high = std::max(high, thin.dot(p - mean));
  }
  return high - low >= kLeastBend * tolerance_mm;
}

std::optional<SupportSurface> fit_sphere(const FacetPatch& patch, double tolerance_mm) {
  const core::Vec3 mean = middle_of(patch.corners);
  Eigen::MatrixXd left(static_cast<Eigen::Index>(patch.corners.size()), 4);
  Eigen::VectorXd right(left.rows());
  for (Eigen::Index i = 0; i < left.rows(); ++i) {
    const core::Vec3 p = patch.corners[static_cast<std::size_t>(i)] - mean;
    left.row(i) << 2.0 * p.transpose(), 1.0;
    right[i] = p.squaredNorm();
  }
  const auto [solution, rank] = core::least_solution(left, right);
  if (rank < 4) return std::nullopt;
  const core::Vec3 centre = solution.col(0).head<3>();
  const double radius2 = solution(3) + centre.squaredNorm();
  if (!(radius2 > 0.0)) return std::nullopt;
  const SupportSurface result = SupportSurface::sphere(mean + centre, std::sqrt(radius2));
  return is_surface_of(result, patch.corners, tolerance_mm, tolerance_mm) ? std::optional(result)
                                                                          : std::nullopt;
}

std::optional<SupportSurface> fit_wall(const FacetPatch& patch, double tolerance_mm) {
  const std::optional<SupportSurface> cylinder = fit_wall_of_kind(patch, false, tolerance_mm);
  return cylinder ? cylinder : fit_wall_of_kind(patch, true, tolerance_mm);
}

}  // namespace scintray::mesh
