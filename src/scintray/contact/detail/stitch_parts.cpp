#include "scintray/contact/detail/stitch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "scintray/contact/detail/facing.hpp"
#include "scintray/mesh/degenerate.hpp"
#include "scintray/mesh/diagnose_in_place.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::contact {

namespace {

/// Triangles of the conforming side outside the contact, with merged vertices; those that collapse are
/// removed.
CutPart without_contact(const CutPart& conforming, const std::map<std::uint32_t, std::uint32_t>& merged) {
  CutPart rest;
  rest.mesh.vertices = conforming.mesh.vertices;
  rest.mesh.groups = conforming.mesh.groups;
  rest.mesh.group_tags = conforming.mesh.group_tags;
  for (std::size_t t = 0; t < conforming.mesh.triangles.size(); ++t) {
    if (conforming.contact[t]) continue;
    auto triangle = conforming.mesh.triangles[t];
    for (std::uint32_t& v : triangle)
      if (const auto other = merged.find(v); other != merged.end()) v = other->second;
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    rest.mesh.triangles.push_back(triangle);
    rest.mesh.group.push_back(conforming.mesh.group[t]);
    rest.origin.push_back(conforming.origin[t]);
  }
  return rest;
}

/// The conforming side, the rest of which adopts the contact.
struct ConformingRest {
  const ContactSide& side;
  CutPart cut;
  std::vector<TriangleSource> sources;
  double moved = 0.0;  ///< largest displacement, mm
};

/// Adds the reference side's contact triangles, reversed, to the rest of the conforming side. False
/// when one strays from the conforming side's own surface by more than `reach`.
bool add_contact(const CutPart& reference, const PlacedMesh& reference_part, const std::vector<Knot>& knots,
                 double reach, ConformingRest& rest) {
  std::map<std::uint32_t, std::uint32_t> vertex;  // of the reference side, and the conforming side's
  for (const Knot& knot : knots) vertex[knot.of_reference] = knot.of_conforming;
  for (std::size_t t = 0; t < reference.mesh.triangles.size(); ++t) {
    if (!reference.contact[t]) continue;
    const auto& [a, b, c] = reference.mesh.triangles[t];
    const core::Vec3 normal = -reference.mesh.area_vector(t).normalized();
    const auto beside = [&](const core::Vec3& point) {
      return nearest(rest.side.body, point, normal, false, reach, &rest.side.wall);
    };
    const Nearest own = beside(mesh::centre_of(reference.mesh, t));
    for (const core::Vec3& point :
         samples_of(reference.mesh.vertices[a], reference.mesh.vertices[b], reference.mesh.vertices[c])) {
      const Nearest here = beside(point);
      if (!here.found()) return false;
      rest.moved = std::max(rest.moved, here.distance);
    }
    std::array<std::uint32_t, 3> turned{a, c, b};
    for (std::uint32_t& v : turned) {
      const auto [known, is_new] = vertex.try_emplace(v, 0U);
      if (is_new) known->second = add_vertex(rest.cut.mesh, reference.mesh.vertices[v]);
      v = known->second;
    }
    const std::vector<std::uint32_t>& groups = rest.side.part.mesh.group;
    rest.cut.mesh.triangles.push_back(turned);
    rest.cut.mesh.group.push_back(groups.empty() ? 0 : groups[own.triangle]);
    rest.cut.origin.push_back(own.triangle);
    rest.sources.push_back({own.triangle, true, surface_of(reference_part.mesh, reference.origin[t])});
  }
  return true;
}

/// Removes triangles whose corners lie on one edge of the outline.
void remove_flat_triangles(CutPart& cut) {
  const std::vector<mesh::SupportSurface> supports = cut.mesh.supports;
  const std::vector<std::uint32_t> support = cut.mesh.support;
  Eigen::AlignedBox3d box;
  for (const core::Vec3& v : cut.mesh.vertices) box.extend(v);
  const std::vector<std::uint32_t> group = cut.mesh.group, origin = cut.origin;
  std::iota(cut.mesh.group.begin(), cut.mesh.group.end(), 0U);
  // What diagnose() treats as rounding, and a little more.
  mesh::remove_degenerate(cut.mesh, 1.01 * std::ldexp(0.5 * box.sizes().maxCoeff(), -22));
  cut.origin.clear();
  cut.mesh.support.clear();
  cut.mesh.supports = supports;
  for (std::uint32_t& number : cut.mesh.group) {
    cut.origin.push_back(origin[number]);
    if (!support.empty()) cut.mesh.support.push_back(support[number]);
    number = group[number];
  }
}

/// The part with another mesh, or the reason why that is not a sound part.
std::string replace_mesh(PlacedMesh& part, CutPart cut) {
  mesh::drop_unused_vertices(cut.mesh);
  remove_flat_triangles(cut);
  const mesh::MeshDiagnosis diagnosis = mesh::diagnose_in_place(cut.mesh);
  const auto unsound = mesh::mesh_problems(diagnosis, part.name);
  if (!unsound.empty()) return "afterwards " + unsound.front().what;
  std::vector<std::uint32_t> face_of;
  for (const std::uint32_t own : cut.origin) face_of.push_back(part.face_of[own]);
  part.mesh = std::move(cut.mesh);
  part.face_of = std::move(face_of);
  part.diagnosis = diagnosis;
  return {};
}

}  // namespace

