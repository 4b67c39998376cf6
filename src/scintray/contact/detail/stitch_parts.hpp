#pragma once
/// Curved faces that touch where each ends within the other.

#include <string>

#include "scintray/contact/placed_mesh.hpp"

namespace scintray::contact {

/// Gives `taker` the triangles of `keeper` where both face each other within the tolerance, and stitches
/// them to what is left of its own faces.
///
/// Both meshes are first cut where the other's contact ends: along the other part, its facing triangles
/// pushed out by twice the tolerance, so that the planes in which it ends run on through this one's surface
/// (CGAL's corefinement). What then lies in that space and faces the other is the contact, and each part has
/// an outline around it. The taker's contact triangles go; the corners of its outline move onto the keeper's,
/// and where the keeper's outline has corners, its edges are cut; the keeper's triangles, cut at the taker's
/// corners, close it. So the keeper keeps its shape, the contact is the same triangles on both sides, and
/// the taker's faces beside it lean over to the common outline instead of ending at a step. Nothing moves by
/// more than twice the tolerance.
///
/// @return why it cannot be done, or nothing. Then both parts are changed, with a note each.
std::string stitch(PlacedMesh& keeper, PlacedMesh& taker, double tolerance_mm, double flat_mm,
                   const Eigen::Matrix3d& axes);

}  // namespace scintray::contact
