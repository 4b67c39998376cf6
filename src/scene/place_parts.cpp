#include "scintray/scene/place_parts.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "scintray/mesh/diagnose_in_place.hpp"
#include "scintray/mesh/face_selection.hpp"
#include "scintray/mesh/import.hpp"
#include "scintray/mesh/primitives.hpp"

namespace scintray {

namespace {

/// The face of all triangles that no rule matches.
constexpr const char* kOtherFace = "other";

struct LoadedShape {
  TriMesh mesh;
  std::vector<std::string> notes;
};

LoadedShape load(const MeshFileSpec& file) {
  MeshImport imported = import_mesh(file.path, file.unit_mm.value_or(0.0));
  LoadedShape shape{std::move(imported.mesh), std::move(imported.notes)};
  if (file.scale != 1.0)
    for (Vec3& vertex : shape.mesh.vertices) vertex *= file.scale;
  return shape;
}
LoadedShape load(const BoxSpec& box) { return {make_box(box.low, box.high), {}}; }
LoadedShape load(const CylinderSpec& c) { return {make_cylinder(c.radius_mm, c.height_mm, c.segments), {}}; }

FileLocation shape_location(const ShapeSpec& shape) {
  return std::visit([](const auto& s) { return s.where; }, shape);
}

Eigen::AlignedBox3d bounds_of(const TriMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Vec3& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

Eigen::Matrix3d rotation_of(const PlacementSpec& placement) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (const RotationSpec& turn : placement.rotate)
    rotation = Eigen::AngleAxisd(turn.angle_rad, turn.axis).toRotationMatrix() * rotation;
  return rotation;
}

void move(TriMesh& mesh, const Vec3& by) {
  for (Vec3& vertex : mesh.vertices) vertex += by;
}

/// Moves `mesh` against a side of `touched`, centred on it across.
void move_against(TriMesh& mesh, const Eigen::AlignedBox3d& touched, const TouchSpec& touch) {
  const Eigen::AlignedBox3d own = bounds_of(mesh);
  Vec3 shift = touched.center() - own.center();
  const int axis = touch.side.axis;
  shift[axis] = touch.side.sign > 0 ? touched.max()[axis] + touch.gap_mm - own.min()[axis]
                                    : touched.min()[axis] - touch.gap_mm - own.max()[axis];
  move(mesh, shift);
}

/// The box between two parts: as wide as both bounding boxes have in common, as thick as the gap.
std::optional<Eigen::AlignedBox3d> gap_between(const Eigen::AlignedBox3d& touched,
                                               const Eigen::AlignedBox3d& own, const TouchSpec& touch) {
  Vec3 low = touched.min().cwiseMax(own.min()), high = touched.max().cwiseMin(own.max());
  const int axis = touch.side.axis;
  low[axis] = touch.side.sign > 0 ? touched.max()[axis] : own.max()[axis];
  high[axis] = touch.side.sign > 0 ? own.min()[axis] : touched.min()[axis];
  if ((low.array() >= high.array()).any()) return std::nullopt;
  return Eigen::AlignedBox3d(low, high);
}

FaceSelector selector_of(const FaceSelectorSpec& spec) {
  FaceSelector selector;
  selector.normal = spec.normal;
  selector.normal_tolerance_rad = spec.tolerance_rad;
  if (spec.box) selector.box = Eigen::AlignedBox3d(spec.box->low, spec.box->high);
  selector.flat_region = spec.flat_region;
  selector.nearest = spec.nearest;
  if (!spec.group.empty()) selector.group = spec.group.name;
  return selector;
}

std::string group_list(const TriMesh& mesh) {
  std::string list;
  for (const std::string& group : mesh.groups) list += (list.empty() ? "" : ", ") + group;
  return list;
}

/// Where a triangle is, for pictures.
std::vector<std::array<double, 3>> mark_at(const TriMesh& mesh, std::size_t triangle) {
  const Vec3 centre = centre_of(mesh, triangle);
  return {{centre.x(), centre.y(), centre.z()}};
}

/// Where a triangle is, for messages.
std::string place_of(const TriMesh& mesh, std::size_t triangle) {
  const Vec3 centre = centre_of(mesh, triangle);
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) mm", centre.x(), centre.y(), centre.z());
  return text;
}

/// Gives every triangle its face by the rules of the part.
class FaceTagger {
 public:
  FaceTagger(const PartSpec& part, PlacedMesh& placed, Problems& problems)
      : part_(part), placed_(placed), problems_(problems), rule_of_(placed.mesh.triangles.size(), kNoRule) {}

  void tag() {
    for (std::size_t rule = 0; rule < part_.faces.size(); ++rule) apply(rule);
    const bool all_matched = std::find(rule_of_.begin(), rule_of_.end(), kNoRule) == rule_of_.end();
    const auto rest = static_cast<std::uint32_t>(placed_.faces.size());
    if (!all_matched) add_rest();
    for (const std::uint32_t rule : rule_of_) placed_.face_of.push_back(rule == kNoRule ? rest : rule);
  }

 private:
  static constexpr std::uint32_t kNoRule = 0xffffffffu;