std::string stitch(PlacedMesh& reference, PlacedMesh& conforming, const ContactRule& rule,
                   const Eigen::Matrix3d& axes) {
  const double tolerance = rule.reach.tolerance;
  const ContactSide reference_side = contact_side(reference, conforming, rule, true),
                    conforming_side = contact_side(conforming, reference, rule, false);
  auto reference_cut = cut_at_contact(reference_side, conforming_side, rule.reach, axes),
       conforming_cut = cut_at_contact(conforming_side, reference_side, rule.reach, axes);
  if (!reference_cut || !conforming_cut) return "their contact has no simple outline";
  const auto pairs = outline_pairs(*reference_cut, *conforming_cut);
  if (!pairs) return "the outlines of their contact do not fit each other";

  OutlineStitching outlines{*reference_cut, *conforming_cut, tolerance, {}};
  std::vector<Knot> knots;
  const std::vector<Loop> reference_loops = reference_cut->outlines,
                          conforming_loops = conforming_cut->outlines;
  for (std::size_t i = 0; i < pairs->size(); ++i) {
    const auto joined = stitch_outlines(outlines, reference_loops[(*pairs)[i]], conforming_loops[i]);
    if (!joined) return "the outlines of their contact run too far apart";
    knots.insert(knots.end(), joined->begin(), joined->end());
  }
  ConformingRest rest{conforming_side, without_contact(*conforming_cut, outlines.merged), {}, outlines.moved};
  for (const std::uint32_t own : rest.cut.origin) rest.sources.push_back({own, false});
  if (!add_contact(*reference_cut, reference, knots, kContactPush * tolerance, rest))
    return "a face would move by more than twice the tolerance";
  keep_own_supports(conforming.mesh, rest.sources, rule.reach.flat, rest.cut.mesh);
  std::vector<TriangleSource> own_pieces;
  for (const std::uint32_t own : reference_cut->origin) own_pieces.push_back({own, false});
  keep_own_supports(reference.mesh, own_pieces, rule.reach.flat, reference_cut->mesh);

  PlacedMesh new_reference = reference, new_conforming = conforming;
  for (const std::string& why : {replace_mesh(new_reference, std::move(*reference_cut)),
                                 replace_mesh(new_conforming, std::move(rest.cut))})
    if (!why.empty()) return why;
  new_conforming.notes.push_back(
      rule.is_wall() ? fmt::format("took the facets of \"{}\" where each ends on the round wall of the other",
                                   reference.name)
                     : fmt::format("stitched to \"{}\" where they touch within {:.4g} mm and each ends "
                                   "within the other: moved by "
                                   "up to {:.2g} mm, volume {:.8g} instead of {:.8g} mm3",
                                   reference.name, tolerance, rest.moved, new_conforming.diagnosis.volume_mm3,
                                   conforming.diagnosis.volume_mm3));
  reference = std::move(new_reference);
  conforming = std::move(new_conforming);
  return {};
}

}  // namespace scintray::contact
