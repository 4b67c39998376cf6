#include "scintray/scene_file/detail/sheet.hpp"

#include <memory>

#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

/// Contacts between a sheet and its neighbours, the default first.
constexpr core::Word<ContactKind> kSheetContacts[] = {{"dry", ContactKind::dry},
                                                      {"bonded", ContactKind::bonded}};

using Kind = config::TomlNode::Kind;

/// Keys for the optical properties of a sheet.
enum class SheetOptics { surface, reflector };
constexpr core::Word<SheetOptics> kSheetOptics[] = {{"surface", SheetOptics::surface},
                                                    {"reflector", SheetOptics::reflector}};

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

/// A surface that is one face of a sheet: [surfaces.NAME] with model = "painted" and face_of_sheet = true.
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

/// Intervals that are free of sheets across an axis: before the first, between them, and after the last.
std::vector<Interval> spaces(const std::vector<Interval>& sheets, const Interval& whole) {
  std::vector<Interval> free{whole};
  for (const Interval& sheet : sheets) {
    const double end = free.back().high;
    free.back().high = sheet.low;
    free.push_back({sheet.high, end});
  }
  return free;
}

}  // namespace

SheetSpec read_sheet(const config::TomlTable& table, InlineTables& surfaces) {
  SheetSpec sheet;
  sheet.where = table.where();
  sheet.medium = read_name(table, "medium", false);
  if (sheet.medium.empty()) sheet.medium = {kOpaqueMedium, table.where()};
  if (const auto* optics = table.one_of(kSheetOptics, true)) {
    const config::NameRef name = read_name(table, optics->word, true);
    sheet.surface = optics->value == SheetOptics::reflector ? sheet_of(name, surfaces) : name;
  }
  sheet.contact = table.choice("contact", kSheetContacts, ContactKind::dry);
  return sheet;
}

mesh::Rectangle rectangle_of(const Interval& x, const Interval& y) {
  return {{x.high - x.low, y.high - y.low}, {0.5 * (x.low + x.high), 0.5 * (y.low + y.high)}};
}

std::vector<SheetPiece> sheet_pieces(const SheetGrid& bottom, const SheetGrid& top) {
  std::vector<SheetPiece> pieces;
  for (std::size_t j = 0; j < bottom.sheets[1].size(); ++j)
    pieces.push_back({"y[" + std::to_string(j) + "]", rectangle_of(bottom.whole[0], bottom.sheets[1][j]),
                      rectangle_of(top.whole[0], top.sheets[1][j])});
  const std::vector<Interval> rows_bottom = spaces(bottom.sheets[1], bottom.whole[1]);
  const std::vector<Interval> rows_top = spaces(top.sheets[1], top.whole[1]);
  for (std::size_t i = 0; i < bottom.sheets[0].size(); ++i)
    for (std::size_t row = 0; row < rows_bottom.size(); ++row) {
      const std::string index =
          rows_bottom.size() == 1 ? std::to_string(i) : std::to_string(i) + "," + std::to_string(row);
      pieces.push_back({"x[" + index + "]", rectangle_of(bottom.sheets[0][i], rows_bottom[row]),
                        rectangle_of(top.sheets[0][i], rows_top[row])});
    }
  return pieces;
}

PartSpec sheet_part(const SheetSpec& sheet, const std::string& name, const SheetPiece& piece, double z_mm,
                    double height_mm) {
  PartSpec part;
  part.name = {name, sheet.where};
  part.where = sheet.where;
  part.shape = TaperedSpec{piece.bottom, piece.top, height_mm, sheet.where};
  part.placement.translate = core::Vec3(0.0, 0.0, z_mm);
  part.medium = sheet.medium;
  part.surface = sheet.surface;
  return part;
}

}  // namespace scintray::scene_file
