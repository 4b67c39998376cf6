#include "scintray/mesh/recognize.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "scintray/mesh/detail/edges.hpp"

namespace scintray::mesh {

namespace {

/// Angle between facets beyond which their edge is one of the body, with room for rounding of 12 sides.
constexpr double kSharpestEdge = 30.001 * core::kDegree;
/// Angle below which facets lie in one plane.
constexpr double kFlattestEdge = 1e-4;
/// Largest angle between a facet and the surface at its middle.
constexpr double kMostTilted = 20.0 * core::kDegree;
constexpr std::size_t kFewestCorners = 6;
constexpr int kFewestDirections = 3;
/// Sizes of the neighbourhoods to which a first surface is fitted, in triangles.
constexpr std::array<std::size_t, 3> kSeeds = {12, 48, 200};
/// Starts without a result after which the search of a mesh ends: its faces have other forms.
constexpr int kMostFailures = 64;
/// Rounds of growth and fit of a face.
constexpr int kMostRounds = 8;
/// Least thickness of a round face, in tolerances.
constexpr double kLeastBend = 20.0;
/// Steps of the Gauss-Newton method, which converges within a few where the surface fits.
constexpr int kSteps = 12;

/// Cylinder or cone by its axis, and the radius along it: radius + slope z.
struct Wall {
  core::Vec3 origin, axis;
  double radius, slope;
};

class Recognizer {
 public:
  Recognizer(TriMesh& mesh, double tolerance_mm) : mesh_(mesh), tolerance_(tolerance_mm), neighbours_(mesh) {
    const std::size_t count = mesh_.triangles.size();
    mesh_.support.resize(count, kNoSupport);
    for (std::size_t t = 0; t < count; ++t) {
      const core::Vec3 area = mesh_.area_vector(t);
      areas_.push_back(area.norm());
      normals_.push_back(areas_.back() > 0.0 ? core::Vec3(area / areas_.back()) : core::Vec3::Zero());
    }
  }

  std::vector<RecognizedFace> run() {
    std::vector<RecognizedFace> found;
    int failures = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size() && failures < kMostFailures; ++t) {
      if (mesh_.support[t] != kNoSupport || !bends(t)) continue;
      const Candidate best = best_from(t);
      if (best.triangles.empty()) {
        ++failures;
        continue;
      }
      RecognizedFace face;
      face.support = mesh_.support_index(best.surface);
      face.triangles = best.triangles.size();
      for (const std::uint32_t i : best.triangles) {
        mesh_.support[i] = face.support;
        face.corner_distance_mm = std::max(face.corner_distance_mm, farthest(best.surface, i));
      }
      found.push_back(face);
    }
    if (mesh_.supports.empty()) mesh_.support.clear();
    return found;
  }

 private:
  struct Candidate {
    SupportSurface surface;
    std::vector<std::uint32_t> triangles;
  };

  /// Calls visit(neighbour) for the free triangles of the same smooth face beside one.
  template <class Visit>
  void for_each_beside(std::size_t t, const Visit& visit) const {
    for (const std::uint32_t* next = neighbours_.begin(t); next != neighbours_.end(t); ++next)
      if (mesh_.support[*next] == kNoSupport && angle_between(normals_[t], normals_[*next]) <= kSharpestEdge)
        visit(*next);
  }

  /// Whether a facet and a neighbour of its smooth face are at an angle.
  bool bends(std::size_t t) const {
    bool found = false;
    for_each_beside(t, [&](std::uint32_t other) {
      found = found || angle_between(normals_[t], normals_[other]) > kFlattestEdge;
    });
    return found;
  }

  double farthest(const SupportSurface& surface, std::uint32_t t) const {
    double largest = 0.0;
    for (const std::uint32_t v : mesh_.triangles[t])
      largest = std::max(largest, std::abs(surface.distance(mesh_.vertices[v])));
    return largest;
  }

