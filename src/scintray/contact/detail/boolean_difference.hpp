#pragma once
/// Boolean difference of two placed parts.

#include "scintray/contact/contacts.hpp"
#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/boolean.hpp"

namespace scintray::contact {

/// Rotation into axes along the largest faces of the parts (contact::natural_axes): in these axes, faces that
/// are intended to be coplanar have equal coordinates after rounding.
Eigen::Matrix3d difference_axes(const std::vector<PlacedMesh>& parts);

/// `part` minus `tool`. Both are rounded to 2^-30 mm in `axes` about the middle of `part`, so that nearly
/// equal planes become equal; surviving vertices of either keep their original positions. Empty (nullopt)
/// when CGAL fails, an empty mesh when nothing is left.
std::optional<mesh::BooleanResult> difference_on_grid(const mesh::TriMesh& part, const mesh::TriMesh& tool,
                                                      const Eigen::Matrix3d& axes, double tolerance_mm);

/// `part` with its triangles cut along its intersection with `tool`, both rounded as by difference_on_grid().
std::optional<mesh::BooleanResult> imprint_on_grid(const mesh::TriMesh& part, const mesh::TriMesh& tool,
                                                   const Eigen::Matrix3d& axes, double tolerance_mm);

/// Geometry for the queries of contacts; faces are those of the part.
PlacedPart geometry_of(const PlacedMesh& part);

}  // namespace scintray::contact
