#pragma once
/// A fast test that separates most pairs of disjoint triangles.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Triangles of a mesh with the planes that bound them.
class TrianglePlanes {
 public:
  /// The mesh must outlive this object.
  explicit TrianglePlanes(const TriMesh& mesh) : mesh_(mesh) {
    planes_.reserve(mesh.triangles.size());
    for (const auto& corner : mesh.triangles) planes_.emplace_back(mesh.vertices, corner);
  }

  /// True when two triangles that share no corner, or one, have nothing else in common, by a plane with one
  /// of them on one side and the other strictly beyond. It takes a hundredth of the time of the exact
  /// test, and decides nearly every pair of a fan or of other slivers, whose boxes all overlap.
  bool clearly_apart(std::uint32_t a, std::uint32_t b) const {
    const Corners &of_a = mesh_.triangles[a], &of_b = mesh_.triangles[b];
    std::uint32_t common = kNone;
    for (const std::uint32_t i : of_a)
      for (const std::uint32_t j : of_b) {
        if (i != j) continue;
        if (common != kNone && common != i) return false;  // a side in common
        common = i;
      }
    return beyond_a_plane(a, of_b, common) || beyond_a_plane(b, of_a, common);
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;
  static constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

  /// A plane on one side of which a triangle lies, with its rounding error.
  struct Bound {
    core::Vec3 outwards;
    /// Square of the error of a distance along `outwards` for each square of the distance from the plane's
    /// origin.
    double error = 0.0;

    /// True when a point is strictly beyond, whatever the rounding.
    bool beyond(const core::Vec3& from_origin) const {
      const double along = outwards.dot(from_origin);
      return along > 0.0 && along * along > error * from_origin.squaredNorm();
    }
  };

  /// Planes of a triangle: those through its sides (corner k to k + 1) and perpendicular to it, and its own.
  struct Planes {
    std::array<Bound, 3> side;
    Bound own;

    Planes(const std::vector<core::Vec3>& v, const Corners& corner) {
      // Differences, two cross products and a dot product, each right to some units in the last place.
      constexpr double kError = 64 * std::numeric_limits<double>::epsilon();
      std::array<core::Vec3, 3> edge;
      for (std::size_t k = 0; k < 3; ++k) edge[k] = v[corner[(k + 1) % 3]] - v[corner[k]];
      const double size = kError * kError * edge[0].squaredNorm() * edge[1].squaredNorm();
      own = {edge[0].cross(edge[1]), size};
      for (std::size_t k = 0; k < 3; ++k)
        side[k] = {edge[k].cross(own.outwards), size * edge[k].squaredNorm()};
    }
  };

  /// @param common  a corner of both, which the plane then contains; kNone: there is none
  bool beyond_a_plane(std::uint32_t triangle, const Corners& other, std::uint32_t common) const {
    const Corners& own = mesh_.triangles[triangle];
    const Planes& planes = planes_[triangle];
    const auto all_beyond = [&](const Bound& bound, std::uint32_t origin) {
      for (const std::uint32_t corner : other)
        if (corner != common && !bound.beyond(mesh_.vertices[corner] - mesh_.vertices[origin])) return false;
      return true;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = own[k], to = own[(k + 1) % 3];
      if ((common == kNone || common == from || common == to) && all_beyond(planes.side[k], from))
        return true;
    }
    const std::uint32_t origin = common == kNone ? own[0] : common;
    return all_beyond(planes.own, origin) || all_beyond({-planes.own.outwards, planes.own.error}, origin);
  }

  const TriMesh& mesh_;
  std::vector<Planes> planes_;
};

}  // namespace scintray::mesh
