#pragma once
/// Flat faces of a boundary, and the fewest triangles that cover them.

#include <cstdint>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::scene {

struct Boundary;

/// Connected triangles of one label on one plane.
struct FlatFace {
  core::Vec3 normal;  ///< unit, out of the region
  double offset = 0.0;
  std::vector<std::uint32_t> triangles;
};

/// The flat faces of a boundary. Labels with more than 32 planes, those of curved faces, are left out.
/// @param labels  target of each triangle
std::vector<FlatFace> flat_faces(const Boundary& boundary, const std::vector<std::uint32_t>& labels);

double area_of(const FlatFace& face, const Boundary& boundary);

/// A boundary whose flat faces have fewer triangles: each covers triangles of the boundary that have one
/// plane and one label.
struct MergedTriangles {
  std::vector<std::uint32_t> corners;     ///< three a triangle, indices into Boundary::vertices
  std::vector<std::uint32_t> stands_for;  ///< a triangle of the boundary that it covers, or some of it

  bool empty() const { return corners.empty(); }
};

/// The boundary with as few triangles on each face as its outline allows, where that is one polygon; empty
/// where no face has fewer.
MergedTriangles merge_flat_faces(const Boundary& boundary, const std::vector<FlatFace>& faces);

}  // namespace scintray::scene
