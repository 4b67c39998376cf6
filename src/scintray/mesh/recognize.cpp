#include "scintray/mesh/recognize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "scintray/mesh/detail/edges.hpp"
#include "scintray/mesh/detail/surface_fits.hpp"

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
/// Ratios of areas up to which flat pieces are alike, as those of one face mostly are: any, and less and
/// less.
constexpr std::array kAlike = {HUGE_VAL, 3.0, 1.01};
/// Fewest triangles of a face that is found from alike ones: a strip of a few facets of any smooth face lies
/// close to a cone.
constexpr std::size_t kFewestOfAlike = 48;
/// Flat regions without a result after which the search of a mesh ends, since its faces have other forms;
/// and starts without one.
constexpr int kMostFailures = 64, kMostStarts = 1024;
/// Rounds of growth and fit of a face.
constexpr int kMostRounds = 8;

/// Kinds of surfaces, in the order in which they are preferred where they cover the same facets. Corners on
/// two circles about an axis lie on a sphere, too, and facets from one to the other are a wall's; those on
/// two sections of a bent tube lie on one, which is why a sphere needs a corner inside of its face.
enum class RoundKind { wall, torus, sphere };
constexpr std::array kRoundKinds = {RoundKind::wall, RoundKind::torus, RoundKind::sphere};

class Recognizer {
 public:
  Recognizer(TriMesh& mesh, double tolerance_mm)
      : mesh_(mesh), tolerance_(tolerance_mm), neighbours_(mesh), facets_at_(mesh.vertices.size(), 0) {
    const std::size_t count = mesh_.triangles.size();
    mesh_.support.resize(count, kNoSupport);
    for (std::size_t t = 0; t < count; ++t) {
      const core::Vec3 area = mesh_.area_vector(t);
      areas_.push_back(area.norm());
      normals_.push_back(areas_.back() > 0.0 ? core::Vec3(area / areas_.back()) : core::Vec3::Zero());
      for (const std::uint32_t v : mesh_.triangles[t]) ++facets_at_[v];
    }
    find_flat_pieces();
  }

