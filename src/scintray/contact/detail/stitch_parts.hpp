#pragma once
/// Curved faces that touch where each ends within the other.

#include <string>

#include "scintray/contact/placed_mesh.hpp"

namespace scintray::contact {

/// Gives `conforming` the triangles of `reference` where both face each other within the tolerance, and
/// stitches them to what is left of its own faces.
///
/// Both meshes are first cut where the other's contact ends: along the other part, its facing triangles
/// pushed out by twice the tolerance, so that the planes in which it ends run on through this one's surface
/// (CGAL's corefinement). What then lies in that space and faces the other is the contact, and each part has
/// an outline around it. The conforming side's contact triangles go; the corners of its outline move onto the
/// reference side's, and where the reference side's outline has corners, its edges are cut; the reference
/// side's triangles, cut at the conforming side's corners, close it. So the reference side keeps its shape,
/// the contact is the same triangles on both sides, and the conforming side's faces beside it lean over to
/// the common outline instead of ending at a step. Nothing moves by more than twice the tolerance.
///
/// @return why it cannot be done, or nothing. Then both parts are changed, with a note each.
std::string stitch(PlacedMesh& reference, PlacedMesh& conforming, double tolerance_mm, double flat_mm,
                   const Eigen::Matrix3d& axes);

}  // namespace scintray::contact
