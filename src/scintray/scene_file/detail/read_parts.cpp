#include "scintray/scene_file/detail/read_parts.hpp"

#include <algorithm>
#include <set>

#include "scintray/core/pattern.hpp"
#include "scintray/core/text.hpp"
#include "scintray/scene_file/detail/read_shapes.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

const std::vector<std::string> kSides{"-x", "+x", "-y", "+y", "-z", "+z"};

RotationSpec read_rotation(const config::TomlTable& table) {
  RotationSpec rotation;
  rotation.where = table.where();
  if (!table.has("axis")) table.report("axis", "a rotation has no \"axis\"", "add axis = [0, 0, 1]");
  rotation.axis = table.optional_direction("axis").value_or(core::Vec3::UnitZ());
  rotation.angle_rad = table.quantity("angle", core::Dimension::angle);
  return rotation;
}

TouchSpec read_touch(const config::TomlTable& table, const std::vector<std::string>& earlier) {
  TouchSpec touch;
  touch.where = table.where();
  touch.part = read_name(table, "touch", true);
  table.expect("touch", std::find(earlier.begin(), earlier.end(), touch.part.name) != earlier.end(),
               "the part \"" + touch.part.name + "\" to be touched does not stand before this one",
               "name a part that stands earlier in the file");
  touch.side = side_of(table.choice("side", kSides)).value_or(BoxSide{});
  touch.gap_mm = table.quantity("gap", core::Dimension::length, 0.0);
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

/// All names, or as many as can be read at a glance.
std::string name_list(std::span<const std::string> names) {
  constexpr std::size_t kMostListed = 12;
  std::string list = core::list_of(names.first(std::min(names.size(), kMostListed)));
  if (names.size() > kMostListed) list += ", ... (" + std::to_string(names.size()) + " in all)";
  return list;
}

/// A scalar as the value of a tag.
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
  const auto group = table.one_of({"group", "gltf_material"}, false);
  if (group) select.group = read_name(table, *group, true);
  select.tags = read_tags(table);
  if (face.good("select") && table.keys().empty())
    face.report(
        "select", "an empty selection would match every face",
        "give normal, box, flat_region, nearest, group, color or extras; for every face set the part's own "
        "surface");
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

}  // namespace

void expect_plain_name(const config::TomlTable& table, const std::string& key, const std::string& name) {
  table.expect(key, name.find_first_of(".:*\"\n") == std::string::npos,
               "the name \"" + name + "\" contains a dot, a colon, a star, a quote or a line break",
               "these characters have a meaning in \"part:face\", in patterns and in swept keys: use "
               "letters, digits, _ and -");
}

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

std::optional<BoxSide> side_of(const std::string& word) {
  const auto found = std::find(kSides.begin(), kSides.end(), word);
  if (found == kSides.end()) return std::nullopt;
  const int index = static_cast<int>(found - kSides.begin());
  return BoxSide{index / 2, index % 2 == 0 ? -1 : 1};
}

void read_body(const config::TomlTable& table, PartSpec& part) {
  part.shape = read_shape(table);
  part.sensor = read_name(table, "sensor", false);
  part.medium = read_name(table, "medium", !table.has("sensor"));
  part.surface = read_name(table, "surface", false);
  part.priority = static_cast<int>(table.integer("priority", 0));
  table.expect("priority", std::abs(table.integer("priority", 0)) <= kHighestPriority,
               "a priority beyond " + std::to_string(kHighestPriority), "give a smaller number");
  part.faces = read_faces(table);
}

std::vector<RotationSpec> read_rotations(const config::TomlTable& part) {
  std::vector<RotationSpec> rotations;
  if (is_array(part, "rotate")) {
    for (const config::TomlTable& table : part.tables("rotate")) rotations.push_back(read_rotation(table));
  } else if (const auto table = part.optional_table("rotate")) {
    rotations.push_back(read_rotation(*table));
  }
  return rotations;
}

PlacementSpec read_placement(const config::TomlTable& table, const std::vector<std::string>& earlier) {
  PlacementSpec placement;
  placement.translate =
      table.optional_quantity3("translate", core::Dimension::length).value_or(core::Vec3::Zero());
  placement.rotate = read_rotations(table);
  if (const auto touch = table.optional_table("place")) placement.touch = read_touch(*touch, earlier);
  return placement;
}

config::NameRef read_name(const config::TomlTable& table, const std::string& key, bool required) {
  config::NameRef name{required ? table.string(key) : table.string(key, ""), table.where(key)};
  return name;
}

void expect_part(const config::TomlTable& table, const std::string& key, const config::NameRef& name,
                 const std::vector<std::string>& parts) {
  if (parts.empty()) return;
  const std::string near = core::nearest_word(name.name, parts);
  table.expect(key, name.empty() || std::find(parts.begin(), parts.end(), name.name) != parts.end(),
               "there is no part \"" + name.name + "\"",
               (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "the parts are " + name_list(parts));
}

void expect_parts(const config::TomlTable& table, const std::string& key, const config::NameRef& pattern,
                  const std::vector<std::string>& parts) {
  if (!core::is_pattern(pattern.name) || parts.empty()) return expect_part(table, key, pattern, parts);
  table.expect(key, !core::matching(pattern.name, parts).empty(), "no part matches \"" + pattern.name + "\"",
               "\"*\" stands for any characters; the parts are " + name_list(parts));
}

}  // namespace scintray::scene_file