  void apply(std::size_t rule) {
    const FaceRuleSpec& spec = part_.faces[rule];
    placed_.faces.push_back({spec.name, spec.surface.empty() ? part_.surface : spec.surface, spec.sensor});
    const std::vector<char> mask = select_triangles(placed_.mesh, selector_of(spec.select));
    bool any = false, reported = false;
    for (std::size_t t = 0; t < mask.size(); ++t) {
      if (!mask[t]) continue;
      any = true;
      if (rule_of_[t] == kNoRule) {
        rule_of_[t] = static_cast<std::uint32_t>(rule);
      } else if (!reported) {
        reported = true;
        problems_.add(spec.select.where,
                      "rules \"" + part_.faces[rule_of_[t]].name + "\" and \"" + spec.name + "\" of part \"" +
                          placed_.name + "\" both match the triangle at " + place_of(placed_.mesh, t),
                      "narrow one of them with a second criterion, such as box or normal",
                      mark_at(placed_.mesh, t));
      }
    }
    if (!any)
      problems_.add(
          spec.select.where, "rule \"" + spec.name + "\" matches no face of part \"" + placed_.name + "\"",
          "normals and boxes are those of the placed part; its groups are: " + group_list(placed_.mesh));
  }

  void add_rest() {
    const bool smooth_by_nature = !part_.sensor.empty() || part_.medium.name == kOpaqueMedium;
    if (part_.surface.empty() && !smooth_by_nature) {
      const auto first = std::find(rule_of_.begin(), rule_of_.end(), kNoRule) - rule_of_.begin();
      problems_.add(part_.where,
                    "part \"" + placed_.name +
                        "\" has faces without a surface: no rule matches the triangle at " +
                        place_of(placed_.mesh, static_cast<std::size_t>(first)),
                    "give the part a surface = \"...\" for all faces that no rule matches",
                    mark_at(placed_.mesh, static_cast<std::size_t>(first)));
    }
    placed_.faces.push_back({kOtherFace, part_.surface, {}});
  }

  const PartSpec& part_;
  PlacedMesh& placed_;
  Problems& problems_;
  std::vector<std::uint32_t> rule_of_;
};

class PartPlacer {
 public:
  PartPlacer(const SceneSpec& spec, Problems& problems) : spec_(spec), problems_(problems) {}

  std::vector<PlacedMesh> place_all() {
    for (const PartSpec& part : spec_.parts) {
      try {
        place(part);
      } catch (const InputError& error) {
        for (Problem problem : error.problems()) {
          if (problem.where.file.empty()) problem.where = shape_location(part.shape);
          problems_.add(std::move(problem));
        }
      }
    }
    return std::move(placed_);
  }

 private:
  void place(const PartSpec& part) {
    PlacedMesh result;
    result.name = part.name.name;
    result.where = part.where;
    result.medium = part.medium;
    result.sensor = part.sensor;
    result.surface = part.surface;
    result.priority = part.priority;
    LoadedShape shape = std::visit([](const auto& s) { return load(s); }, part.shape);
    result.notes = std::move(shape.notes);
    if (orient_outwards(shape.mesh)) result.notes.push_back("faces turned to point outwards");
    result.rotation = rotation_of(part.placement);
    Eigen::Affine3d turn = Eigen::Affine3d::Identity();
    turn.linear() = result.rotation;
    result.mesh = part.placement.rotate.empty() ? std::move(shape.mesh) : transformed(shape.mesh, turn);

    std::optional<PlacedMesh> fill;
    if (part.placement.touch) fill = touch(part, result.mesh);
    move(result.mesh, part.placement.translate);
    result.diagnosis = diagnose_in_place(result.mesh);
    if (result.diagnosis.bodies > 1)
      result.notes.push_back(std::to_string(result.diagnosis.bodies) +
                             " separate surfaces in one mesh: bodies or cavities that share the medium and "
                             "the rules of this part");
    const std::vector<Problem> unsound = mesh_problems(result.diagnosis, result.name);
    for (Problem problem : unsound) {
      if (problem.where.file.empty()) problem.where = shape_location(part.shape);
      problems_.add(std::move(problem));
    }
    FaceTagger(part, result, problems_).tag();
    placed_.push_back(std::move(result));
    if (fill) placed_.push_back(std::move(*fill));
  }

  /// Moves the mesh against the touched part; returns the part that fills the gap, if any.
  std::optional<PlacedMesh> touch(const PartSpec& part, TriMesh& mesh) {
    const TouchSpec& touch = *part.placement.touch;
    const auto touched = std::find_if(placed_.begin(), placed_.end(),
                                      [&](const PlacedMesh& other) { return other.name == touch.part.name; });
    if (touched == placed_.end()) {
      problems_.add(touch.part.where,
                    "part \"" + part.name.name + "\" is to touch \"" + touch.part.name +
                        "\", which does not stand before it or could not be placed",
                    "move the touched part above this one, and mend its own errors first");
      return std::nullopt;
    }
    const Eigen::AlignedBox3d touched_bounds = touched->diagnosis.bounds;
    move_against(mesh, touched_bounds, touch);
    if (touch.fill.empty()) return std::nullopt;
    const auto box = gap_between(touched_bounds, bounds_of(mesh), touch);
    if (!box) {
      problems_.add(touch.fill.where, "there is no gap to fill with \"" + touch.fill.name + "\"",
                    "give a gap of positive thickness, as gap = \"0.1 mm\"");
      return std::nullopt;
    }
    PlacedMesh fill;
    fill.name = part.name.name + "_fill";
    fill.where = touch.fill.where;
    fill.medium = touch.fill;
    fill.priority = part.priority;
    fill.mesh = make_box(box->min(), box->max());
    move(fill.mesh, part.placement.translate);
    fill.faces = {{kOtherFace, {}, {}}};
    fill.face_of.assign(fill.mesh.triangles.size(), 0);
    fill.diagnosis = diagnose_in_place(fill.mesh);
    return fill;
  }

  const SceneSpec& spec_;
  Problems& problems_;
  std::vector<PlacedMesh> placed_;
};

}  // namespace

std::vector<PlacedMesh> place_parts(const SceneSpec& spec, Problems& problems) {
  return PartPlacer(spec, problems).place_all();
}

}  // namespace scintray
