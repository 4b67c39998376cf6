#include "scintray/scene_file/part.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>

#include "scintray/core/pattern.hpp"
#include "scintray/scene_file/detail/names.hpp"
#include "scintray/scene_file/placement.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

/// Text of a scalar, as the value of a tag.
std::optional<std::string> tag_value(const config::TomlNode& node) {
  if (node.kind == Kind::string) return node.text;
  if (node.kind == Kind::boolean) return node.boolean ? "true" : "false";
  if (node.kind == Kind::integer || node.kind == Kind::number) return mesh::tag_text(node.number);
  return std::nullopt;
}

/// color = "#rrggbb" and extras = { KEY = VALUE }.
mesh::FaceTags read_tags(const config::TomlTable& select) {
  mesh::FaceTags tags;
  if (select.has("color")) {
    std::string& color = tags["color"] = select.string("color");
    std::transform(color.begin(), color.end(), color.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    select.expect("color",
                  color.size() == 7 && color[0] == '#' &&
                      color.find_first_not_of("0123456789abcdef", 1) == std::string::npos,
                  "\"" + color + "\" is not a colour", "write red, green and blue as \"#ff8000\"");
  }
  if (!select.has("extras")) return tags;
  const config::TomlNodePtr extras = select.take("extras");
  if (extras->kind != Kind::table || extras->items.empty()) {
    select.report("extras", "\"extras\" is not a table of keys and values",
                  "write extras = { finish = \"rough\" }");
    return tags;
  }
  for (const config::TomlNode& member : extras->items) {
    const std::optional<std::string> value = tag_value(member);
    if (value)
      tags[member.key] = *value;
    else
      select.report("extras", "the extra \"" + member.key + "\" is not text, a number, true or false",
                    "only such extras of a glTF file can be asked for");
  }
  return tags;
}

/// Regions that grow over smooth edges, and whole faces that touch a part.
void read_regions(const config::TomlTable& table, FaceSelectorSpec& select) {
  select.smooth_region = table.optional_quantity3("smooth_region", core::Dimension::length);
  select.smooth_around = read_name(table, "smooth_around", false);
  select.touches = read_name(table, "touches", false);
  select.edge_angle_rad = table.optional_quantity("edge_angle", core::Dimension::angle);
  const double angle = select.edge_angle_rad.value_or(0.0);
  table.expect("edge_angle", angle >= 0.0 && angle <= core::kPi, "an edge angle outside 0 to 180 deg",
               "give the largest angle between neighbouring triangles of one region, as \"30 deg\"");
  const bool grows = table.has("smooth_region") || table.has("smooth_around") || table.has("touches");
  table.expect("edge_angle", grows, "an edge angle without a region that it ends",
               "add smooth_region, smooth_around or touches, or remove edge_angle");
}

FaceSelectorSpec read_selector(const config::TomlTable& face) {
  const config::TomlTable table = face.table("select");
  FaceSelectorSpec select;
  select.where = table.where();
  select.normal = table.optional_direction("normal");
  select.tolerance_rad = table.quantity("tolerance", core::Dimension::angle, select.tolerance_rad);
  table.expect("tolerance", select.tolerance_rad >= 0.0 && select.tolerance_rad <= core::kPi,
               "a tolerance outside 0 to 180 deg", "give the largest angle to the normal, as \"1 deg\"");
  table.expect("tolerance", table.has("normal"), "a tolerance without a \"normal\"",
               "add normal = [0, 0, 1], or remove tolerance");
  select.box = read_low_high(table, "box");
  select.flat_region = table.optional_quantity3("flat_region", core::Dimension::length);
  select.nearest = table.optional_quantity3("nearest", core::Dimension::length);
  read_regions(table, select);
  const auto group = table.one_of({"group", "gltf_material"}, false);
  if (group) select.group = read_name(table, *group, true);
  select.tags = read_tags(table);
  if (face.good("select") && table.keys().empty())
    face.report(
        "select", "an empty selection would match every face",
        "give normal, box, flat_region, smooth_region, smooth_around, touches, nearest, group, color or "
        "extras; for every face set the part's own surface");
  return select;
}

/// "-z" for a normal along an axis, the name of the group or of the touched part, or nothing.
std::string selector_name(const FaceSelectorSpec& select) {
  if (!select.group.empty()) return select.group.name;
  if (!select.touches.empty()) return core::is_pattern(select.touches.name) ? "" : select.touches.name;
  if (select.normal && !select.box && !select.flat_region && !select.nearest && !select.smooth_region &&
      select.smooth_around.empty())
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs((*select.normal)[axis]) == 1.0)
        return core::word_of(kBoxSides, BoxSide{axis, (*select.normal)[axis] > 0.0 ? +1 : -1});
  return "";
}

}  // namespace

