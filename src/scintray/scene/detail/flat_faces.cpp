#include "scintray/scene/detail/flat_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "scintray/mesh/shapes/polygon.hpp"

namespace scintray::scene {

namespace {

/// Planes of one label, beyond which it is a curved face.
constexpr std::size_t kMostPlanesOfLabel = 32;
/// Corners of an outline, beyond which its triangles are kept: the time to clip ears is quadratic.
constexpr std::size_t kMostOutlineCorners = 256;
/// Relative difference of areas up to which triangles cover a face.
constexpr double kSameCover = 1e-9;

/// Numbers of the connected pieces of a face, by its triangles: those with a side in common are of one piece.
std::vector<std::size_t> pieces_of(const std::vector<std::uint32_t>& triangles, const Boundary& boundary) {
  struct Side {
    std::uint32_t low, high;
    std::size_t triangle;
  };
  std::vector<Side> sides;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(boundary.corners[3 * triangles[i] + k],
                                           boundary.corners[3 * triangles[i] + (k + 1) % 3]);
      sides.push_back({low, high, i});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::vector<std::size_t> piece(triangles.size());
  std::iota(piece.begin(), piece.end(), std::size_t{0});
  const auto root = [&piece](std::size_t i) {
    while (piece[i] != i) i = piece[i] = piece[piece[i]];
    return i;
  };
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].low == sides[i - 1].low && sides[i].high == sides[i - 1].high)
      piece[root(sides[i].triangle)] = root(sides[i - 1].triangle);
  for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = root(i);
  return piece;
}

/// Replaces the faces from `begin` by their connected pieces.
void split(std::vector<FlatFace>& faces, std::size_t begin, const Boundary& boundary) {
  const std::vector<FlatFace> whole(faces.begin() + static_cast<std::ptrdiff_t>(begin), faces.end());
  faces.resize(begin);
  for (const FlatFace& face : whole) {
    const std::vector<std::size_t> piece = pieces_of(face.triangles, boundary);
    std::map<std::size_t, std::size_t> known;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const auto [at, is_new] = known.try_emplace(piece[i], faces.size());
      if (is_new) faces.push_back({face.normal, face.offset, {}});
      faces[at->second].triangles.push_back(face.triangles[i]);
    }
  }
}

using CornerNumbers = std::vector<std::uint32_t>;

/// The outline of a face in its triangles' sense of rotation; empty where it is not one polygon.
CornerNumbers outline_of(const FlatFace& face, const Boundary& boundary) {
  std::map<std::uint32_t, std::uint32_t> next;
  std::vector<std::array<std::uint32_t, 2>> sides, reversed;
  for (const std::uint32_t triangle : face.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = boundary.corners[3 * triangle + k];
      const std::uint32_t to = boundary.corners[3 * triangle + (k + 1) % 3];
      sides.push_back({from, to});
      reversed.push_back({to, from});
    }
  std::sort(reversed.begin(), reversed.end());
  for (const auto& side : sides) {
    if (std::binary_search(reversed.begin(), reversed.end(), side)) continue;
    if (!next.emplace(side[0], side[1]).second) return {};
  }
  if (next.empty()) return {};
  CornerNumbers outline;
  std::uint32_t at = next.begin()->first;
  do {
    const auto side = next.find(at);
    if (side == next.end() || outline.size() == next.size()) return {};
    outline.push_back(at);
    at = side->second;
  } while (at != outline.front());
  return outline.size() == next.size() ? outline : CornerNumbers{};
}

/// The outline without corners on the straight line between those beside them.
CornerNumbers without_straight(const CornerNumbers& outline, const Boundary& boundary) {
  const double tolerance = kCoplanar * boundary.size_mm;
  const auto is_straight = [&](std::uint32_t before, std::uint32_t at, std::uint32_t after) {
    const core::Vec3 a = boundary.vertices[before], b = boundary.vertices[at], c = boundary.vertices[after];
    const core::Vec3 along = (c - a).normalized();
    return along.dot(b - a) > 0.0 && along.dot(c - b) > 0.0 && along.cross(b - a).norm() <= tolerance;
  };
  CornerNumbers kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::uint32_t before = kept.empty() ? outline.back() : kept.back();
    if (!is_straight(before, outline[i], outline[(i + 1) % outline.size()])) kept.push_back(outline[i]);
  }
  while (kept.size() > 3 && is_straight(kept[kept.size() - 2], kept.back(), kept.front())) kept.pop_back();
  return kept;
}