  std::vector<RecognizedFace> run() {
    std::vector<RecognizedFace> found;
    int failures = 0, starts = 0;
    std::vector<char> failed(piece_areas_.size(), 0);
    for (std::size_t t = 0; t < mesh_.triangles.size() && failures < kMostFailures && starts < kMostStarts;
         ++t) {
      if (mesh_.support[t] != kNoSupport || !bends(t)) continue;
      const Candidate best = best_from(static_cast<std::uint32_t>(t));
      if (best.triangles.empty()) {
        // A flat face with many facets along a round one is one failure.
        ++starts;
        if (!failed[piece_[t]]) ++failures;
        failed[piece_[t]] = 1;
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
    if (!(farthest(surface, t) <= tolerance_)) return false;
    core::Vec3 normal = core::Vec3::Zero();
    if (surface.is_torus()) {
      // Of a thin one, the middle of a facet is beyond the tube.
      for (const std::uint32_t v : mesh_.triangles[t]) normal += surface.normal(mesh_.vertices[v]);
      normal.normalize();
    } else {
      normal = surface.normal(centre_of(mesh_, t));
    }
    return std::abs(normals_[t].dot(normal)) >= std::cos(kMostTilted);
  }

  /// Numbers the connected sets of triangles in one plane, and adds up their areas.
  void find_flat_pieces() {
    piece_.assign(mesh_.triangles.size(), kNoSupport);
    for (std::uint32_t first = 0; first < piece_.size(); ++first) {
      if (piece_[first] != kNoSupport) continue;
      const auto number = static_cast<std::uint32_t>(piece_areas_.size());
      piece_areas_.push_back(0.0);
      std::vector<std::uint32_t> todo{first};
      piece_[first] = number;
      while (!todo.empty()) {
        const std::uint32_t t = todo.back();
        todo.pop_back();
        piece_areas_.back() += areas_[t];
        for (const std::uint32_t* next = neighbours_.begin(t); next != neighbours_.end(t); ++next) {
          if (piece_[*next] != kNoSupport || angle_between(normals_[first], normals_[*next]) > kFlattestEdge)
            continue;
          piece_[*next] = number;
          todo.push_back(*next);
        }
      }
    }
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

  /// The surface that covers most facets from one on. First surfaces are fitted to the facets around it;
  /// where none fits, to those of these that are alike: long facets of a wall lead to those beyond its ends
  /// at once.
  Candidate best_from(std::uint32_t start) {
    const double area = piece_areas_[piece_[start]];
    Candidate best;
    for (const double ratio : kAlike) {
      best = best_from(start, ratio < HUGE_VAL ? kSeeds.front() : 1, [&](std::uint32_t t) {
        const double other = piece_areas_[piece_[t]];
        return other <= ratio * area && area <= ratio * other;
      });
      if (ratio < HUGE_VAL && best.triangles.size() < kFewestOfAlike) best = {};
      if (!best.triangles.empty()) break;
    }
    return best;
  }

  template <class Admit>
  Candidate best_from(std::uint32_t start, std::size_t fewest, const Admit& admit) {
    Candidate best;
    std::size_t before = 0;
    for (const std::size_t most : kSeeds) {
      const std::vector<std::uint32_t> near = around(start, most, admit);
      if (near.size() == before || near.size() < fewest) break;
      before = near.size();
      bool fitted = false;
      for (const RoundKind kind : kRoundKinds) {
        const std::optional<SupportSurface> surface = fit(near, kind, nullptr);
        if (!surface) continue;
        fitted = true;
        const std::optional<Candidate> grown = grow(start, *surface, kind);
        if (grown && grown->triangles.size() > best.triangles.size()) best = *grown;
      }
      // What does not fit a few facets does not fit more, unless these do not determine it.
      if (!fitted && is_determined(near)) break;
    }
    return best;
  }

  /// The part of the smooth face that lies on a surface, which is fitted again as it grows.
  std::optional<Candidate> grow(std::uint32_t start, const SupportSurface& first, RoundKind kind) {
    std::optional<SupportSurface> surface = first;
    Candidate result;
    for (int round = 0; round < kMostRounds; ++round) {
      if (!lies_on(*surface, start)) break;
      std::vector<std::uint32_t> triangles =
          around(start, mesh_.triangles.size(), [&](std::uint32_t t) { return lies_on(*surface, t); });
      if (triangles.size() < result.triangles.size()) break;
      const bool grows = triangles.size() > result.triangles.size();
      result = {*surface, std::move(triangles)};
      surface = fit(result.triangles, kind, &result.surface);
      if (!surface || (!grows && round > 0)) break;
    }
    return is_determined(result, kind) ? std::optional(result) : std::nullopt;
  }

  bool is_determined(const Candidate& candidate, RoundKind kind) const {
    if (!is_determined(candidate.triangles)) return false;
    if (kind == RoundKind::torus)
      return determine_torus(candidate.surface, corners_of(candidate.triangles), tolerance_);
    return kind == RoundKind::wall || has_inner_corner(candidate.triangles);
  }

  /// Whether a corner has no facets but these.
  bool has_inner_corner(const std::vector<std::uint32_t>& triangles) const {
    std::vector<std::uint32_t> uses(facets_at_.size(), 0);
    for (const std::uint32_t t : triangles)
      for (const std::uint32_t v : mesh_.triangles[t])
        if (++uses[v] == facets_at_[v]) return true;
    return false;
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

  std::optional<SupportSurface> fit(const std::vector<std::uint32_t>& triangles, RoundKind kind,
                                    const SupportSurface* before) const {
    const FacetPatch patch{mesh_, normals_, areas_, triangles, corners_of(triangles)};
    if (patch.corners.size() < kFewestCorners) return std::nullopt;
    switch (kind) {
      case RoundKind::wall:
        return fit_wall(patch, tolerance_);
      case RoundKind::torus:
        return fit_torus(patch, tolerance_, before);
      case RoundKind::sphere:
        break;
    }
    return fit_sphere(patch, tolerance_);
  }

  TriMesh& mesh_;
  double tolerance_;
  TriangleNeighbours neighbours_;
  std::vector<std::uint32_t> piece_;  ///< flat piece of each triangle
  std::vector<double> piece_areas_;
  std::vector<std::uint32_t> facets_at_;  ///< number of triangles at each corner
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
  const double radius = std::sqrt(surface.radius2);
  char size[80];
  if (surface.is_torus())
    std::snprintf(size, sizeof size, "radii %.6g mm and %.6g mm", surface.major, radius);
  else if (surface.axial < 0.0)
    std::snprintf(size, sizeof size, "half-angle %.6g deg",
                  std::atan(std::sqrt(-surface.axial)) / core::kDegree);
  else
    std::snprintf(size, sizeof size, "radius %.6g mm", radius);
  char text[200];
  std::snprintf(text, sizeof text, "%s of %s recognized in %zu triangles, corners within %.2g um",
                surface.name(), size, face.triangles, 1e3 * face.corner_distance_mm);
  return text;
}

}  // namespace scintray::mesh