std::vector<FaceRuleSpec> read_faces(const config::TomlTable& part) {
  std::vector<FaceRuleSpec> rules;
  std::set<std::string> names{kOtherFaces};
  const std::vector<config::TomlTable> tables = part.tables("face");
  for (const config::TomlTable& table : tables) {
    FaceRuleSpec rule;
    rule.where = table.where();
    rule.name = table.string("name", "");
    rule.select = read_selector(table);
    rule.surface = read_name(table, "surface", false);
    rule.sensor = read_name(table, "sensor", false);
    expect_plain_name(table, "name", rule.name);
    table.expect("name", rule.name.empty() || names.insert(rule.name).second,
                 "the name \"" + rule.name + "\" is already taken in this part",
                 "give each [[part.face]] a name of its own; \"" + std::string(kOtherFaces) +
                     "\" stands for the faces that no rule matches");
    rules.push_back(std::move(rule));
  }
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (!rules[i].name.empty()) continue;
    const std::string name = selector_name(rules[i].select);
    rules[i].name = name.empty() || names.count(name) > 0 || name.find_first_of(".:") != std::string::npos
                        ? "face" + std::to_string(i + 1)
                        : name;
    if (!names.insert(rules[i].name).second)
      tables[i].report("name",
                       "the name \"" + rules[i].name + "\" of this face is already taken in this part",
                       "give it a name of its own");
  }
  return rules;
}

namespace {

/// principal_axes = { z = [...], x = [...] }: two perpendicular axes, or z alone, the optic axis of a
/// uniaxial medium; x is then any direction across it.
std::optional<Eigen::Matrix3d> read_principal_axes(const config::TomlTable& part, bool& x_given) {
  const std::optional<config::TomlTable> table = part.optional_table("principal_axes");
  if (!table) return std::nullopt;
  const std::optional<core::Vec3> x = table->optional_direction("x"), z = table->optional_direction("z");
  if (!table->has("z"))
    table->report(
        "z", "\"principal_axes\" has no \"z\"",
        "give the direction of the medium's principal axis z in the part's frame, as z = [0, 0, 1], and "
        "where all three indices differ that of x as well");
  if (!z || (table->has("x") && !x)) return std::nullopt;
  x_given = x.has_value();
  const core::Frame about = core::Frame::about(*z);
  constexpr double kPerpendicular = 1e-6;
  table->expect("x", !x || std::abs(x->dot(*z)) < kPerpendicular,
                "the principal axes x and z are not perpendicular",
                "principal axes are perpendicular to each other; check the two directions");
  const core::Vec3 first = x ? core::Vec3((*x - x->dot(*z) * *z).normalized()) : about.x;
  Eigen::Matrix3d axes;
  axes << first, z->cross(first), *z;
  return axes;
}

}  // namespace

void read_body(const config::TomlTable& table, PartSpec& part) {
  part.shape = read_shape(table);
  part.sensor = read_name(table, "sensor", false);
  part.medium = read_name(table, "medium", !table.has("sensor"));
  part.surface = read_name(table, "surface", false);
  part.principal_axes = read_principal_axes(table, part.principal_x_given);
  part.priority = static_cast<int>(table.integer("priority", 0));
  table.expect("priority", std::abs(table.integer("priority", 0)) <= kHighestPriority,
               "a priority beyond " + std::to_string(kHighestPriority), "give a smaller number");
  part.faces = read_faces(table);
}

PartSpec read_part(const config::TomlTable& table, const std::vector<std::string>& earlier) {
  PartSpec part;
  part.where = table.where();
  part.name = read_name(table, "name", true);
  expect_plain_name(table, "name", part.name.name);
  part.placement = read_placement(table, earlier);
  read_body(table, part);
  return part;
}

}  // namespace scintray::scene_file
