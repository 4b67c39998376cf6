#pragma once
/// Cutting two parts where their curved contact ends.

#include <optional>
#include <vector>

#include "scintray/contact/detail/geometry.hpp"
#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::contact {

/// How far facing triangles are pushed, in tolerances: past the deepest sliver, with room.
inline constexpr double kContactPush = 2.0;

using Loop = std::vector<std::uint32_t>;  ///< vertices, the first one after the last

/// A part cut where its contact with another ends.
struct CutPart {
  mesh::TriMesh mesh;
  std::vector<std::uint32_t> origin;  ///< per triangle, the part's own triangle that it is a piece of
  std::vector<char> contact;          ///< per triangle
  std::vector<Loop> outlines;         ///< of the contact, which lies to their left seen from outside
};

/// A part with what the cuts need.
struct ContactSide {
  const PlacedMesh& part;
  Body body;
  std::vector<char> facing;  ///< per triangle: in part or wholly within the tolerance of the other part
  mesh::TriMesh zone;        ///< pushed outwards there
};

ContactSide contact_side(const PlacedMesh& part, const PlacedMesh& other, double tolerance, double flat_mm);

/// Cuts a part where its contact with the other ends. Nothing when CGAL refuses, or the contact has no
/// plain outline.
std::optional<CutPart> cut_at_contact(const ContactSide& side, const ContactSide& other, double tolerance,
                                      double flat_mm, const Eigen::Matrix3d& axes);

/// Puts vertex `v` on the edge between two vertices: each triangle there becomes two. `origin` and `contact`
/// follow.
void split_edge(CutPart& part, std::uint32_t a, std::uint32_t b, std::uint32_t v);

std::uint32_t add_vertex(mesh::TriMesh& mesh, const core::Vec3& position);

}  // namespace scintray::contact
