#include "scintray/contact/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "scintray/contact/detail/boolean_difference.hpp"
#include "scintray/contact/detail/nesting.hpp"
#include "scintray/core/activity.hpp"
#include "scintray/mesh/diagnose_in_place.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

namespace scintray::contact {

namespace {

/// A part, and parts of higher priority that share volume with it and are apart from each other.
struct Cut {
  std::uint32_t part = 0;
  std::vector<std::uint32_t> by;
};

/// Adds a cutter to the first cut whose cutters are all apart from it, or starts a new one.
void add_cutter(std::uint32_t part, std::uint32_t by, const std::vector<PlacedMesh>& parts,
                double tolerance_mm, std::vector<Cut>& cuts) {
  Eigen::AlignedBox3d around = parts[by].diagnosis.bounds;
  around.min().array() -= tolerance_mm;
  around.max().array() += tolerance_mm;
  const auto is_free = [&](const Cut& cut) {
    return std::none_of(cut.by.begin(), cut.by.end(), [&](std::uint32_t other) {
      return around.intersects(parts[other].diagnosis.bounds);
    });
  };
  const auto found = std::find_if(cuts.begin(), cuts.end(), is_free);
  if (found != cuts.end())
    found->by.push_back(by);
  else
    cuts.push_back({part, {by}});
}

/// All cuts; parts of higher priority come first, so that they have their final shape when they cut.
std::vector<Cut> find_cuts(const std::vector<PlacedMesh>& parts, const Eigen::Matrix3d& axes,
                           double tolerance_mm) {
  std::vector<Body> bodies;
  for (const PlacedMesh& part : parts) bodies.emplace_back(geometry_of(part), axes);
  std::vector<BodyPair> pairs = near_pairs(bodies, tolerance_mm);
  std::erase_if(pairs,
                [&](const BodyPair& pair) { return parts[pair.a].priority == parts[pair.b].priority; });
  std::map<std::uint32_t, std::vector<Cut>> cuts_of;
  for (const auto& [a, b] : find_nesting(bodies, pairs, tolerance_mm).overlaps) {
    const bool a_is_cut = parts[a].priority < parts[b].priority;
    const std::uint32_t part = a_is_cut ? a : b;
    add_cutter(part, a_is_cut ? b : a, parts, tolerance_mm, cuts_of[part]);
  }
  std::vector<Cut> cuts;
  for (auto& [part, own] : cuts_of) cuts.insert(cuts.end(), own.begin(), own.end());
  std::stable_sort(cuts.begin(), cuts.end(), [&](const Cut& x, const Cut& y) {
    return parts[x.part].priority > parts[y.part].priority;
  });
  return cuts;
}

/// The face of the part that `by` made by cutting.
std::uint32_t cut_face(PlacedMesh& part, const PlacedMesh& by) {
  part.faces.push_back({kCutFaces + by.name, part.surface, {}});
  return static_cast<std::uint32_t>(part.faces.size() - 1);
}

/// True when the difference is a solid that a part can be.
bool can_cut(const PlacedMesh& part, const mesh::TriMesh& tool, const Eigen::Matrix3d& axes,
             double tolerance_mm) {
  const auto cut = difference_on_grid(part.mesh, tool, axes, tolerance_mm);
  return cut && !cut->mesh.triangles.empty() &&
         mesh::mesh_problems(mesh::diagnose_in_place(cut->mesh), part.name).empty();
}

/// The smallest change of the part that cuts, of those tried, with which the cut succeeds: where solids are
/// tangent, or their facets cross at small angles, what is left has edges without thickness.
std::string change_that_helps(const PlacedMesh& part, const PlacedMesh& by, const Eigen::Matrix3d& axes,
                              double tolerance_mm) {
  const Eigen::AlignedBox3d& box = by.diagnosis.bounds;
  const double half_size = 0.5 * box.sizes().minCoeff();
  constexpr std::size_t kMostTriangles = 100'000;
  if (part.mesh.triangles.size() + by.mesh.triangles.size() > kMostTriangles || !(half_size > 0.0)) return "";
  for (const double factor : {10.0, 30.0, 100.0, 300.0, 1000.0}) {
    const double step = factor * tolerance_mm;
    if (step > 0.2 * half_size) break;
    for (const double sign : {1.0, -1.0}) {
      const double scale = 1.0 + sign * step / half_size;
      const Eigen::Affine3d sized = Eigen::Translation3d(box.center()) * Eigen::Scaling(scale) *
                                    Eigen::Translation3d(core::Vec3(-box.center()));
      if (can_cut(part, mesh::transformed(by.mesh, sized), axes, tolerance_mm))
        return fmt::format(
            "the cut succeeds when \"{}\" is {:.3g} mm {} in radius, or half its smallest side: change its "
            "radius or sides so, or the scale of its mesh to {:.6g} of what it is",
            by.name, step, sign > 0.0 ? "larger" : "smaller", scale);
      for (int axis = 0; axis < 3; ++axis) {
        core::Vec3 shift = core::Vec3::Zero();
        shift[axis] = sign * step;
        mesh::TriMesh moved = by.mesh;
        mesh::translate(moved, shift);
        if (can_cut(part, moved, axes, tolerance_mm))
          return fmt::format(
              "the cut succeeds when \"{}\" is moved by {:+.3g} mm along {}: add that to its translate, or "
              "to the "
              "places in its shape",
              by.name, sign * step, "xyz"[axis]);
      }
    }
  }
  return "";
}

/// Parts that cut, as one mesh without groups and supports.
struct Cutters {
  std::vector<const PlacedMesh*> parts;
  mesh::TriMesh mesh;
  struct Triangle {
    std::uint32_t part, triangle;  ///< in `parts`, and of its mesh
  };
  std::vector<Triangle> triangles;  ///< per triangle of the mesh

