#pragma once
/// Smooth faces that a mesh represents by facets.

#include <cstdint>
#include <vector>

#include "scintray/mesh/support_surface.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Estimate, for each face, of the deviation of its facets from the smooth surface that they approximate;
/// zero for faces that are flat, or whose facets are at more than 30 degrees to each other, as a prism's.
///
/// Facets at an angle d to each other at an edge are taken as chords of one arc: each is d / 2 from the
/// surface's direction at the edge, and the sagitta of a chord of width w is w d / 8 (to third order).
/// @param face_of  face of each triangle; only triangles of one face, without a support surface, are compared
/// @param faces    their number
std::vector<FacetDeviation> smooth_face_deviations(const TriMesh& mesh,
                                                   const std::vector<std::uint32_t>& face_of,
                                                   std::size_t faces);

}  // namespace scintray::mesh
