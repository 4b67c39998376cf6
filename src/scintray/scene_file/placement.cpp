#include "scintray/scene_file/placement.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "scintray/core/text.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

RotationSpec read_rotation(const config::TomlTable& table) {
  RotationSpec rotation;
  rotation.where = table.where();
  if (!table.has("axis")) table.report("axis", "a rotation has no \"axis\"", "add axis = [0, 0, 1]");
  rotation.axis = table.optional_direction("axis").value_or(core::Vec3::UnitZ());
  rotation.angle_rad = table.quantity("angle", core::Dimension::angle);
  return rotation;
}

/// Sides as they are called in words. z points up.
constexpr core::Word<const char*> kSideNames[] = {
    {"bottom", "-z"}, {"down", "-z"}, {"below", "-z"}, {"top", "+z"},   {"up", "+z"},
    {"above", "+z"},  {"left", "-x"}, {"right", "+x"}, {"front", "-y"}, {"back", "+y"},
    {"x", "+x"},      {"y", "+y"},    {"z", "+z"}};

/// The side of a part that is touched.
BoxSide read_side(const config::TomlTable& table) {
  const config::TomlNode* value = table.node()->find("side");
  const std::string word = value ? value->text : "";
  if (const auto meant = core::find_word(kSideNames, word)) {
    table.take("side");
    table.report("side",
                 "\"part.place.side\" is \"" + word + "\", but one of " +
                     core::list_quoted(core::word_list(kBoxSides)) + " is expected",
                 std::string("did you mean \"") + *meant + "\", the side towards " +
                     ((*meant)[0] == '-' ? "lower " : "higher ") + (*meant)[1] + "?");
    return *core::find_word(kBoxSides, *meant);
  }
  return table.choice("side", kBoxSides);
}

TouchSpec read_touch(const config::TomlTable& table, const std::vector<std::string>& earlier) {
  TouchSpec touch;
  touch.where = table.where();
  touch.part = read_name(table, "touch", true);
  const std::string near = core::nearest_word(touch.part.name, earlier);
  table.expect("touch", std::find(earlier.begin(), earlier.end(), touch.part.name) != earlier.end(),
               "the part \"" + touch.part.name + "\" to be touched does not stand before this one",
               near.empty() ? "name a part that stands earlier in the file"
                            : "did you mean \"" + near + "\"? name a part that stands earlier in the file");
  touch.side = read_side(table);
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

}  // namespace

std::vector<RotationSpec> read_rotations(const config::TomlTable& part) {
  std::vector<RotationSpec> rotations;
  if (part.is_array("rotate")) {
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

Eigen::Matrix3d rotation_of(const PlacementSpec& placement) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (const RotationSpec& turn : placement.rotate)
    rotation = Eigen::AngleAxisd(turn.angle_rad, turn.axis).toRotationMatrix() * rotation;
  return rotation;
}

}  // namespace scintray::scene_file
