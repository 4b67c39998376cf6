#pragma once
/// Flat faces of a boundary, and what makes searches in it faster: few triangles, and thin gaps.

#include <cstdint>
#include <vector>

#include "scintray/scene/boundary.hpp"

namespace scintray::scene {

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

/// The boundary with as few triangles on each face as its outline allows, where that is one polygon; empty
/// where no face has fewer.
MergedTriangles merge_flat_faces(const Boundary& boundary, const std::vector<FlatFace>& faces);

/// The thin gaps of a region that Embree searches. Faces count that are rectangles; the gap is narrower than
/// a quarter of both sides of what two faces have in common. Gaps from one face to more than 16 others are
/// left out, and those of more than 256 directions: light there is followed by search.
ThinGaps find_thin_gaps(const Boundary& boundary, const std::vector<FlatFace>& faces);

}  // namespace scintray::scene
