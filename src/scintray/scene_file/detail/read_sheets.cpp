#include "scintray/scene_file/detail/read_builders.hpp"
#include "scintray/scene_file/detail/read_parts.hpp"
#include "scintray/scene_file/detail/read_shapes.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

config::TomlNode string_node(const std::string& key, const std::string& text,
                             const core::FileLocation& where) {
  config::TomlNode node;
  node.kind = Kind::string;
  node.key = key;
  node.text = text;
  node.where = node.key_where = where;
  return node;
}

config::TomlNode true_node(const std::string& key, const core::FileLocation& where) {
  config::TomlNode node = string_node(key, "true", where);
  node.kind = Kind::boolean;
  node.boolean = true;
  return node;
}

/// A surface that is nothing but one face of a sheet: what [surfaces.NAME] with model = "painted" and
/// face_of_sheet = true says.
config::NameRef sheet_of(const config::NameRef& reflector, InlineTables& surfaces) {
  const std::string name = "sheet of " + reflector.name;
  auto node = std::make_shared<config::TomlNode>();
  node->key = name;
  node->where = node->key_where = reflector.where;
  node->items = {string_node("model", "painted", reflector.where),
                 string_node("reflector", reflector.name, reflector.where),
                 true_node("face_of_sheet", reflector.where)};
  surfaces.emplace(name, node);
  return {name, reflector.where};
}

}  // namespace

SheetSpec read_sheet(const config::TomlTable& table, InlineTables& surfaces) {
  SheetSpec sheet;
  sheet.where = table.where();
  sheet.medium = read_name(table, "medium", false);
  if (sheet.medium.empty()) sheet.medium = {kOpaqueMedium, table.where()};
  const auto optics = table.one_of({"surface", "reflector"}, true);
  if (optics == "surface") sheet.surface = read_name(table, "surface", true);
  if (optics == "reflector") sheet.surface = sheet_of(read_name(table, "reflector", true), surfaces);
  sheet.contact =
      table.choice("contact", {"dry", "bonded"}, "dry") == "dry" ? ContactKind::dry : ContactKind::bonded;
  return sheet;
}

std::array<int, 2> read_count(const config::TomlTable& table, const std::string& key) {
  const std::vector<double> numbers = table.numbers(key, 2);
  std::array<int, 2> count{1, 1};
  if (numbers.empty()) return count;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool good = numbers[i] >= 1.0 && numbers[i] <= 10000.0 && numbers[i] == std::floor(numbers[i]);
    table.expect(key, good, "a number of \"" + key + "\" that is not whole, or not in 1 to 10000",
                 "give the numbers along x and y, as " + key + " = [12, 12]");
    if (good) count[i] = static_cast<int>(numbers[i]);
  }
  table.expect(key, static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) <= kMostParts,
               "more than " + std::to_string(kMostParts) + " elements", "give fewer");
  return table.good(key) ? count : std::array<int, 2>{1, 1};
}

std::optional<std::array<double, 2>> read_length_pair(const config::TomlTable& table,
                                                      const std::string& key) {
  if (is_array(table, key)) {
    const std::vector<double> mm = table.quantities(key, core::Dimension::length, 2);
    if (mm.empty()) return std::nullopt;
    return std::array<double, 2>{mm[0], mm[1]};
  }
  const std::optional<double> mm = table.optional_quantity(key, core::Dimension::length);
  if (!mm) return std::nullopt;
  return std::array<double, 2>{*mm, *mm};
}

}  // namespace scintray::scene_file