  bool lies_on(const SupportSurface& surface, std::uint32_t t) const {
    const core::Vec3 normal = surface.normal(centre_of(mesh_, t));
    return farthest(surface, t) <= tolerance_ && std::abs(normals_[t].dot(normal)) >= std::cos(kMostTilted);
  }

  /// Free triangles of the smooth face around one, nearest first, as long as `admit` accepts them.
  template <class Admit>
  std::vector<std::uint32_t> around(std::uint32_t start, std::size_t most, const Admit& admit) {
    ++visit_;
    visited_.resize(mesh_.triangles.size(), 0);
    std::vector<std::uint32_t> result{start};
    visited_[start] = visit_;
    for (std::size_t i = 0; i < result.size() && result.size() < most; ++i)
      for_each_beside(result[i], [&](std::uint32_t next) {
        if (visited_[next] == visit_) return;
        visited_[next] = visit_;
        if (admit(next)) result.push_back(next);
      });
    return result;
  }

  std::vector<core::Vec3> corners_of(const std::vector<std::uint32_t>& triangles) const {
    std::vector<std::uint32_t> ids;
    for (const std::uint32_t t : triangles)
      ids.insert(ids.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::vector<core::Vec3> points;
    for (const std::uint32_t v : ids) points.push_back(mesh_.vertices[v]);
    return points;
  }

  Candidate best_from(std::size_t seed) {
    Candidate best;
    const auto start = static_cast<std::uint32_t>(seed);
    std::size_t before = 0;
    for (const std::size_t most : kSeeds) {
      const std::vector<std::uint32_t> near = around(start, most, [](std::uint32_t) { return true; });
      if (near.size() == before) break;
      before = near.size();
      bool fitted = false;
      // Corners on two circles about an axis lie on a sphere, too; facets from one to the other are a wall's.
      // A sphere has to take in more of the face.
      for (const bool sphere : {false, true}) {
        const std::optional<SupportSurface> surface = fit(near, sphere);
        if (!surface) continue;
        fitted = true;
        const std::optional<Candidate> grown = grow(start, *surface, sphere);
        if (grown && grown->triangles.size() > best.triangles.size()) best = *grown;
      }
      // What does not fit a few facets does not fit more, unless these do not determine it.
      if (!fitted && is_determined(near)) break;
    }
    return best;
  }

  /// The part of the smooth face that lies on a surface, which is fitted again as it grows.
  std::optional<Candidate> grow(std::uint32_t start, const SupportSurface& first, bool sphere) {
    std::optional<SupportSurface> surface = first;
    Candidate result;
    for (int round = 0; round < kMostRounds; ++round) {
      if (!lies_on(*surface, start)) break;
      std::vector<std::uint32_t> triangles =
          around(start, mesh_.triangles.size(), [&](std::uint32_t t) { return lies_on(*surface, t); });
      if (triangles.size() < result.triangles.size()) break;
      const bool grows = triangles.size() > result.triangles.size();
      result = {*surface, std::move(triangles)};
      surface = fit(result.triangles, sphere);
      if (!surface || (!grows && round > 0)) break;
    }
    if (!is_determined(result.triangles)) return std::nullopt;
    return result;
  }

  bool is_determined(const std::vector<std::uint32_t>& triangles) const {
    if (corners_of(triangles).size() < kFewestCorners) return false;
    std::vector<core::Vec3> directions;
    for (const std::uint32_t t : triangles) {
      const bool known = std::any_of(directions.begin(), directions.end(), [&](const core::Vec3& d) {
        return angle_between(d, normals_[t]) <= kFlattestEdge;
      });
      if (!known) directions.push_back(normals_[t]);
      if (directions.size() >= kFewestDirections) return true;
    }
    return false;
  }

  std::optional<SupportSurface> fit(const std::vector<std::uint32_t>& triangles, bool sphere) const {
    const std::vector<core::Vec3> points = corners_of(triangles);
    if (points.size() < kFewestCorners) return std::nullopt;
    if (sphere) return fit_sphere(points);
    const std::optional<SupportSurface> cylinder = fit_wall(triangles, points, false);
    return cylinder ? cylinder : fit_wall(triangles, points, true);
  }

  static core::Vec3 mean_of(const std::vector<core::Vec3>& points) {
    core::Vec3 sum = core::Vec3::Zero();
    for (const core::Vec3& p : points) sum += p;
    return sum / static_cast<double>(points.size());
  }

  /// |p - c|^2 = r^2 is linear in c and r^2 - |c|^2.
  std::optional<SupportSurface> fit_sphere(const std::vector<core::Vec3>& points) const {
    const core::Vec3 mean = mean_of(points);
    Eigen::MatrixXd left(static_cast<Eigen::Index>(points.size()), 4);
    Eigen::VectorXd right(left.rows());
    for (Eigen::Index i = 0; i < left.rows(); ++i) {
      const core::Vec3 p = points[static_cast<std::size_t>(i)] - mean;
      left.row(i) << 2.0 * p.transpose(), 1.0;
      right[i] = p.squaredNorm();
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(left);
    if (solver.rank() < 4) return std::nullopt;
    const Eigen::VectorXd solution = solver.solve(right);
    const core::Vec3 centre = solution.head<3>();
    const double radius2 = solution[3] + centre.squaredNorm();
    if (!(radius2 > 0.0)) return std::nullopt;
    const SupportSurface result = SupportSurface::sphere(mean + centre, std::sqrt(radius2));
    return fits(result, points, tolerance_) ? std::optional(result) : std::nullopt;
  }

  /// Axis to which all facets have one angle (cone) or a right angle (cylinder).
  core::Vec3 axis_of(const std::vector<std::uint32_t>& triangles, bool cone) const {
    core::Vec3 mean = core::Vec3::Zero();
    double area = 0.0;
    for (const std::uint32_t t : triangles) {
      mean += areas_[t] * normals_[t];
      area += areas_[t];
    }
    mean = cone ? core::Vec3(mean / area) : core::Vec3::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const std::uint32_t t : triangles) {
      const core::Vec3 d = normals_[t] - mean;
      covariance += areas_[t] * d * d.transpose();
    }
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
  }

  std::optional<SupportSurface> fit_wall(const std::vector<std::uint32_t>& triangles,
                                         const std::vector<core::Vec3>& points, bool cone) const {
    const core::Vec3 mean = mean_of(points);
    std::optional<Wall> wall = first_wall(points, mean, axis_of(triangles, cone), cone);
    // The axis of facets whose corners are on the surface is exact, and poorly known from few rings of
    // corners: it is turned only where it does not fit.
    for (int step = 0; wall && step < kSteps; ++step) wall = improved(points, *wall, {cone, false});
    if (!wall) return std::nullopt;
    if (const std::optional<SupportSurface> exact = surface_of(*wall, points, 0.1 * tolerance_)) return exact;
    for (int step = 0; wall && step < kSteps; ++step) wall = improved(points, *wall, {cone, true});
    return wall ? surface_of(*wall, points, tolerance_) : std::nullopt;
  }

  std::optional<SupportSurface> surface_of(const Wall& wall, const std::vector<core::Vec3>& points,
                                           double tolerance_mm) const {
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
    return fits(result, points, tolerance_mm) ? std::optional(result) : std::nullopt;
  }

  /// |p|^2 = 2 p . c + a + b z + g z^2 across the axis is linear, with radius^2 = a + |c|^2 and
  /// b = 2 radius slope.
  static std::optional<Wall> first_wall(const std::vector<core::Vec3>& points, const core::Vec3& mean,
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
    const Eigen::VectorXd s = left.completeOrthogonalDecomposition().solve(right);
    const double radius2 = s[2] + s[0] * s[0] + s[1] * s[1];
    if (!(radius2 > 0.0) || !std::isfinite(radius2)) return std::nullopt;
    const double radius = std::sqrt(radius2);
    return Wall{mean + s[0] * x + s[1] * y, axis, radius, cone ? s[3] / (2.0 * radius) : 0.0};
  }

  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  /// What the Gauss-Newton method may change.
  struct Free {
    bool slope, axis;
  };

  /// One step of the Gauss-Newton method on the distances across the axis.
  static std::optional<Wall> improved(const std::vector<core::Vec3>& points, const Wall& wall, Free free) {
    const core::Vec3 x = wall.axis.unitOrthogonal(), y = wall.axis.cross(x);
    // Normal equations: of large faces a matrix of all slopes takes more memory than the mesh.
    Vector6 slope, sums = Vector6::Zero();
    Matrix6 products = Matrix6::Zero();
    for (const core::Vec3& point : points) {
      const core::Vec3 p = point - wall.origin;
      const double px = x.dot(p), py = y.dot(p), z = wall.axis.dot(p), rho = std::hypot(px, py);
      // The tip of a cone has no direction across the axis.
      const double cosine = rho > 0.0 ? px / rho : 0.0, sine = rho > 0.0 ? py / rho : 0.0;
      const double off = rho - wall.radius - wall.slope * z;
      // Rotating the axis by small angles towards x and y subtracts z from the distance, and adds to z. For
      // what is not free, zero change is the least-norm solution.
      const double turn = free.axis ? 1.0 : 0.0;
      slope << -cosine, -sine, -turn * (z * cosine + wall.slope * px), -turn * (z * sine + wall.slope * py),
          -1.0, free.slope ? -z : 0.0;
      products += slope * slope.transpose();
      sums -= off * slope;
    }
    const Vector6 change = products.completeOrthogonalDecomposition().solve(sums);
    if (!change.allFinite()) return std::nullopt;
    Wall next = wall;
    next.origin += change[0] * x + change[1] * y;
    next.axis = (wall.axis + change[2] * x + change[3] * y).normalized();
    next.radius += change[4];
    next.slope += change[5];
    return next.radius > 0.0 ? std::optional(next) : std::nullopt;
  }

  /// Whether the points lie on the surface, and bend by more than they may be off it, as those of a plane do
  /// not, which is a sphere of any large radius.
  bool fits(const SupportSurface& surface, const std::vector<core::Vec3>& points, double tolerance_mm) const {
    for (const core::Vec3& p : points)
      if (!(std::abs(surface.distance(p)) <= tolerance_mm)) return false;
    const core::Vec3 mean = mean_of(points);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const core::Vec3& p : points) covariance += (p - mean) * (p - mean).transpose();
    const core::Vec3 thin = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
    double low = 0.0, high = 0.0;
    for (const core::Vec3& p : points) {
      low = std::min(low, thin.dot(p - mean));
      high = std::max(high, thin.dot(p - mean));
    }
    return high - low >= kLeastBend * tolerance_;
  }

  TriMesh& mesh_;
  double tolerance_;
  TriangleNeighbours neighbours_;
  std::vector<double> areas_;
  std::vector<core::Vec3> normals_;
  std::vector<std::uint32_t> visited_;
  std::uint32_t visit_ = 0;
};

}  // namespace

std::vector<RecognizedFace> recognize_round_faces(TriMesh& mesh, double tolerance_mm) {
  return Recognizer(mesh, tolerance_mm).run();
}

std::string describe(const TriMesh& mesh, const RecognizedFace& face) {
  const SupportSurface& surface = mesh.supports[face.support];
  const bool cone = surface.axial < 0.0;
  char text[160];
  std::snprintf(text, sizeof text, "%s of %s %.6g %s recognized in %zu triangles, corners within %.2g um",
                surface.name(), cone ? "half-angle" : "radius",
                cone ? std::atan(std::sqrt(-surface.axial)) / core::kDegree : std::sqrt(surface.radius2),
                cone ? "deg" : "mm", face.triangles, 1e3 * face.corner_distance_mm);
  return text;
}

}  // namespace scintray::mesh
