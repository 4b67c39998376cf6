#include "scintray/scene/place_parts.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

#include "scintray/core/activity.hpp"
#include "scintray/core/text.hpp"
#include "scintray/mesh/diagnose_in_place.hpp"
#include "scintray/mesh/face_selection.hpp"
#include "scintray/mesh/recognize.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
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

mesh::FaceSelector selector_of(const scene_file::FaceSelectorSpec& spec) {
  mesh::FaceSelector selector;
  selector.normal = spec.normal;
  selector.normal_tolerance_rad = spec.tolerance_rad;
  if (spec.box) selector.box = Eigen::AlignedBox3d(spec.box->low, spec.box->high);
  selector.flat_region = spec.flat_region;
  selector.nearest = spec.nearest;
  if (!spec.group.empty()) selector.group = spec.group.name;
  selector.tags = spec.tags;
  return selector;
}

/// List of the groups of the mesh, with their tags in the file.
std::string group_list(const mesh::TriMesh& mesh) {
  constexpr std::size_t kMost = 30;
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const std::string& group : mesh.groups) add(group);
  for (const mesh::FaceTags& tags : mesh.group_tags)
    for (const auto& [key, value] : tags)
      if (key != "face") add(key + " = \"" + value + "\"");
  const auto shown = std::span<const std::string>(names).first(std::min(names.size(), kMost));
  return core::list_of(shown) + (names.size() > kMost ? " and more" : "");
}

/// Position of a triangle, for pictures.
std::vector<std::array<double, 3>> mark_at(const mesh::TriMesh& mesh, std::size_t triangle) {
  const core::Vec3 centre = mesh::centre_of(mesh, triangle);
  return {{centre.x(), centre.y(), centre.z()}};
}

/// Position of a triangle, for messages.
std::string place_of(const mesh::TriMesh& mesh, std::size_t triangle) {
  const core::Vec3 centre = mesh::centre_of(mesh, triangle);
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) mm", centre.x(), centre.y(), centre.z());
  return text;
}

/// Assigns every triangle to a face by the rules of the part.
class FaceTagger {
 public:
  FaceTagger(const scene_file::PartSpec& part, contact::PlacedMesh& placed, core::Problems& problems)
      : part_(part), placed_(placed), problems_(problems), rule_of_(placed.mesh.triangles.size(), kNoRule) {}

  void tag() {
    for (const scene_file::FaceRuleSpec& rule : part_.faces)
      if (!is_side(rule)) apply(rule);
    expect_surface_of_rest();
    for (const scene_file::FaceRuleSpec& rule : part_.faces)
      if (is_side(rule)) add_side(rule);
    const auto rest = static_cast<std::uint32_t>(placed_.faces.size());
    if (first_unmatched() < rule_of_.size())
      placed_.faces.push_back({scene_file::kOtherFaces, part_.surface, {}});
    for (const std::uint32_t rule : rule_of_) placed_.face_of.push_back(rule == kNoRule ? rest : rule);
  }

 private:
  static constexpr std::uint32_t kNoRule = 0xffffffffu;

  /// A rule that only names a side (scene_file/detail/side_faces.hpp).
  static bool is_side(const scene_file::FaceRuleSpec& rule) {
    return rule.where.text().empty() && rule.surface.empty() && rule.sensor.empty() &&
           rule.select.group.name == rule.name && !rule.name.empty();
  }

  std::size_t first_unmatched() const {
    return static_cast<std::size_t>(std::find(rule_of_.begin(), rule_of_.end(), kNoRule) - rule_of_.begin());
  }

  void add_side(const scene_file::FaceRuleSpec& side) {
    const auto face = static_cast<std::uint32_t>(placed_.faces.size());
    const std::vector<char> mask = mesh::select_triangles(placed_.mesh, selector_of(side.select));
    bool any = false;
    for (std::size_t t = 0; t < mask.size(); ++t) {
      if (!mask[t] || rule_of_[t] != kNoRule) continue;
      rule_of_[t] = face;
      any = true;
    }
    if (any) placed_.faces.push_back({side.name, part_.surface, {}});
  }

  void apply(const scene_file::FaceRuleSpec& spec) {
    const auto rule = static_cast<std::uint32_t>(placed_.faces.size());
    placed_.faces.push_back({spec.name, spec.surface.empty() ? part_.surface : spec.surface, spec.sensor});
    const std::vector<char> mask = mesh::select_triangles(placed_.mesh, selector_of(spec.select));
    bool any = false, reported = false;
    for (std::size_t t = 0; t < mask.size(); ++t) {
      if (!mask[t]) continue;
      any = true;
      if (rule_of_[t] == kNoRule) {
        rule_of_[t] = rule;
      } else if (!reported) {
        reported = true;
        problems_.add(
            spec.select.where,
            "rules \"" + placed_.faces[rule_of_[t]].name + "\" and \"" + spec.name + "\" of part \"" +
                placed_.name + "\" both match the triangle at " + place_of(placed_.mesh, t),
            "narrow one of them with a second criterion, such as box or normal", mark_at(placed_.mesh, t));
      }
    }
    if (!any)
      problems_.add(spec.select.where,
                    "rule \"" + spec.name + "\" matches no face of part \"" + placed_.name + "\"",
                    "normals and boxes are those of the placed part; its groups and tags are: " +
                        group_list(placed_.mesh));
  }

  void expect_surface_of_rest() {
    const std::size_t first = first_unmatched();
    if (first == rule_of_.size() || !part_.surface.empty() || !placed_.needs_surface) return;
    problems_.add(
        part_.where,
        "part \"" + placed_.name + "\" has faces without a surface: no rule matches the triangle at " +
            place_of(placed_.mesh, first),
        "give the part a surface = \"...\" for all faces that no rule matches", mark_at(placed_.mesh, first));
  }

  const scene_file::PartSpec& part_;
  contact::PlacedMesh& placed_;
  core::Problems& problems_;
  std::vector<std::uint32_t> rule_of_;
};

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
          "no sphere, cylinder or cone recognized: corners are farther than the contact tolerance "
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
    FaceTagger(part, result, problems_).tag();
    keep(std::move(result));
    if (!against.fill) return;
    contact::PlacedMesh fill = *against.fill;
    fill.priority = part.priority;
    keep(std::move(fill));
  }

  /// Parts are tagged in their own frame, placed in that of the group, and moved with it.
  void place_group(const scene_file::GroupSpec& group, const scene_file::PartSpec* parts) {
    std::vector<contact::PlacedMesh> members;
    Eigen::AlignedBox3d bounds;
    core::Problems found;
    for (std::size_t i = 0; i < group.count && found.empty(); ++i) {
      members.push_back(loaded(parts[i]));
      contact::PlacedMesh& member = members.back();
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
};

}  // namespace

std::vector<contact::PlacedMesh> place_parts(const scene_file::SceneSpec& spec, core::Problems& problems,
                                             const mesh::MeshFormats& formats) {
  return PartPlacer(spec, problems, formats).place_all();
}

}  // namespace scintray::scene
