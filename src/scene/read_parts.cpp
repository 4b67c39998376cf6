#include "scintray/scene/read_parts.hpp"
#include "scintray/core/pattern.hpp"

#include <algorithm>

namespace scintray {

namespace {

using Kind = TomlNode::Kind;

const std::vector<std::string> kSides{"-x", "+x", "-y", "+y", "-z", "+z"};

bool is_array(const TomlTable& table, const std::string& key) {
  const TomlNode* node = table.node()->find(key);
  return node && node->kind == Kind::array;
}

/// box = [size, size, size], centred in x and y, from z = 0; or box = { low, high }.
BoxSpec read_box(const TomlTable& table) {
  const TomlNode* node = table.node()->find("box");
  if (node->kind == Kind::table) return read_low_high(table, "box").value_or(BoxSpec{});
  BoxSpec box;
  box.where = node->where;
  const Vec3 size = table.optional_quantity3("box", Dimension::length).value_or(Vec3::Zero());
  table.expect("box", size.minCoeff() > 0.0, "a side of the box is not positive",
               "give three lengths above 0");
  box.low = Vec3(-0.5 * size.x(), -0.5 * size.y(), 0.0);
  box.high = Vec3(0.5 * size.x(), 0.5 * size.y(), size.z());
  return box;
}

CylinderSpec read_cylinder(const TomlTable& part) {
  const TomlTable table = part.table("cylinder");
  CylinderSpec cylinder;
  cylinder.where = table.where();
  cylinder.radius_mm = table.quantity("radius", Dimension::length);
  cylinder.height_mm = table.quantity("height", Dimension::length);
  const std::int64_t segments = table.integer("segments", cylinder.segments);
  for (const char* key : {"radius", "height"})
    table.expect(key, (std::string(key) == "radius" ? cylinder.radius_mm : cylinder.height_mm) > 0.0,
                 std::string("the ") + key + " of a cylinder is not positive", "give a length above 0");
  table.expect("segments", segments >= 3 && segments <= 1000000,
               "a cylinder of " + std::to_string(segments) + " segments",
               "give 3 or more (64 is the default), up to 1000000");
  cylinder.segments = static_cast<int>(segments);
  return cylinder;
}

/// Mesh formats that state their unit (glTF 2.0 specification, section 3.4: metres).
bool states_its_unit(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".gltf" || extension == ".glb";
}

MeshFileSpec read_mesh(const TomlTable& table) {
  MeshFileSpec mesh;
  mesh.where = table.where("mesh");
  mesh.path = table.existing_file("mesh");
  const std::optional<std::string> unit = table.optional_string("unit");
  if (unit) {
    try {
      mesh.unit_mm = unit_factor(*unit, Dimension::length);
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) table.report("unit", problem.what, problem.hint);
    }
  } else if (!table.has("unit")) {
    table.expect("mesh", states_its_unit(mesh.path),
                 "the mesh file \"" + mesh.path.string() + "\" does not say in which unit its numbers are",
                 "add the unit it was exported in, as unit = \"mm\"");
  }
  mesh.scale = table.number("scale", 1.0);
  table.expect("scale", mesh.scale > 0.0, "a scale that is not positive", "give a factor above 0");
  return mesh;
}

ShapeSpec read_shape(const TomlTable& part) {
  const std::optional<std::string> kind = part.one_of({"mesh", "box", "cylinder"}, true);
  for (const char* key : {"unit", "scale"}) part.has(key);
  if (kind == "mesh") return read_mesh(part);
  if (kind == "cylinder") return read_cylinder(part);
  if (kind == "box") return read_box(part);
  return BoxSpec{};
}

RotationSpec read_rotation(const TomlTable& table) {
  RotationSpec rotation;
  rotation.where = table.where();
  if (!table.has("axis")) table.report("axis", "a rotation has no \"axis\"", "add axis = [0, 0, 1]");
  rotation.axis = table.optional_direction("axis").value_or(Vec3::UnitZ());
  rotation.angle_rad = table.quantity("angle", Dimension::angle);
  return rotation;
}

TouchSpec read_touch(const TomlTable& table, const std::vector<std::string>& earlier) {
  TouchSpec touch;
  touch.where = table.where();
  touch.part = read_name(table, "touch", true);
  table.expect("touch", std::find(earlier.begin(), earlier.end(), touch.part.name) != earlier.end(),
               "the part \"" + touch.part.name + "\" to be touched does not stand before this one",
               "name a part that stands earlier in the file");
  const std::string side = table.choice("side", kSides);
  const auto index = static_cast<int>(std::find(kSides.begin(), kSides.end(), side) - kSides.begin());
  touch.side = {index / 2, index % 2 == 0 ? -1 : 1};
  touch.gap_mm = table.quantity("gap", Dimension::length, 0.0);
  table.expect("gap", touch.gap_mm >= 0.0, "a gap below 0 would make the parts overlap",
               "give a length of 0 or more");
  touch.fill = read_name(table, "fill", false);
  table.expect("fill", touch.gap_mm > 0.0 || table.has("gap"),
               "a fill needs a gap to be in, but no \"gap\" is given",
               "add gap = \"0.1 mm\", or remove fill");
  if (table.has("gap"))
    table.expect("fill", touch.gap_mm > 0.0 || !table.good("gap"), "a fill in a gap of no thickness",
                 "give the gap a thickness, or remove fill");
  return touch;
}

PlacementSpec read_placement(const TomlTable& part, const std::vector<std::string>& earlier) {
  PlacementSpec placement;
  placement.translate = part.optional_quantity3("translate", Dimension::length).value_or(Vec3::Zero());
  if (is_array(part, "rotate")) {
    for (const TomlTable& table : part.tables("rotate")) placement.rotate.push_back(read_rotation(table));
  } else if (const auto table = part.optional_table("rotate")) {
    placement.rotate.push_back(read_rotation(*table));
  }
  if (const auto table = part.optional_table("place")) placement.touch = read_touch(*table, earlier);
  return placement;
}

FaceSelectorSpec read_selector(const TomlTable& face) {
  const TomlTable table = face.table("select");
  FaceSelectorSpec select;
  select.where = table.where();
  select.normal = table.optional_direction("normal");
  select.tolerance_rad = table.quantity("tolerance", Dimension::angle, select.tolerance_rad);
  table.expect("tolerance", select.tolerance_rad >= 0.0 && select.tolerance_rad <= kPi,
               "a tolerance outside 0 to 180 deg", "give the largest angle to the normal, as \"1 deg\"");
  table.expect("tolerance", table.has("normal"), "a tolerance without a \"normal\"",
               "add normal = [0, 0, 1], or remove tolerance");
  select.box = read_low_high(table, "box");
  select.flat_region = table.optional_quantity3("flat_region", Dimension::length);
  select.nearest = table.optional_quantity3("nearest", Dimension::length);
  const auto group = table.one_of({"group", "gltf_material"}, false);
  if (group) select.group = read_name(table, *group, true);
  if (face.good("select") && table.keys().empty())
    face.report("select", "an empty selection would match every face",
                "give normal, box, flat_region, nearest or group; for every face set the part's own surface");
  return select;
}

/// "-z" for a normal along an axis, the group's name, or nothing.
std::string selector_name(const FaceSelectorSpec& select) {
  if (!select.group.empty()) return select.group.name;
  if (select.normal && !select.box && !select.flat_region && !select.nearest)
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs((*select.normal)[axis]) == 1.0)
        return kSides[static_cast<std::size_t>(2 * axis + ((*select.normal)[axis] > 0.0 ? 1 : 0))];
  return "";
}

