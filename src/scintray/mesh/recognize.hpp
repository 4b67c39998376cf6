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

/// Spheres, cylinders, cones and tori among the faces of a mesh; sets the support surface of their triangles.
/// Triangles that have one already keep it.
///
/// Adjacent facets at 30 degrees or less to each other belong to one smooth face. A surface is fitted to
/// neighbouring facets (mesh/detail/surface_fits.hpp) and grows over the smooth face as long as corners lie
/// on it. The surface that covers most triangles is taken, of cylinder, cone, torus and sphere the first
/// where they cover the same, then the rest is searched again. A face needs six corners and facets of at
/// least three directions; a sphere a corner inside the face; a torus eight corners, at five angles in its
/// tube and three about its axis, along 60 degrees of one of the two.
///
/// A prism with twelve sides or more is recognized as a cylinder, since a mesh does not state which is
/// intended: callers use this function on request only, and report the result.
/// @param tolerance_mm  largest distance of a corner from the surface
std::vector<RecognizedFace> recognize_round_faces(TriMesh& mesh, double tolerance_mm);

/// A sentence on a recognized face: "cylinder of radius 1.5 mm recognized in 128 triangles, corners within
/// 0.012 um"; of a torus both radii, of its circle first, and of a cone the half-angle.
std::string describe(const TriMesh& mesh, const RecognizedFace& face);

}  // namespace scintray::mesh
