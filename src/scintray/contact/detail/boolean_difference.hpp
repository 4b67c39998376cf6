#pragma once
/// Boolean difference of two placed parts.

#include "scintray/contact/contacts.hpp"
#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/boolean.hpp"

namespace scintray::contact {

/// Rotation into axes along the largest faces of the parts (contact::natural_axes): there, faces that lie
/// in one plane by intention have equal coordinates once these are rounded.
Eigen::Matrix3d difference_axes(const std::vector<PlacedMesh>& parts);

/// `part` less `tool`. Both are rounded to 2^-30 mm in `axes` about the middle of `part`, so that nearly
/// equal planes become equal ones; vertices of either that survive get their own places back. Nothing
/// when CGAL refuses, an empty mesh when nothing is left.
std::optional<mesh::BooleanResult> difference_on_grid(const mesh::TriMesh& part, const mesh::TriMesh& tool,
                                                      const Eigen::Matrix3d& axes, double tolerance_mm);

/// `part` with its triangles cut along its intersection with `tool`, both rounded as by difference_on_grid().
std::optional<mesh::BooleanResult> imprint_on_grid(const mesh::TriMesh& part, const mesh::TriMesh& tool,
                                                   const Eigen::Matrix3d& axes, double tolerance_mm);

/// Geometry for the queries of contacts; faces are those of the part.
PlacedPart geometry_of(const PlacedMesh& part);

}  // namespace scintray::contact
