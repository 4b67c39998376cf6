#include "scintray/contact/detail/conformer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/contact/detail/boolean_difference.hpp"
#include "scintray/mesh/diagnose_in_place.hpp"

namespace scintray::contact {

const mesh::SupportSurface* surface_of(const mesh::TriMesh& mesh, std::uint32_t triangle) {
  const std::uint32_t support = mesh.support_of(triangle);
  return support == mesh::kNoSupport ? nullptr : &mesh.supports[support];
}

void keep_own_supports(const mesh::TriMesh& before, const std::vector<TriangleSource>& sources,
                       double tolerance_mm, mesh::TriMesh& after) {
  after.supports.clear();
  after.support.clear();
  if (before.supports.empty()) return;
  for (std::uint32_t t = 0; t < sources.size(); ++t) {
    const mesh::SupportSurface* const own = surface_of(before, sources[t].own);
    if (sources[t].adopted) {
      const mesh::SupportSurface* const other = sources[t].surface;
      const auto& [a, b, c] = after.triangles[t];
      const bool one_surface =
          own == nullptr || other == nullptr
              ? own == other
              : own->agrees_with(*other, {after.vertices[a], after.vertices[b], after.vertices[c]},
                                 tolerance_mm);
      if (!one_surface) return after.support.clear();
    }
    after.support.push_back(before.support_of(sources[t].own));
  }
  after.supports = before.supports;
}

Conformer::Conformer(const PlacedMesh& reference, PlacedMesh& conforming, ContactRule rule)
    : reference_(reference),
      conforming_(conforming),
      rule_(std::move(rule)),
      reference_body_(geometry_of(reference), Eigen::Matrix3d::Identity()),
      conforming_body_(geometry_of(conforming), Eigen::Matrix3d::Identity()),
      facing_(facing(conforming_body_, reference_body_, rule_.reach,
                     {rule_.wall_of_conforming, rule_.wall_of_reference})) {}

core::Vec3 Conformer::partly_at() const {
  const auto found = std::find(facing_.begin(), facing_.end(), Facing::partly);
  return mesh::centre_of(conforming_.mesh, static_cast<std::size_t>(found - facing_.begin()));
}

std::string Conformer::conform(const Eigen::Matrix3d& axes) {
  constexpr double kPush = 2.0;  // in tolerances: beyond the deepest sliver, with a margin
  const double push = kPush * rule_.reach.tolerance;
  std::vector<char> contact;
  for (const Facing f : facing_) contact.push_back(f == Facing::covered);
  const mesh::TriMesh grown = pushed(conforming_.mesh, conforming_body_, contact, push);
  const mesh::TriMesh tool = pushed(reference_.mesh, reference_body_, flush_ends(), push);
  auto cut = difference_on_grid(grown, tool, axes, rule_.reach.flat);
  if (!cut) return "the result would not be a proper solid";
  std::vector<std::uint32_t> face_of;
  std::vector<TriangleSource> sources;
  double moved = 0.0;
  for (std::uint32_t t = 0; t < cut->origin.size(); ++t) {
    const mesh::TriangleOrigin& origin = cut->origin[t];
    if (!origin.of_second && contact[origin.triangle])
      return "\"" + reference_.name + "\" is too thin there for this tolerance";
    TriangleSource source{origin.triangle, origin.of_second};
    if (origin.of_second) {
      const Nearest replaced = replaced_by(cut->mesh, t);
      if (!replaced.found()) return "its face would move by more than twice the tolerance";
      moved = std::max(moved, replaced.distance);
      source.own = replaced.triangle;
      source.surface = surface_of(reference_.mesh, origin.triangle);
    }
    sources.push_back(source);
    face_of.push_back(conforming_.face_of[source.own]);
  }
  keep_own_supports(conforming_.mesh, sources, rule_.reach.flat, cut->mesh);
  const mesh::MeshDiagnosis diagnosis = mesh::diagnose_in_place(cut->mesh);
  const auto unsound = mesh::mesh_problems(diagnosis, conforming_.name);
  if (!unsound.empty()) return "afterwards " + unsound.front().what;
  conforming_.notes.push_back(note(*cut, moved, diagnosis));
  conforming_.mesh = std::move(cut->mesh);
  conforming_.face_of = std::move(face_of);
  conforming_.diagnosis = diagnosis;
  return {};
}

std::string Conformer::note(const mesh::BooleanResult& cut, double moved,
                            const mesh::MeshDiagnosis& after) const {
  const auto adopted =
      std::count_if(cut.origin.begin(), cut.origin.end(), [](const auto& o) { return o.of_second; });
  if (rule_.is_wall())
    return fmt::format("took the facets of \"{}\" on their common round wall: {} triangles in place of {}",
                       reference_.name, adopted, count(Facing::covered));
  return fmt::format(
      "took the shape of \"{}\" where they touch within {:.4g} mm: {} triangles in place of {}, moved by "
      "up to "
      "{:.2g} mm, volume {:.8g} instead of {:.8g} mm3",
      reference_.name, rule_.reach.tolerance, adopted, count(Facing::covered), moved, after.volume_mm3,
      conforming_.diagnosis.volume_mm3);
}

/// Triangles of the reference side that lie in one surface with triangles of the conforming side: pushed
/// outwards, the cut does not graze those.
std::vector<char> Conformer::flush_ends() const {
  const double reach = rule_.is_wall() ? rule_.reach.flat : rule_.reach.tolerance;
  std::vector<char> flush(reference_body_.triangles.size(), 0);
  for (std::uint32_t t = 0; t < flush.size(); ++t)
    for (const core::Vec3& point : samples_of(reference_body_, t))
      flush[t] |= nearest(conforming_body_, point, reference_body_.normal[t], false, reach).found();
  return flush;
}

/// The conforming side's own triangle that a new one replaces, and the distance of the new one from the
/// conforming side's surface.
Nearest Conformer::replaced_by(const mesh::TriMesh& mesh, std::uint32_t t) const {
  const core::Vec3 normal = mesh.area_vector(t).normalized();
  const auto beside = [&](const core::Vec3& point) {
    return nearest(conforming_body_, point, normal, false, 2.0 * rule_.reach.tolerance,
                   &rule_.wall_of_conforming);
  };
  Nearest replaced = beside(mesh::centre_of(mesh, t));
  const auto& [a, b, c] = mesh.triangles[t];
  for (const core::Vec3& point : samples_of(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])) {
    const Nearest here = beside(point);
    if (!here.found()) return {};
    replaced.distance = std::max(replaced.distance, here.distance);
  }
  return replaced;
}

}  // namespace scintray::contact
