#pragma once
/// Recognition of round faces in meshes imported as triangles.

#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// A round face that was recognized.
struct RecognizedFace {
  std::uint32_t support = kNoSupport;  ///< its surface: index into TriMesh::supports
  std::size_t triangles = 0;           ///< number of its triangles
  double corner_distance_mm = 0.0;     ///< largest distance of one of their corners from the surface
};

/// Spheres, cylinders and cones among the faces of a mesh; sets the support surface of their triangles.
/// Triangles that have one already keep it.
///
/// Adjacent facets at 30 degrees or less to each other belong to one smooth face. A surface is fitted to
/// neighbouring facets and grows over the smooth face as long as corners lie on it: a sphere by linear least
/// squares, a cylinder or cone from the axis to which all facets have the same angle (the eigenvector of
/// least eigenvalue of the covariance of their normals), both improved by the Gauss-Newton method. The
/// surface that covers most triangles is taken, then the rest is searched again. A face needs six corners and
/// facets of at least three directions.
///
/// A prism with twelve sides or more is recognized as a cylinder, since a mesh does not state which is
/// intended: callers use this function on request only, and report the result.
/// @param tolerance_mm  largest distance of a corner from the surface
std::vector<RecognizedFace> recognize_round_faces(TriMesh& mesh, double tolerance_mm);

/// A sentence on a recognized face: "cylinder of radius 1.5 mm recognized in 128 triangles, corners within
/// 0.012 um".
std::string describe(const TriMesh& mesh, const RecognizedFace& face);

}  // namespace scintray::mesh
