#include "scintray/contact/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/contact/detail/boolean_difference.hpp"
#include "scintray/contact/detail/facing.hpp"
#include "scintray/contact/detail/stitch.hpp"
#include "scintray/core/activity.hpp"
#include "scintray/mesh/diagnose_in_place.hpp"

namespace scintray::contact {

namespace {

/// One contact: `reference` keeps its shape and `conforming` adopts it.
class Conformer {
 public:
  Conformer(const PlacedMesh& reference, PlacedMesh& conforming, double tolerance, double flat_mm)
      : reference_(reference),
        conforming_(conforming),
        tolerance_(tolerance),
        flat_(flat_mm),
        reference_body_(geometry_of(reference), Eigen::Matrix3d::Identity()),
        conforming_body_(geometry_of(conforming), Eigen::Matrix3d::Identity()),
        facing_(facing(conforming_body_, reference_body_, tolerance, flat_mm)) {}

  bool faces() const { return count(Facing::covered) > 0 || count(Facing::partly) > 0; }
  bool covered() const { return count(Facing::covered) > 0 && count(Facing::partly) == 0; }
  /// Middle of the first triangle that lies partly within the tolerance.
  core::Vec3 partly_at() const {
    const auto found = std::find(facing_.begin(), facing_.end(), Facing::partly);
    return mesh::centre_of(conforming_.mesh, static_cast<std::size_t>(found - facing_.begin()));
  }

  /// Changes the conforming side. Returns the reason of a failure, empty on success.
  std::string conform(const Eigen::Matrix3d& axes) {
    constexpr double kPush = 2.0;  // in tolerances: beyond the deepest sliver, with a margin
    std::vector<char> contact;
    for (const Facing f : facing_) contact.push_back(f == Facing::covered);
    const mesh::TriMesh grown = pushed(conforming_.mesh, conforming_body_, contact, kPush * tolerance_);
    const mesh::TriMesh tool = pushed(reference_.mesh, reference_body_, flush_ends(), kPush * tolerance_);
    const auto cut = difference_on_grid(grown, tool, axes, flat_);
    if (!cut) return "the result would not be a proper solid";
    std::vector<std::uint32_t> face_of;
    double moved = 0.0;
    for (std::uint32_t t = 0; t < cut->origin.size(); ++t) {
      const mesh::TriangleOrigin& origin = cut->origin[t];
      if (!origin.of_second && contact[origin.triangle])
        return "\"" + reference_.name + "\" is too thin there for this tolerance";
      std::uint32_t own = origin.triangle;
      if (origin.of_second) {
        const Nearest replaced = replaced_by(cut->mesh, t);
        if (!replaced.found()) return "its face would move by more than twice the tolerance";
        moved = std::max(moved, replaced.distance);
        own = replaced.triangle;
      }
      face_of.push_back(conforming_.face_of[own]);
    }
    const mesh::MeshDiagnosis diagnosis = mesh::diagnose_in_place(cut->mesh);
    const auto unsound = mesh::mesh_problems(diagnosis, conforming_.name);
    if (!unsound.empty()) return "afterwards " + unsound.front().what;
    conforming_.notes.push_back(fmt::format(
        "took the shape of \"{}\" where they touch within {:.4g} mm: {} triangles in place of {}, moved by "
        "up to "
        "{:.2g} mm, volume {:.8g} instead of {:.8g} mm3",
        reference_.name, tolerance_,
        std::count_if(cut->origin.begin(), cut->origin.end(), [](const auto& o) { return o.of_second; }),
        count(Facing::covered), moved, diagnosis.volume_mm3, conforming_.diagnosis.volume_mm3));
    conforming_.mesh = cut->mesh;
    conforming_.face_of = std::move(face_of);
    conforming_.diagnosis = diagnosis;
    return {};
  }

 private:
  std::ptrdiff_t count(Facing what) const { return std::count(facing_.begin(), facing_.end(), what); }

  /// Triangles of the reference side that lie in one surface with triangles of the conforming side: pushed
  /// outwards, the cut does not graze those.
  std::vector<char> flush_ends() const {
    std::vector<char> flush(reference_body_.triangles.size(), 0);
    for (std::uint32_t t = 0; t < flush.size(); ++t)
      for (const core::Vec3& point : samples_of(reference_body_, t))
        flush[t] |= nearest(conforming_body_, point, reference_body_.normal[t], false, tolerance_).found();
    return flush;
  }

  /// The conforming side's own triangle that a new one replaces, and the distance of the new one from the
  /// conforming side's surface.
  Nearest replaced_by(const mesh::TriMesh& mesh, std::uint32_t t) const {
    const core::Vec3 normal = mesh.area_vector(t).normalized();
    const auto beside = [&](const core::Vec3& point) {
      return nearest(conforming_body_, point, normal, false, 2.0 * tolerance_);
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

  const PlacedMesh& reference_;
  PlacedMesh& conforming_;
  double tolerance_, flat_;
  Body reference_body_, conforming_body_;
  std::vector<Facing> facing_;  ///< of the conforming side's triangles
};

void conform(PlacedMesh& first, PlacedMesh& second, const ConformingContact& spec,
             const Eigen::Matrix3d& axes, double flat_mm, core::Problems& problems) {
  const double tolerance = spec.tolerance_mm;
  const auto refuse = [&](const std::string& why, const std::string& hint, const core::Vec3& at) {
    problems.add(
        spec.where,
        fmt::format("the contact of \"{}\" and \"{}\" cannot be closed within {:.4g} mm: {}{}{}", first.name,
                    second.name, tolerance, why, also_at(first.name, first.where, spec.where),
                    also_at(second.name, second.where, spec.where)),
        hint, {{at.x(), at.y(), at.z()}});
  };
  const core::Vec3 between = first.diagnosis.bounds.intersection(second.diagnosis.bounds).center();
  Conformer onto_first(first, second, tolerance, flat_mm), onto_second(second, first, tolerance, flat_mm);
  if (!onto_first.faces() && !onto_second.faces())
    return refuse("no faces of theirs face each other that closely",
                  "raise the tolerance, or remove it for flat faces", between);
  Conformer* chosen = onto_first.covered() ? &onto_first : &onto_second;
  if (!chosen->covered()) {
    const core::Vec3 at = onto_first.partly_at();
    const std::string why = stitch(first, second, tolerance, flat_mm, axes);
    if (!why.empty())
      refuse("on either part a triangle lies partly within the tolerance and partly beyond it, and " + why,
             "raise the tolerance; or, where each part's face ends within the other's, cut one of the faces "
             "with an edge where the other ends",
             at);
    return;
  }
  const std::string why = chosen->conform(axes);
  if (!why.empty())
    refuse(why, "make both parts with the same tessellation, or change the tolerance", between);
}

}  // namespace

void conform_contacts(std::vector<PlacedMesh>& parts, const std::vector<ConformingContact>& contacts,
                      double flat_mm, core::Problems& problems) {
  for (const ConformingContact& spec : contacts) {
    const auto named = [&](const std::string& name) {
      return std::find_if(parts.begin(), parts.end(),
                          [&](const PlacedMesh& part) { return part.name == name; });
    };
    const auto first = named(spec.first), second = named(spec.second);
    if (first == parts.end() || second == parts.end()) continue;  // reported where names are looked up
    core::report_activity("closing curved contacts: " + spec.first + ", " + spec.second);
    conform(*first, *second, spec, difference_axes({*first, *second}), flat_mm, problems);
  }
}

}  // namespace scintray::contact
