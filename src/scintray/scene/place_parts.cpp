#include "scintray/scene/place_parts.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

#include "scintray/core/activity.hpp"
#include "scintray/core/text.hpp"
#include "scintray/mesh/diagnose_in_place.hpp"
#include "scintray/mesh/recognize.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/scene/detail/face_tagger.hpp"
#include "scintray/scene_file/placement.hpp"
#include "scintray/scene_file/shape_files.hpp"

namespace scintray::scene {

namespace {

Eigen::AlignedBox3d bounds_of(const mesh::TriMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const core::Vec3& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

/// Displacement (mm) of a body to a side of another, centred on it laterally.
core::Vec3 shift_against(const Eigen::AlignedBox3d& own, const Eigen::AlignedBox3d& touched,
                         const scene_file::TouchSpec& touch) {
  core::Vec3 shift = touched.center() - own.center();
  const int axis = touch.side.axis;
  shift[axis] = touch.side.sign > 0 ? touched.max()[axis] + touch.gap_mm - own.min()[axis]
                                    : touched.min()[axis] - touch.gap_mm - own.max()[axis];
  return shift;
}

/// The box between two parts: laterally the intersection of both bounding boxes, in thickness the gap.
std::optional<Eigen::AlignedBox3d> gap_between(const Eigen::AlignedBox3d& touched,
                                               const Eigen::AlignedBox3d& own,
                                               const scene_file::TouchSpec& touch) {
  core::Vec3 low = touched.min().cwiseMax(own.min()), high = touched.max().cwiseMin(own.max());
  const int axis = touch.side.axis;
  low[axis] = touch.side.sign > 0 ? touched.max()[axis] : own.max()[axis];
  high[axis] = touch.side.sign > 0 ? own.min()[axis] : touched.min()[axis];
  if ((low.array() >= high.array()).any()) return std::nullopt;
  return Eigen::AlignedBox3d(low, high);
}

/// Adds every problem at its place, or at the shape when it has none.
void add_problems(const std::vector<core::Problem>& found, const scene_file::PartSpec& part,
                  core::Problems& problems) {
  for (core::Problem problem : found) {
    if (problem.where.file.empty()) problem.where = scene_file::shape_location(part.shape);
    problems.add(std::move(problem));
  }
}

class PartPlacer {
 public:
  PartPlacer(const scene_file::SceneSpec& spec, core::Problems& problems, const mesh::MeshFormats& formats)
      : spec_(spec), formats_(formats), problems_(problems) {
    for (const scene_file::PartSpec& part : spec.parts)
      if (const auto* file = std::get_if<scene_file::MeshFileSpec>(&part.shape)) files_.announce(file->path);
  }

  std::vector<contact::PlacedMesh> place_all() {
    auto group = spec_.groups.begin();
    for (std::size_t i = 0; i < spec_.parts.size();) {
      const bool starts_group = group != spec_.groups.end() && group->first == i;
      const std::size_t count = starts_group ? group->count : 1;
      const scene_file::PartSpec* parts = &spec_.parts[i];
      core::report_activity("placing parts: " + (starts_group ? group->name.name : parts->name.name), i,
                            spec_.parts.size());
      try {
        if (starts_group)
          place_group(*group, parts);
        else
          place_part(*parts);
      } catch (const core::InputError& error) {
        add_problems(error.problems(), *parts, problems_);
      }
      if (starts_group) ++group;
      i += count;
    }
    tag_touching();
    return std::move(placed_);
  }

 private:
  /// A part in its own frame, rotated only.
  contact::PlacedMesh loaded(const scene_file::PartSpec& part) {
    const bool needs_surface = spec_.contacts_default != scene_file::ContactKind::each_side;
    contact::PlacedMesh result;
    result.name = part.name.name;
    result.where = part.where;
    result.medium = part.medium;
    result.principal_axes = part.principal_axes;
    result.principal_x_given = part.principal_x_given;
    result.sensor = part.sensor;
    result.surface = part.surface;
    result.priority = part.priority;
    result.needs_surface =
        needs_surface && !part.liquid && part.sensor.empty() && part.medium.name != scene_file::kOpaqueMedium;
    scene_file::ShapeMesh shape = scene_file::shape_mesh(part.shape, files_, formats_);
    result.notes = std::move(shape.notes);
    if (mesh::orient_outwards(shape.mesh)) result.notes.push_back("faces turned to point outwards");
    result.mesh = std::move(shape.mesh);
    const auto* file = std::get_if<scene_file::MeshFileSpec>(&part.shape);
    if (file && file->curved == scene_file::RoundFacesOfFile::recognize) recognize(result);
    rotate(result, part.placement);
    return result;
  }

  void recognize(contact::PlacedMesh& part) const {
    const std::vector<mesh::RecognizedFace> found =
        mesh::recognize_round_faces(part.mesh, spec_.run.contact_tolerance_mm);
    for (const mesh::RecognizedFace& face : found) part.notes.push_back(mesh::describe(part.mesh, face));
    if (found.empty())
      part.notes.push_back(
          "no sphere, cylinder, cone or torus recognized: corners are farther than the contact tolerance "
          "from one, or neighbouring facets have angles above 30 degrees");
  }

  static void rotate(contact::PlacedMesh& part, const scene_file::PlacementSpec& placement) {
    if (placement.rotate.empty()) return;
    Eigen::Affine3d turn = Eigen::Affine3d::Identity();
    turn.linear() = scene_file::rotation_of(placement);
    part.mesh = mesh::transformed(part.mesh, turn);
    part.rotation = turn.linear() * part.rotation;
  }

  /// Diagnosis of a part in its final place.
  static void examine(contact::PlacedMesh& placed, const scene_file::PartSpec& part,
                      core::Problems& problems) {
    placed.diagnosis = mesh::diagnose_in_place(placed.mesh);
    if (placed.diagnosis.bodies > 1)
      placed.notes.push_back(std::to_string(placed.diagnosis.bodies) +
                             " separate surfaces in one mesh: bodies or cavities that share the medium and "
                             "the rules of this part");
    add_problems(mesh::mesh_problems(placed.diagnosis, placed.name), part, problems);
  }

  void place_part(const scene_file::PartSpec& part) {
    contact::PlacedMesh result = loaded(part);
    const Against against = lie_against(part.name.name, part.placement, bounds_of(result.mesh));
    mesh::translate(result.mesh, against.shift);
    examine(result, part, problems_);
    if (names_touching(part))
      touching_.emplace_back(&part, placed_.size());
    else
      FaceTagger(part, result, problems_).tag();
    keep(std::move(result));
    if (!against.fill) return;
    contact::PlacedMesh fill = *against.fill;
    fill.priority = part.priority;
    keep(std::move(fill));
  }

  static bool names_touching(const scene_file::PartSpec& part) {
    return std::any_of(part.faces.begin(), part.faces.end(),
                       [](const scene_file::FaceRuleSpec& rule) { return !rule.select.touches.empty(); });
  }

  /// Tags the parts whose faces are selected by what they touch, once all are placed.
  void tag_touching() {
    for (const auto& [part, index] : touching_) {
      const TouchingFaces touching(spec_, placed_, index);
      FaceTagger(*part, placed_[index], problems_, &touching).tag();
    }
  }

  /// Parts are tagged in their own frame, placed in that of the group, and moved with it.
  void place_group(const scene_file::GroupSpec& group, const scene_file::PartSpec* parts) {
    std::vector<contact::PlacedMesh> members;
    Eigen::AlignedBox3d bounds;
    core::Problems found;
    for (std::size_t i = 0; i < group.count && found.empty(); ++i) {
      members.push_back(loaded(parts[i]));
      contact::PlacedMesh& member = members.back();
      refuse_touching(parts[i], found);
      FaceTagger(parts[i], member, found).tag();
      mesh::translate(member.mesh, parts[i].placement.translate);
      rotate(member, group.placement);
      bounds.extend(bounds_of(member.mesh));
    }
    const Against against = lie_against(group.name.name, group.placement, bounds);
    for (std::size_t i = 0; i < members.size() && found.empty(); ++i) {
      mesh::translate(members[i].mesh, against.shift);
      examine(members[i], parts[i], found);
    }
    for (const core::Problem& problem : found.list()) problems_.add(problem);
    for (contact::PlacedMesh& member : members) keep(std::move(member));
    bounds_[group.name.name] = bounds.translated(against.shift);
    if (against.fill) keep(*against.fill);
  }

  static void refuse_touching(const scene_file::PartSpec& part, core::Problems& problems) {
    for (const scene_file::FaceRuleSpec& rule : part.faces)
      if (!rule.select.touches.empty())
        problems.add(
            rule.select.touches.where,
            "\"touches\" selects faces of a [[part]], but this is an element of an array",
            "select by normal or group here; a [[contact]] between the array's elements (\"*\" stands "
            "for any) and the other part sets the surface where they touch");
  }

  void keep(contact::PlacedMesh part) {
    bounds_[part.name] = bounds_of(part.mesh);
    placed_.push_back(std::move(part));
  }

  /// Displacement of a body after its rotation, and the part that fills the gap to the touched part.
  struct Against {
    core::Vec3 shift;
    std::optional<contact::PlacedMesh> fill;
  };

  Against lie_against(const std::string& name, const scene_file::PlacementSpec& placement,
                      const Eigen::AlignedBox3d& own) {
    if (!placement.touch) return {placement.translate, {}};
    const scene_file::TouchSpec& touch = *placement.touch;
    const auto touched = bounds_.find(touch.part.name);
    if (touched == bounds_.end()) {
      problems_.add(touch.part.where,
                    "part \"" + name + "\" is to touch \"" + touch.part.name +
                        "\", which does not stand before it or could not be placed",
                    "move the touched part above this one, and mend its own errors first");
      return {placement.translate, {}};
    }
    const core::Vec3 shift = shift_against(own, touched->second, touch);
    Against result{shift + placement.translate, {}};
    if (touch.fill.empty()) return result;
    const auto box = gap_between(touched->second, own.translated(shift), touch);
    if (!box) {
      problems_.add(touch.fill.where, "there is no gap to fill with \"" + touch.fill.name + "\"",
                    "give a gap of positive thickness, as gap = \"0.1 mm\"");
      return result;
    }
    result.fill = fill_of(name, touch, box->translated(placement.translate));
    return result;
  }

  static contact::PlacedMesh fill_of(const std::string& name, const scene_file::TouchSpec& touch,
                                     const Eigen::AlignedBox3d& box) {
    contact::PlacedMesh fill;
    fill.name = name + scene_file::kFillSuffix;
    fill.where = touch.fill.where;
    fill.medium = touch.fill;
    fill.needs_surface = false;
    fill.mesh = mesh::make_box(box.min(), box.max());
    fill.faces = {{scene_file::kOtherFaces, {}, {}}};
    fill.face_of.assign(fill.mesh.triangles.size(), 0);
    fill.diagnosis = mesh::diagnose_in_place(fill.mesh);
    return fill;
  }

  const scene_file::SceneSpec& spec_;
  const mesh::MeshFormats& formats_;
  core::Problems& problems_;
  mesh::MeshFiles files_;
  std::vector<contact::PlacedMesh> placed_;
  std::map<std::string, Eigen::AlignedBox3d> bounds_;  ///< of parts and groups, world
  std::vector<std::pair<const scene_file::PartSpec*, std::size_t>>
      touching_;  ///< with their index in placed_
};

}  // namespace

std::vector<contact::PlacedMesh> place_parts(const scene_file::SceneSpec& spec, core::Problems& problems,
                                             const mesh::MeshFormats& formats) {
  return PartPlacer(spec, problems, formats).place_all();
}

}  // namespace scintray::scene
