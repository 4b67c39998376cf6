#pragma once
/// Curved faces that touch where each ends within the other: the stitching of two parts, and its steps.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scintray/contact/detail/geometry.hpp"
#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/trimesh.hpp"

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
[[nodiscard]] std::string stitch(PlacedMesh& reference, PlacedMesh& conforming, double tolerance_mm,
                                 double flat_mm, const Eigen::Matrix3d& axes);

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
[[nodiscard]] std::optional<CutPart> cut_at_contact(const ContactSide& side, const ContactSide& other,
                                                    double tolerance, double flat_mm,
                                                    const Eigen::Matrix3d& axes);

/// Puts vertex `v` on the edge between two vertices: each triangle there becomes two. `origin` and `contact`
/// follow.
void split_edge(CutPart& part, std::uint32_t a, std::uint32_t b, std::uint32_t v);

std::uint32_t add_vertex(mesh::TriMesh& mesh, const core::Vec3& position);

/// A place of the common outline, in order along the reference side's.
struct Knot {
  double along = 0.0;
  core::Vec3 position;
  std::uint32_t of_reference = ~0U, of_conforming = ~0U;  ///< vertices
};

/// Two cut parts on their way to a common outline, and what changed so far.
struct OutlineStitching {
  CutPart &reference, &conforming;
  double tolerance;                               ///< of the contact, mm
  std::map<std::uint32_t, std::uint32_t> merged;  ///< vertices of the conforming side, and what they become
  double moved = 0.0;                             ///< how far one of them went at most, mm
};

/// One outline in the place of the conforming side's and the reference side's, which runs the other way
/// round: moves the conforming side's corners onto the reference side's outline, and cuts edges of both parts
/// where the other has a corner. Nothing where the two run further apart than twice the tolerance, or their
/// corners come in another order.
[[nodiscard]] std::optional<std::vector<Knot>> stitch_outlines(OutlineStitching& parts,
                                                               const Loop& reference_loop,
                                                               const Loop& conforming_loop);

/// Which outline of the reference side each of the conforming side's runs along; nothing when they are no
/// pairs.
[[nodiscard]] std::optional<std::vector<std::size_t>> outline_pairs(const CutPart& reference,
                                                                    const CutPart& conforming);

}  // namespace scintray::contact
