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

/// Adds the reference side's contact triangles, reversed, to the rest of the conforming side. False
/// when one strays from the conforming side's own surface by more than `reach`.
bool add_contact(const CutPart& reference, const ContactSide& conforming, const std::vector<Knot>& knots,
                 double reach, CutPart& rest, double& moved) {
  std::map<std::uint32_t, std::uint32_t> vertex;  // of the reference side, and the conforming side's
  for (const Knot& knot : knots) vertex[knot.of_reference] = knot.of_conforming;
  for (std::size_t t = 0; t < reference.mesh.triangles.size(); ++t) {
    if (!reference.contact[t]) continue;
    const auto& [a, b, c] = reference.mesh.triangles[t];
    const core::Vec3 normal = -reference.mesh.area_vector(t).normalized();
    const auto beside = [&](const core::Vec3& point) {
      return nearest(conforming.body, point, normal, false, reach);
    };
    const Nearest own = beside(mesh::centre_of(reference.mesh, t));
    for (const core::Vec3& point :
         samples_of(reference.mesh.vertices[a], reference.mesh.vertices[b], reference.mesh.vertices[c])) {
      const Nearest here = beside(point);
      if (!here.found()) return false;
      moved = std::max(moved, here.distance);
    }
    std::array<std::uint32_t, 3> turned{a, c, b};
    for (std::uint32_t& v : turned) {
      const auto [known, is_new] = vertex.try_emplace(v, 0U);
      if (is_new) known->second = add_vertex(rest.mesh, reference.mesh.vertices[v]);
      v = known->second;
    }
    rest.mesh.triangles.push_back(turned);
    rest.mesh.group.push_back(conforming.part.mesh.group.empty() ? 0
                                                                 : conforming.part.mesh.group[own.triangle]);
    rest.origin.push_back(own.triangle);
  }
  return true;
}

/// Removes triangles whose corners lie on one edge of the outline.
void remove_flat_triangles(CutPart& cut) {
  Eigen::AlignedBox3d box;
  for (const core::Vec3& v : cut.mesh.vertices) box.extend(v);
  const std::vector<std::uint32_t> group = cut.mesh.group, origin = cut.origin;
  std::iota(cut.mesh.group.begin(), cut.mesh.group.end(), 0U);
  // What diagnose() treats as rounding, and a little more.
  mesh::remove_degenerate(cut.mesh, 1.01 * std::ldexp(0.5 * box.sizes().maxCoeff(), -22));
  cut.origin.clear();
  for (std::uint32_t& number : cut.mesh.group) {
    cut.origin.push_back(origin[number]);
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

std::string stitch(PlacedMesh& reference, PlacedMesh& conforming, double tolerance_mm, double flat_mm,
                   const Eigen::Matrix3d& axes) {
  const ContactSide reference_side = contact_side(reference, conforming, tolerance_mm, flat_mm),
                    conforming_side = contact_side(conforming, reference, tolerance_mm, flat_mm);
  auto reference_cut = cut_at_contact(reference_side, conforming_side, tolerance_mm, flat_mm, axes),
       conforming_cut = cut_at_contact(conforming_side, reference_side, tolerance_mm, flat_mm, axes);
  if (!reference_cut || !conforming_cut) return "their contact has no simple outline";
  const auto pairs = outline_pairs(*reference_cut, *conforming_cut);
  if (!pairs) return "the outlines of their contact do not fit each other";

  OutlineStitching outlines{*reference_cut, *conforming_cut, tolerance_mm, {}};
  std::vector<Knot> knots;
  const std::vector<Loop> reference_loops = reference_cut->outlines,
                          conforming_loops = conforming_cut->outlines;
  for (std::size_t i = 0; i < pairs->size(); ++i) {
    const auto joined = stitch_outlines(outlines, reference_loops[(*pairs)[i]], conforming_loops[i]);
    if (!joined) return "the outlines of their contact run too far apart";
    knots.insert(knots.end(), joined->begin(), joined->end());
  }
  double moved = outlines.moved;
  CutPart rest = without_contact(*conforming_cut, outlines.merged);
  if (!add_contact(*reference_cut, conforming_side, knots, kContactPush * tolerance_mm, rest, moved))
    return "a face would move by more than twice the tolerance";

  PlacedMesh new_reference = reference, new_conforming = conforming;
  for (const std::string& why : {replace_mesh(new_reference, std::move(*reference_cut)),
                                 replace_mesh(new_conforming, std::move(rest))})
    if (!why.empty()) return why;
  new_conforming.notes.push_back(fmt::format(
      "stitched to \"{}\" where they touch within {:.4g} mm and each ends within the other: moved by up to "
      "{:.2g} mm, volume {:.8g} instead of {:.8g} mm3",
      reference.name, tolerance_mm, moved, new_conforming.diagnosis.volume_mm3,
      conforming.diagnosis.volume_mm3));
  reference = std::move(new_reference);
  conforming = std::move(new_conforming);
  return {};
}

}  // namespace scintray::contact