void expect_plain_name(const TomlTable& table, const std::string& key, const std::string& name) {
  table.expect(
      key, name.find_first_of(".:\"\n") == std::string::npos,
      "the name \"" + name + "\" contains a dot, a colon, a quote or a line break",
      "these characters have a meaning in \"part:face\" and in swept keys: use letters, digits, _ and -");
}

std::vector<FaceRuleSpec> read_faces(const TomlTable& part) {
  std::vector<FaceRuleSpec> rules;
  std::set<std::string> names{kOtherFaces};
  const std::vector<TomlTable> tables = part.tables("face");
  for (const TomlTable& table : tables) {
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

PartSpec read_part(const TomlTable& table, const std::vector<std::string>& earlier) {
  PartSpec part;
  part.where = table.where();
  part.name = read_name(table, "name", true);
  expect_plain_name(table, "name", part.name.name);
  part.shape = read_shape(table);
  part.placement = read_placement(table, earlier);
  part.sensor = read_name(table, "sensor", false);
  part.medium = read_name(table, "medium", !table.has("sensor"));
  part.surface = read_name(table, "surface", false);
  part.priority = static_cast<int>(table.integer("priority", 0));
  table.expect("priority", std::abs(table.integer("priority", 0)) <= kHighestPriority,
               "a priority beyond " + std::to_string(kHighestPriority), "give a smaller number");
  part.faces = read_faces(table);
  return part;
}

}  // namespace

NameRef read_name(const TomlTable& table, const std::string& key, bool required) {
  NameRef name{required ? table.string(key) : table.string(key, ""), table.where(key)};
  return name;
}

std::optional<BoxSpec> read_low_high(const TomlTable& table, const std::string& key) {
  if (is_array(table, key)) {
    table.report(key, "\"" + key + "\" is an array, but a table is expected",
                 "write " + key + " = { low = [\"0 mm\", \"0 mm\", \"0 mm\"], high = [...] }");
    table.take(key);
    return std::nullopt;
  }
  const std::optional<TomlTable> corners = table.optional_table(key);
  if (!corners) return std::nullopt;
  BoxSpec box;
  box.where = corners->where();
  for (const char* corner : {"low", "high"}) {
    const std::vector<double> mm = corners->quantities(corner, Dimension::length, 3);
    if (mm.empty()) continue;
    (corner == std::string("low") ? box.low : box.high) = Vec3(mm[0], mm[1], mm[2]);
  }
  if (corners->good("low"))
    corners->expect("high", (box.high - box.low).minCoeff() > 0.0,
                    "a coordinate of \"high\" is not above that of \"low\"",
                    "give the corner with the larger x, y and z");
  return box;
}

std::vector<PartSpec> read_parts(const TomlTable& scene) {
  std::vector<PartSpec> parts;
  std::vector<std::string> names;
  const auto claim = [&](const TomlTable& table, const std::string& name, const std::string& hint) {
    if (name.empty()) return;
    if (std::find(names.begin(), names.end(), name) != names.end())
      table.report("name", "the name \"" + name + "\" is already taken by another part", hint);
    names.push_back(name);
  };
  for (const TomlTable& table : scene.tables("part")) {
    PartSpec part = read_part(table, names);
    claim(table, part.name.name, "give each [[part]] a name of its own");
    if (part.placement.touch && !part.placement.touch->fill.empty())
      claim(table, part.name.name + kFillSuffix,
            "the fill of a gap is a part of this name: rename one of the two");
    parts.push_back(std::move(part));
  }
  if (!scene.has("part"))
    scene.report("part", "the scene has no parts", "add a [[part]] with a name, a shape and a medium");
  return parts;
}

std::vector<std::string> part_names(const std::vector<PartSpec>& parts) {
  std::vector<std::string> names;
  for (const PartSpec& part : parts) {
    names.push_back(part.name.name);
    if (part.placement.touch && !part.placement.touch->fill.empty())
      names.push_back(part.name.name + kFillSuffix);
  }
  return names;
}

void expect_part(const TomlTable& table, const std::string& key, const NameRef& name,
                 const std::vector<std::string>& parts) {
  const std::string near = nearest_word(name.name, parts);
  std::string list;
  for (const std::string& part : parts) list += (list.empty() ? "" : ", ") + part;
  table.expect(key, name.empty() || std::find(parts.begin(), parts.end(), name.name) != parts.end(),
               "there is no part \"" + name.name + "\"",
               (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "the parts are " + list);
}

void expect_parts(const TomlTable& table, const std::string& key, const NameRef& pattern,
                  const std::vector<std::string>& parts) {
  if (std::none_of(parts.begin(), parts.end(),
                   [&](const std::string& part) { return matches_pattern(pattern.name, part); }))
    expect_part(table, key, pattern, parts);
}

}  // namespace scintray
