#include <algorithm>
#include <array>
#include <cmath>

#include "scintray/core/linear_solutions.hpp"
#include "scintray/mesh/detail/surface_fits.hpp"

namespace scintray::mesh {

namespace {

constexpr int kTorusSteps = 60;
/// Fewest corners: one more than a torus has numbers.
constexpr std::size_t kFewestOfTorus = 8;
/// Fewest angles of corners in the tube, and about the axis.
constexpr std::size_t kFewestInTube = 5, kFewestAbout = 3;
/// Least angle of the longer arc: a torus lies close to a few facets of any smooth surface.
constexpr double kLeastTurn = 60.0 * core::kDegree;
/// Change of a fit, as a share of its size, below which it has converged.
constexpr double kConverged = 1e-14;

struct FittedTorus {
  core::Vec3 centre, axis;
  double major, minor;

  /// A point in the half plane of the axis: from the circle in the tube, outwards and along the axis; and the
  /// directions across the axis.
  struct Place {
    double out, along, distance, cosine, sine, px, py, z;
  };
  Place place(const core::Vec3& point, const core::Vec3& x, const core::Vec3& y) const {
    const core::Vec3 p = point - centre;
    Place at{};
    at.px = x.dot(p);
    at.py = y.dot(p);
    at.z = axis.dot(p);
    const double rho = std::hypot(at.px, at.py);
    at.cosine = rho > 0.0 ? at.px / rho : 0.0;
    at.sine = rho > 0.0 ? at.py / rho : 0.0;
    const double across = rho - major;
    at.distance = std::hypot(across, at.z);
    at.out = at.distance > 0.0 ? across / at.distance : 0.0;
    at.along = at.distance > 0.0 ? at.z / at.distance : 0.0;
    return at;
  }
};

struct AxisLine {
  core::Vec3 through, direction;
};

/// The centre of the circle about a triangle's corners; nothing for one that is far outside of it.
std::optional<core::Vec3> circle_centre(const TriMesh& mesh, std::uint32_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  const core::Vec3 &a = mesh.vertices[i], ab = mesh.vertices[j] - a, ac = mesh.vertices[k] - a;
  const core::Vec3 doubled = ab.cross(ac);
  const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  const core::Vec3 to_centre = (ac.squaredNorm() * doubled.cross(ab) + ab.squaredNorm() * ac.cross(doubled)) /
                               (2.0 * doubled.squaredNorm());
  if (!(to_centre.squaredNorm() <= longest2)) return std::nullopt;
  return a + to_centre;
}

/// Lines that the facets' normals meet best, the best first. Coordinates are taken from `mean` in units of
/// `size`, mm.
std::vector<AxisLine> axes_of_revolution(const FacetPatch& patch, const core::Vec3& mean, double size) {
  // The moment of a line n through p about the axis a through c is n . (a x p + m), with m = c x a.
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero(), mixed = directions, moments = directions;
  for (const std::uint32_t t : patch.triangles) {
    const std::optional<core::Vec3> at = circle_centre(patch.mesh, t);
    if (!at) continue;
    const core::Vec3& n = patch.normals[t];
    const core::Vec3 moment = ((*at - mean) / size).cross(n);
    directions += patch.areas[t] * moment * moment.transpose();
    mixed += patch.areas[t] * moment * n.transpose();
    moments += patch.areas[t] * n * n.transpose();
  }
  if (!directions.allFinite() || !mixed.allFinite() || !moments.allFinite()) return {};
  // With |a| = 1 the best m is linear in a.
  const Eigen::Matrix3d best = -core::least_solution(moments, mixed.transpose()).x;
  Eigen::Matrix3d reduced = directions + mixed * best;
  reduced = 0.5 * (reduced + reduced.transpose().eval());
  if (!reduced.allFinite()) return {};
  const Eigen::Matrix3d axes = core::principal_axes(reduced).directions;
  std::vector<AxisLine> lines;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const core::Vec3 axis = axes.col(i), moment = best * axis;
    lines.push_back({mean + size * axis.cross(moment), axis});
  }
  return lines;
}

/// rho^2 + z^2 = 2 rho major + 2 z height + (minor^2 - major^2 - height^2) is linear.
std::optional<FittedTorus> first_torus(const std::vector<core::Vec3>& points, const AxisLine& line,
                                       double size) {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  core::Vec3 sums = core::Vec3::Zero();
  for (const core::Vec3& point : points) {
    const core::Vec3 p = (point - line.through) / size;
    const double z = line.direction.dot(p), rho = line.direction.cross(p).norm();
    const core::Vec3 row(2.0 * rho, 2.0 * z, 1.0);
    products += row * row.transpose();
    sums += (rho * rho + z * z) * row;
  }
  const core::Vec3 s = core::least_solution(products, sums).x;
  const double minor2 = s[2] + s[0] * s[0] + s[1] * s[1];
  if (!s.allFinite() || !(s[0] > 0.0) || !(minor2 > 0.0)) return std::nullopt;
  return FittedTorus{line.through + size * s[1] * line.direction, line.direction, size * s[0],
                     size * std::sqrt(minor2)};
}

double squared_distances(const std::vector<core::Vec3>& points, const FittedTorus& torus) {
  const core::Vec3 x = torus.axis.unitOrthogonal(), y = torus.axis.cross(x);
  double sum = 0.0;
  for (const core::Vec3& point : points) {
    const double off = torus.place(point, x, y).distance - torus.minor;
    sum += off * off;
  }
  return sum;
}

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

/// Slopes of the squared distances: the centre's place across and along the axis, the axis's turns towards
/// these, times `size` (mm), and both radii.
struct TorusSlopes {
  Matrix7 products = Matrix7::Zero();
  Vector7 sums = Vector7::Zero();