  void add(const PlacedMesh& part) {
    const auto number = static_cast<std::uint32_t>(parts.size()),
               first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.mesh.vertices.begin(), part.mesh.vertices.end());
    for (std::uint32_t i = 0; i < part.mesh.triangles.size(); ++i) {
      const auto& [a, b, c] = part.mesh.triangles[i];
      mesh.triangles.push_back({first + a, first + b, first + c});
      triangles.push_back({number, i});
    }
    parts.push_back(&part);
  }
};

/// Assigns to the triangles left by a cut the support surfaces of those that they are pieces of.
void keep_supports(const std::vector<mesh::TriangleOrigin>& origins, const mesh::TriMesh& of,
                   const Cutters& by, mesh::TriMesh& left) {
  left.supports.clear();
  left.support.clear();
  if (of.supports.empty() && std::all_of(by.parts.begin(), by.parts.end(),
                                         [](const PlacedMesh* part) { return part->mesh.supports.empty(); }))
    return;
  std::map<std::pair<const mesh::TriMesh*, std::uint32_t>, std::uint32_t> known;
  for (const mesh::TriangleOrigin& origin : origins) {
    const mesh::TriMesh* from = &of;
    std::uint32_t triangle = origin.triangle;
    if (origin.of_second) {
      const Cutters::Triangle cutter = by.triangles[triangle];
      from = &by.parts[cutter.part]->mesh;
      triangle = cutter.triangle;
    }
    const std::uint32_t support = from->support_of(triangle);
    const auto [at, is_new] = known.try_emplace({from, support}, mesh::kNoSupport);
    if (is_new && support != mesh::kNoSupport) at->second = left.support_index(from->supports[support]);
    left.support.push_back(at->second);
  }
}

void take_what_is_left(PlacedMesh& part, const Cutters& by, const mesh::BooleanResult& cut,
                       const mesh::MeshDiagnosis& diagnosis) {
  std::vector<std::uint32_t> cut_faces;
  for (const PlacedMesh* one : by.parts) cut_faces.push_back(cut_face(part, *one));
  std::vector<std::uint32_t> face_of;
  for (const mesh::TriangleOrigin& origin : cut.origin)
    face_of.push_back(origin.of_second ? cut_faces[by.triangles[origin.triangle].part]
                                       : part.face_of[origin.triangle]);
  const std::size_t others = by.parts.size() - 1;
  part.notes.push_back(fmt::format("cut by \"{}\"{} of higher priority: {:.6g} of {:.6g} mm3 left",
                                   by.parts.front()->name,
                                   others > 0 ? fmt::format(" and {} more", others) : "",
                                   diagnosis.volume_mm3, part.diagnosis.volume_mm3));
  mesh::TriMesh left = cut.mesh;
  keep_supports(cut.origin, part.mesh, by, left);
  part.mesh = std::move(left);
  part.face_of = std::move(face_of);
  part.diagnosis = diagnosis;
}

void cut(PlacedMesh& part, const PlacedMesh& by, const Eigen::Matrix3d& axes, double tolerance_mm,
         core::Problems& problems) {
  const auto refuse = [&](const std::string& why, const std::string& hint) {
    const core::Vec3 at = part.diagnosis.bounds.intersection(by.diagnosis.bounds).center();
    problems.add(
        part.where,
        fmt::format("part \"{}\" (priority {}) cannot be cut by \"{}\" (priority {}): {}{}", part.name,
                    part.priority, by.name, by.priority, why, also_at(by.name, by.where, part.where)),
        hint, {{at.x(), at.y(), at.z()}});
  };
  const auto cut = difference_on_grid(part.mesh, by.mesh, axes, tolerance_mm);
  const auto advice = [&] {
    const std::string change = change_that_helps(part, by, axes, tolerance_mm);
    return "the parts are tangent, or their triangles cross at angles too small for this tolerance: " +
           (change.empty() ? "give one of the round parts other sides, as segments = 48 in place of 64 or a "
                             "tessellation deviation smaller by a fifth"
                           : change);
  };
  if (!cut) return refuse("the result would not be a proper solid", advice());
  if (cut->mesh.triangles.empty())
    return refuse("nothing of it would be left", "remove the part, or change the priorities");
  if (part.surface.empty() && part.needs_surface)
    return refuse("the faces made by the cut have no surface", "give the part a surface = \"...\"");
  const mesh::MeshDiagnosis diagnosis = mesh::diagnose_in_place(cut->mesh);
  const auto unsound = mesh::mesh_problems(diagnosis, part.name);
  if (!unsound.empty()) return refuse("afterwards " + unsound.front().what, advice());

  Cutters cutters;
  cutters.add(by);
  take_what_is_left(part, cutters, *cut, diagnosis);
}

/// Cuts a part by several at once, which takes a fraction of the time of one after another.
/// @return false when the result is no part: the part is as before
bool cut_at_once(PlacedMesh& part, const Cutters& by, const Eigen::Matrix3d& axes, double tolerance_mm) {
  if (part.surface.empty() && part.needs_surface) return false;
  const auto cut = difference_on_grid(part.mesh, by.mesh, axes, tolerance_mm);
  if (!cut || cut->mesh.triangles.empty()) return false;
  const mesh::MeshDiagnosis diagnosis = mesh::diagnose_in_place(cut->mesh);
  if (!mesh::mesh_problems(diagnosis, part.name).empty()) return false;
  take_what_is_left(part, by, *cut, diagnosis);
  return true;
}

/// Cuts a part by several; where they cannot cut it together, by each half of them, down to the one that
/// cannot.
void cut_by_all(PlacedMesh& part, const std::vector<const PlacedMesh*>& by, const Eigen::Matrix3d& axes,
                double tolerance_mm, core::Problems& problems) {
  if (by.size() == 1) return cut(part, *by.front(), axes, tolerance_mm, problems);
  Cutters cutters;
  for (const PlacedMesh* one : by) cutters.add(*one);
  if (cut_at_once(part, cutters, axes, tolerance_mm)) return;
  const auto middle = by.begin() + static_cast<std::ptrdiff_t>(by.size() / 2);
  cut_by_all(part, {by.begin(), middle}, axes, tolerance_mm, problems);
  cut_by_all(part, {middle, by.end()}, axes, tolerance_mm, problems);
}

}  // namespace

void cut_overlaps(std::vector<PlacedMesh>& parts, double tolerance_mm, core::Problems& problems) {
  const bool equal = std::all_of(parts.begin(), parts.end(), [&](const PlacedMesh& part) {
    return part.priority == parts.front().priority;
  });
  if (equal) return;
  const Eigen::Matrix3d axes = difference_axes(parts);
  core::report_activity("looking for parts to cut");
  const std::vector<Cut> cuts = find_cuts(parts, axes, tolerance_mm);
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    core::report_activity("cutting parts: " + parts[cuts[i].part].name, i, cuts.size());
    std::vector<const PlacedMesh*> by;
    for (const std::uint32_t one : cuts[i].by) by.push_back(&parts[one]);
    cut_by_all(parts[cuts[i].part], by, axes, tolerance_mm, problems);
  }
}

}  // namespace scintray::contact
