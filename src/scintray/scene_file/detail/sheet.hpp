#pragma once
/// Thin sheets of builders: their table, and the division of those between the cells of a grid so that they
/// do not cross. Lengths mm.

#include <array>
#include <string>
#include <vector>

#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/scene_file/contact.hpp"
#include "scintray/scene_file/part.hpp"

namespace scintray::scene_file {

/// Thin sheets between or around bodies: their medium, surface and contact with their neighbours.
struct SheetSpec {
  config::NameRef medium;                  ///< kOpaqueMedium unless given
  config::NameRef surface;                 ///< of every side of every sheet; empty: smooth
  ContactKind contact = ContactKind::dry;  ///< with touching parts other than fillers and glue
  core::FileLocation where;
};

/// "medium", "surface" or "reflector", "contact"; `surfaces` receives the surface of a sheet that is defined
/// by its reflector.
SheetSpec read_sheet(const config::TomlTable& table, InlineTables& surfaces);

/// An interval from `low` to `high` along one axis, mm.
struct Interval {
  double low = 0.0, high = 0.0;
};

/// Positions of sheets at one height, normal to x and normal to y, and the extent of the grid.
struct SheetGrid {
  std::array<std::vector<Interval>, 2> sheets;  ///< in order; of an axis without sheets empty
  std::array<Interval, 2> whole;
};

/// One sheet, or one piece of it between two sheets normal to the other axis.
struct SheetPiece {
  std::string index;  ///< "x[0]", "y[2]", or "x[0,1]" for piece 1 of sheet 0
  mesh::Rectangle bottom, top;
};

/// The pieces between two heights. Sheets normal to y are continuous; those normal to x are divided by them.
/// Both grids have the same numbers of sheets.
std::vector<SheetPiece> sheet_pieces(const SheetGrid& bottom, const SheetGrid& top);

/// A sheet's part named `name`, standing on `z_mm`.
PartSpec sheet_part(const SheetSpec& sheet, const std::string& name, const SheetPiece& piece, double z_mm,
                    double height_mm);

/// Rectangle of two intervals, by centre and size.
mesh::Rectangle rectangle_of(const Interval& x, const Interval& y);

}  // namespace scintray::scene_file