  TorusSlopes(const std::vector<core::Vec3>& points, const FittedTorus& torus, double size) {
    const core::Vec3 x = torus.axis.unitOrthogonal(), y = torus.axis.cross(x);
    for (const core::Vec3& point : points) {
      const FittedTorus::Place at = torus.place(point, x, y);
      // The axis turned towards x adds px to z and takes z from the distance along x.
      Vector7 slope;
      slope << -at.out * at.cosine, -at.out * at.sine, -at.along,
          (at.along * at.px - at.out * at.z * at.cosine) / size,
          (at.along * at.py - at.out * at.z * at.sine) / size, -at.out, -1.0;
      products += slope * slope.transpose();
      sums -= (at.distance - torus.minor) * slope;
    }
  }
};

/// The Levenberg-Marquardt method on the distances.
std::optional<FittedTorus> improved_torus(const std::vector<core::Vec3>& points, FittedTorus torus,
                                          double size) {
  double sum = squared_distances(points, torus), damping = 1e-3;
  for (int step = 0; step < kTorusSteps && std::isfinite(sum); ++step) {
    const TorusSlopes slopes(points, torus, size);
    bool better = false;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      Matrix7 damped = slopes.products;
      damped.diagonal() *= 1.0 + damping;
      const Vector7 change = core::least_solution(damped, slopes.sums).x;
      const core::Vec3 x = torus.axis.unitOrthogonal(), y = torus.axis.cross(x);
      FittedTorus next = torus;
      next.centre += change[0] * x + change[1] * y + change[2] * torus.axis;
      next.axis = (torus.axis + change[3] / size * x + change[4] / size * y).normalized();
      next.major += change[5];
      next.minor += change[6];
      const double then = squared_distances(points, next);
      better = then < sum && next.major > 0.0 && next.minor > 0.0;
      damping *= better ? 0.1 : 10.0;
      if (!better) continue;
      torus = next;
      sum = then;
      if (change.norm() <= kConverged * (size + torus.major)) return torus;
    }
    if (!better) break;  // within rounding of the least
  }
  if (!std::isfinite(sum)) return std::nullopt;
  return torus;
}

/// Angles, sorted, of an arc.
struct AngleSpan {
  std::size_t distinct = 0;
  double extent = 0.0;  ///< rad; up to 2 pi

  AngleSpan(std::vector<double> angles, double step) {
    std::sort(angles.begin(), angles.end());
    double widest = angles.front() + core::kTwoPi - angles.back();
    distinct = widest > step ? 1 : 0;
    for (std::size_t i = 1; i < angles.size(); ++i) {
      widest = std::max(widest, angles[i] - angles[i - 1]);
      distinct += angles[i] - angles[i - 1] > step;
    }
    extent = core::kTwoPi - widest;
  }

  double bend(double radius) const { return radius * (1.0 - std::cos(0.5 * std::min(extent, core::kPi))); }
};

}  // namespace

std::optional<SupportSurface> fit_torus(const FacetPatch& patch, double tolerance_mm,
                                        const SupportSurface* start) {
  if (patch.corners.size() < kFewestOfTorus) return std::nullopt;
  const core::Vec3 mean = middle_of(patch.corners);
  double size = 0.0;
  for (const core::Vec3& p : patch.corners) size = std::max(size, (p - mean).norm());
  if (!(size > 0.0) || !std::isfinite(size)) return std::nullopt;
  std::vector<FittedTorus> starts;
  if (start)
    starts.push_back({start->origin, start->axis, start->major, std::sqrt(start->radius2)});
  else
    for (const AxisLine& line : axes_of_revolution(patch, mean, size))
      if (const std::optional<FittedTorus> first = first_torus(patch.corners, line, size))
        starts.push_back(*first);
  for (const FittedTorus& first : starts) {
    const std::optional<FittedTorus> torus = improved_torus(patch.corners, first, size);
    if (!torus || torus->major < torus->minor) continue;
    const SupportSurface result =
        SupportSurface::torus(torus->centre, torus->axis, torus->major, torus->minor);
    if (is_surface_of(result, patch.corners, tolerance_mm, tolerance_mm)) return result;
  }
  return std::nullopt;
}

bool determine_torus(const SupportSurface& torus, const std::vector<core::Vec3>& corners,
                     double tolerance_mm) {
  const double minor = std::sqrt(torus.radius2);
  const core::Vec3 axis = torus.axis, x = axis.unitOrthogonal(), y = axis.cross(x);
  std::vector<double> around, in_tube;
  for (const core::Vec3& corner : corners) {
    const core::Vec3 p = corner - torus.origin;
    const double px = x.dot(p), py = y.dot(p);
    around.push_back(std::atan2(py, px));
    in_tube.push_back(std::atan2(axis.dot(p), std::hypot(px, py) - torus.major));
  }
  const double rounding = 4.0 * tolerance_mm + 1e-6 * minor;
  const AngleSpan circle(std::move(around), rounding / torus.major),
      tube(std::move(in_tube), rounding / minor);
  if (std::max(tube.extent, circle.extent) < kLeastTurn) return false;
  return tube.distinct >= kFewestInTube && circle.distinct >= kFewestAbout &&
         tube.bend(minor) >= kLeastBend * tolerance_mm && circle.bend(torus.major) >= tolerance_mm;
}

}  // namespace scintray::mesh
