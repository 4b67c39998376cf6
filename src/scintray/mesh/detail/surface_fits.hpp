#pragma once
/// Surfaces through the corners of neighbouring facets.

#include <optional>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Part of a smooth face to which a surface is fitted.
struct FacetPatch {
  const TriMesh& mesh;
  const std::vector<core::Vec3>& normals;       ///< unit normals of all triangles of the mesh
  const std::vector<double>& areas;             ///< of all triangles of the mesh, mm2
  const std::vector<std::uint32_t>& triangles;  ///< those of the patch
  std::vector<core::Vec3> corners;              ///< of these, each once, mm; not empty
};

// Each returns nothing where a corner would be farther from the surface than the tolerance (mm), or where the
// corners are within 20 tolerances of a plane.

/// The sphere through the corners, by linear least squares: |p - c|^2 = r^2 is linear in c and r^2 - |c|^2.
std::optional<SupportSurface> fit_sphere(const FacetPatch& patch, double tolerance_mm);

/// The cylinder, or else the cone, through the corners: the axis is the one to which all facets have one
/// angle (the eigenvector of least eigenvalue of the covariance of their normals), the radius follows by
/// linear least squares, and both are improved by the Gauss-Newton method on the distances across the axis.
std::optional<SupportSurface> fit_wall(const FacetPatch& patch, double tolerance_mm);

/// The torus through the corners, with a tube not wider than its circle.
///
/// The normals of a surface of revolution meet its axis, which is a linear condition on the six coordinates
/// of a line (Pottmann and Randrup, Computing 60 (1998) 307): the axis is that of least squared moments of
/// the facets' normals, each through the centre of the circle about the facet's corners, where it meets the
/// axis exactly for facets with corners on two circles about it. The circle of the tube then follows by
/// linear least squares in the half plane of the axis. Both are improved by the Levenberg-Marquardt method on
/// the distances.
/// @param start  a surface from which to improve; nothing: from the normals
std::optional<SupportSurface> fit_torus(const FacetPatch& patch, double tolerance_mm,
                                        const SupportSurface* start = nullptr);

/// Whether corners determine a torus on which they lie. They are at five angles in its tube or more, since
/// three rings about an axis lie on one, and four, too, that are mirror images; at three angles about its
/// axis, since two sections of a tube determine neither the axis nor the radius to first order; and along 60
/// degrees of one of the two, since a torus lies close to a small piece of any smooth surface. Their arcs
/// bend by 20 tolerances (mm) in the tube, and by one along its circle, below which it is a cylinder.
bool determine_torus(const SupportSurface& torus, const std::vector<core::Vec3>& corners,
                     double tolerance_mm);

/// Middle of points, mm.
core::Vec3 middle_of(const std::vector<core::Vec3>& points);

/// Whether points lie on a surface within `within_mm`, and bend by more than they may be off it, 20
/// tolerances, as those of a plane do not, which is a sphere of any large radius. Lengths mm.
bool is_surface_of(const SupportSurface& surface, const std::vector<core::Vec3>& points, double within_mm,
                   double tolerance_mm);

/// Least thickness of a round face, and least bend of an arc of it, in tolerances.
inline constexpr double kLeastBend = 20.0;

}  // namespace scintray::mesh
