#pragma once
/// Stitching of two parts along curved faces that touch where each ends within the other, and its steps.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scintray/contact/detail/conformer.hpp"
#include "scintray/contact/detail/geometry.hpp"
#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::contact {

/// Replaces the faces of `conforming` by the triangles of `reference` where both face each other within the
/// tolerance, and stitches these to its remaining faces.
///
/// Both meshes are first cut where the other's contact ends: along the other part, its facing triangles
/// pushed out by twice the tolerance, so that the planes in which it ends continue through this one's surface
/// (CGAL's corefinement). The faces in that space that face the other part are the contact, and each part has
/// an outline around it. The conforming side's contact triangles are removed; the corners of its outline move
/// onto the reference side's, and where the reference side's outline has corners, its edges are cut; the
/// reference side's triangles, cut at the conforming side's corners, close it. So the reference side keeps
/// its shape, the contact is the same triangles on both sides, and the conforming side's faces beside it are
/// tilted to the common outline instead of ending at a step. Nothing moves by more than twice the tolerance.
///
/// @return empty on success, when both parts are changed, with a note each; otherwise the reason of the
/// failure
[[nodiscard]] std::string stitch(PlacedMesh& reference, PlacedMesh& conforming, const ContactRule& rule,
                                 const Eigen::Matrix3d& axes);

/// Displacement of facing triangles, in tolerances: beyond the deepest sliver, with a margin.
inline constexpr double kContactPush = 2.0;

using Loop = std::vector<std::uint32_t>;  ///< vertices, the first one after the last

/// A part cut along the outline of its contact with another part.
struct CutPart {
  mesh::TriMesh mesh;
  std::vector<std::uint32_t> origin;  ///< per triangle, the part's own triangle of which it is a piece
  std::vector<char> contact;          ///< per triangle
  std::vector<Loop> outlines;         ///< of the contact, which lies to their left seen from outside
};

/// A part with the data of its cuts.
struct ContactSide {
  const PlacedMesh& part;
  Body body;
  std::vector<char> wall;    ///< as in ContactRule
  std::vector<char> facing;  ///< per triangle: in part or wholly within the tolerance of the other part
  mesh::TriMesh zone;        ///< pushed outwards there
};

/// The side of the reference part, or of the conforming one.
ContactSide contact_side(const PlacedMesh& part, const PlacedMesh& other, const ContactRule& rule,
                         bool is_reference);

/// The part cut along the outline of its contact with the other. Empty when CGAL fails, or the contact has no
/// simple outline.
[[nodiscard]] std::optional<CutPart> cut_at_contact(const ContactSide& side, const ContactSide& other,
                                                    const ContactReach& reach, const Eigen::Matrix3d& axes);

/// Puts vertex `v` on the edge between two vertices: each triangle there becomes two. `origin` and `contact`
/// follow.
void split_edge(CutPart& part, std::uint32_t a, std::uint32_t b, std::uint32_t v);

std::uint32_t add_vertex(mesh::TriMesh& mesh, const core::Vec3& position);

/// A point of the common outline, in order along the reference side's.
struct Knot {
  double along = 0.0;
  core::Vec3 position;
  std::uint32_t of_reference = ~0U, of_conforming = ~0U;  ///< vertices
};

/// Two cut parts being joined along a common outline, with the changes so far.
struct OutlineStitching {
  CutPart &reference, &conforming;
  double tolerance;                               ///< of the contact, mm
  std::map<std::uint32_t, std::uint32_t> merged;  ///< vertices of the conforming side, and their new ones
  double moved = 0.0;                             ///< largest displacement of one of them, mm
};

/// The common outline that replaces the conforming side's and the reference side's, which runs in the other
/// sense: moves the conforming side's corners onto the reference side's outline, and cuts edges of both parts
/// where the other has a corner. Empty where the two are further apart than twice the tolerance, or their
/// corners are in another order.
[[nodiscard]] std::optional<std::vector<Knot>> stitch_outlines(OutlineStitching& parts,
                                                               const Loop& reference_loop,
                                                               const Loop& conforming_loop);

/// The outline of the reference side along which each outline of the conforming side runs; empty when they do
/// not form pairs.
[[nodiscard]] std::optional<std::vector<std::size_t>> outline_pairs(const CutPart& reference,
                                                                    const CutPart& conforming);

}  // namespace scintray::contact
