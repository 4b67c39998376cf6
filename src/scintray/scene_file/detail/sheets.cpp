#include "scintray/scene_file/detail/sheets.hpp"

namespace scintray::scene_file {

namespace {

/// What the sheets across an axis leave free: before the first, between them, and after the last.
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

ContactSpec builder_contact(const std::string& a, const std::string& b, ContactKind kind,
                            const core::FileLocation& where, const config::NameRef& surface) {
  ContactSpec contact;
  contact.between = {config::NameRef{a, where}, config::NameRef{b, where}};
  contact.kind = kind;
  if (kind == ContactKind::bonded) contact.surface = surface;
  contact.by_builder = true;
  contact.where = where;
  return contact;
}

}  // namespace scintray::scene_file
