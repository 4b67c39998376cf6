#include "scintray/scene/detail/face_tagger.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <span>

#include "scintray/contact/neighbours.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/core/text.hpp"
#include "scintray/mesh/face_selection.hpp"

namespace scintray::scene {

namespace {

constexpr std::uint32_t kNoRule = 0xffffffffu;

mesh::FaceSelector selector_of(const scene_file::FaceSelectorSpec& spec) {
  mesh::FaceSelector selector;
  selector.normal = spec.normal;
  selector.normal_tolerance_rad = spec.tolerance_rad;
  if (spec.box) selector.box = Eigen::AlignedBox3d(spec.box->low, spec.box->high);
  selector.flat_region = spec.flat_region;
  selector.nearest = spec.nearest;
  selector.smooth_region = spec.smooth_region;
  if (!spec.smooth_around.empty()) selector.smooth_around = spec.smooth_around.name;
  selector.edge_angle_rad = spec.edge_angle_rad.value_or(mesh::kSmoothEdge);
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

/// A rule that only names a side (scene_file/detail/side_faces.hpp).
bool is_side(const scene_file::FaceRuleSpec& rule) {
  return rule.where.text().empty() && rule.surface.empty() && rule.sensor.empty() &&
         rule.select.group.name == rule.name && !rule.name.empty();
}

}  // namespace

double TouchingFaces::tolerance_of_contact(const std::string& other) const {
  const std::string& own = parts_[own_].name;
  double tolerance_mm = 0.0;
  for (const scene_file::ContactSpec& contact : spec_.contacts) {
    const bool between = (contact.between[0].name == own && contact.between[1].name == other) ||
                         (contact.between[0].name == other && contact.between[1].name == own);
    if (between && contact.tolerance_mm) tolerance_mm = std::max(tolerance_mm, *contact.tolerance_mm);
  }
  return tolerance_mm;
}

std::vector<char> TouchingFaces::touching(std::size_t other) const {
  if (other == own_) return std::vector<char>(parts_[own_].mesh.triangles.size(), 0);
  return contact::touching_triangles(parts_[own_], parts_[other], spec_.run.contact_tolerance_mm,
                                     tolerance_of_contact(parts_[other].name));
}

std::string TouchingFaces::touched_parts() const {
  std::set<std::string> names;
  for (std::size_t other = 0; other < parts_.size(); ++other) {
    const std::vector<char> mask = touching(other);
    if (std::find(mask.begin(), mask.end(), 1) != mask.end())
      names.insert(core::pattern_of(parts_[other].name));
  }
  return core::list_of(std::vector<std::string>(names.begin(), names.end()));
}

std::vector<char> TouchingFaces::mask(const scene_file::FaceSelectorSpec& select) const {
  const contact::PlacedMesh& own = parts_[own_];
  std::vector<char> mask(own.mesh.triangles.size(), 0);
  std::vector<std::string> names;
  for (std::size_t other = 0; other < parts_.size(); ++other) {
    names.push_back(parts_[other].name);
    if (!core::matches_pattern(select.touches.name, parts_[other].name)) continue;
    const std::vector<char> more = touching(other);
    for (std::size_t t = 0; t < mask.size(); ++t) mask[t] |= more[t];
  }
  if (core::matching(select.touches.name, names).empty()) {
    const std::string near = core::nearest_word(select.touches.name, names);
    throw core::InputError(core::Problem{
        select.touches.where, "there is no part \"" + select.touches.name + "\" for the faces to touch",
        near.empty() ? "name a part of this scene; \"*\" stands for any characters"
                     : "did you mean \"" + near + "\"?"});
  }
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) {
    char tolerance[32];
    std::snprintf(tolerance, sizeof tolerance, "%.4g mm", spec_.run.contact_tolerance_mm);
    const std::string touched = touched_parts();
    throw core::InputError(core::Problem{
        select.touches.where, "no face of part \"" + own.name + "\" touches \"" + select.touches.name + "\"",
        (touched.empty() ? "it touches no part" : "it touches " + touched) +
            "; faces touch where they face each other within run.contact_tolerance, " + tolerance +
            ", curved ones within the tolerance of a [[contact]] between the two"});
  }
  const double angle = select.edge_angle_rad.value_or(mesh::kSmoothEdge);
  return mesh::whole_regions(mask, mesh::smooth_regions(own.mesh, angle, true));
}

FaceTagger::FaceTagger(const scene_file::PartSpec& part, contact::PlacedMesh& placed,
                       core::Problems& problems, const TouchingFaces* touching)
    : part_(part),
      placed_(placed),
      problems_(problems),
      touching_(touching),
      rule_of_(placed.mesh.triangles.size(), kNoRule) {}

void FaceTagger::tag() {
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

std::size_t FaceTagger::first_unmatched() const {
  return static_cast<std::size_t>(std::find(rule_of_.begin(), rule_of_.end(), kNoRule) - rule_of_.begin());
}

void FaceTagger::add_side(const scene_file::FaceRuleSpec& side) {
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

/// Mask of the selected triangles; empty when the selection has a problem of its own, which is reported.
std::vector<char> FaceTagger::selected(const scene_file::FaceSelectorSpec& select) const {
  std::vector<char> mask = mesh::select_triangles(placed_.mesh, selector_of(select));
  if (select.touches.empty() || !touching_) return mask;
  try {
    const std::vector<char> touching = touching_->mask(select);
    for (std::size_t t = 0; t < mask.size(); ++t) mask[t] &= touching[t];
  } catch (const core::InputError& error) {
    problems_.add(error);
    return {};
  }
  return mask;
}

void FaceTagger::apply(const scene_file::FaceRuleSpec& spec) {
  const auto rule = static_cast<std::uint32_t>(placed_.faces.size());
  placed_.faces.push_back({spec.name, spec.surface.empty() ? part_.surface : spec.surface, spec.sensor});
  const std::vector<char> mask = selected(spec.select);
  if (mask.empty()) return;
  bool any = false, reported = false;
  for (std::size_t t = 0; t < mask.size(); ++t) {
    if (!mask[t]) continue;
    any = true;
    if (rule_of_[t] == kNoRule) {
      rule_of_[t] = rule;
    } else if (!reported) {
      reported = true;
      problems_.add(spec.select.where,
                    "rules \"" + placed_.faces[rule_of_[t]].name + "\" and \"" + spec.name + "\" of part \"" +
                        placed_.name + "\" both match the triangle at " + place_of(placed_.mesh, t),
                    "narrow one of them with a second criterion, such as box or normal",
                    mark_at(placed_.mesh, t));
    }
  }
  if (!any)
    problems_.add(spec.select.where,
                  "rule \"" + spec.name + "\" matches no face of part \"" + placed_.name + "\"",
                  "normals and boxes are those of the placed part; its groups and tags are: " +
                      group_list(placed_.mesh));
}

void FaceTagger::expect_surface_of_rest() {
  const std::size_t first = first_unmatched();
  if (first == rule_of_.size() || !part_.surface.empty() || !placed_.needs_surface) return;
  problems_.add(
      part_.where,
      "part \"" + placed_.name + "\" has faces without a surface: no rule matches the triangle at " +
          place_of(placed_.mesh, first),
      "give the part a surface = \"...\" for all faces that no rule matches", mark_at(placed_.mesh, first));
}

}  // namespace scintray::scene