/// Fewer triangles over a face, three corners each; empty where there are none.
CornerNumbers fewer_triangles(const FlatFace& face, const Boundary& boundary) {
  if (face.triangles.size() < 3) return {};
  const CornerNumbers outline = without_straight(outline_of(face, boundary), boundary);
  if (outline.size() < 3 || outline.size() > kMostOutlineCorners ||
      outline.size() - 2 >= face.triangles.size())
    return {};
  std::vector<core::Vec3> corners;
  for (const std::uint32_t corner : outline) corners.push_back(boundary.vertices[corner]);
  bool simple = true;
  double area = 0.0;
  CornerNumbers triangles;
  for (const auto& triangle : mesh::triangulate_polygon(corners, simple)) {
    area += area_of(BoundaryTriangle{corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]});
    for (const std::uint32_t corner : triangle) triangles.push_back(outline[corner]);
  }
  const double whole = area_of(face, boundary);
  return simple && std::abs(area - whole) <= kSameCover * whole ? triangles : CornerNumbers{};
}

}  // namespace

double area_of(const FlatFace& face, const Boundary& boundary) {
  double area = 0.0;
  for (const std::uint32_t triangle : face.triangles) area += area_of(boundary.triangle(triangle));
  return area;
}

std::vector<FlatFace> flat_faces(const Boundary& boundary, const std::vector<std::uint32_t>& labels) {
  std::vector<std::uint32_t> order(boundary.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return labels[a] < labels[b]; });
  const double tolerance = kCoplanar * boundary.size_mm;
  std::vector<FlatFace> faces;
  for (auto first = order.begin(); first != order.end();) {
    const auto last =
        std::find_if(first, order.end(), [&](std::uint32_t i) { return labels[i] != labels[*first]; });
    const std::size_t begin = faces.size();
    for (; first != last; ++first) {
      const TrianglePlane& plane = boundary.triangle_planes[*first];
      const BoundaryTriangle corners = boundary.triangle(*first);
      const auto known = std::find_if(
          faces.begin() + static_cast<std::ptrdiff_t>(begin), faces.end(), [&](const FlatFace& face) {
            return face.normal.dot(plane.normal.vec()) > 0.0 &&
                   std::all_of(corners.begin(), corners.end(), [&](const core::Vec3& corner) {
                     return std::abs(face.normal.dot(corner) - face.offset) <= tolerance;
                   });
          });
      if (known != faces.end()) {
        known->triangles.push_back(*first);
        continue;
      }
      if (faces.size() - begin == kMostPlanesOfLabel) break;
      faces.push_back({plane.normal, plane.offset, {*first}});
    }
    if (first != last) faces.resize(begin);
    first = last;
    split(faces, begin, boundary);
  }
  return faces;
}

MergedTriangles merge_flat_faces(const Boundary& boundary, const std::vector<FlatFace>& faces) {
  MergedTriangles merged;
  std::vector<char> covered(boundary.size());
  for (const FlatFace& face : faces) {
    const CornerNumbers triangles = fewer_triangles(face, boundary);
    if (triangles.empty()) continue;
    merged.corners.insert(merged.corners.end(), triangles.begin(), triangles.end());
    merged.stands_for.insert(merged.stands_for.end(), triangles.size() / 3, face.triangles.front());
    for (const std::uint32_t triangle : face.triangles) covered[triangle] = 1;
  }
  if (merged.empty()) return merged;
  for (std::uint32_t i = 0; i < boundary.size(); ++i) {
    if (covered[i] != 0) continue;
    const auto corners = boundary.corners.begin() + 3 * static_cast<std::ptrdiff_t>(i);
    merged.corners.insert(merged.corners.end(), corners, corners + 3);
    merged.stands_for.push_back(i);
  }
  return merged;
}

}  // namespace scintray::scene
