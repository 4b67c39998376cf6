#pragma once
/// [[array]], and its expansion into parts. Lengths mm.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/scene_file/detail/builder.hpp"
#include "scintray/scene_file/detail/sheet.hpp"

namespace scintray::scene_file {

/// Sheets between the elements of a layer.
struct SeptaSpec {
  SheetSpec sheet;
  double thickness_mm = 0.0;
  bool x = true, y = true;  ///< between columns (normal to x), between rows (normal to y)
  std::optional<std::array<double, 2>> height_mm;  ///< above the elements' bottom; nothing: the full height
  core::FileLocation where;
};

/// A plate between two layers.
struct GlueSpec {
  config::NameRef medium;
  double thickness_mm = 0.0;
};

/// Elements in columns along x and rows along y, all on one level.
struct LayerSpec {
  PartSpec element;  ///< without a name; rotated but not placed
  Eigen::AlignedBox3d element_bounds{core::Vec3::Zero(), core::Vec3::Ones()};  ///< after that rotation
  std::array<int, 2> count{1, 1};
  std::array<double, 2> pitch_mm{};
  std::array<double, 2> offset_mm{};  ///< of the layer's centre
  double row_shift_mm = 0.0;          ///< of odd rows against even ones, along x
  std::optional<SeptaSpec> septa;
  config::NameRef filler;        ///< medium between the elements; empty: the ambient medium
  std::optional<GlueSpec> glue;  ///< between this layer and the next
  core::FileLocation where;
};

/// Selection of the elements of an override: all criteria present apply together.
struct ElementSelector {
  std::vector<int> columns, rows, layers;  ///< empty: all
  bool border = false;                     ///< first and last column and row
  int checker = 0;                         ///< 1: column + row even, 2: odd, 0: both
};

/// Properties that differ for some elements.
struct OverrideSpec {
  ElementSelector select;
  bool remove = false;  ///< omits the element
  config::NameRef medium, surface;
  std::vector<FaceRuleSpec> faces;  ///< in place of the element's rules of the same names, or added
  core::FileLocation where;
};

/// Reflector sheets around a whole array.
struct WrapSpec {
  SheetSpec sheet;
  double thickness_mm = 0.0;
  double gap_mm = 0.0;
  std::vector<BoxSide> sides;
  core::FileLocation where;
};

struct ArraySpec {
  config::NameRef name;
  PlacementSpec placement;
  std::vector<LayerSpec> layers;  ///< from z = 0 up
  bool layered = false;           ///< names are NAME[layer,column,row] instead of NAME[column,row]
  std::vector<OverrideSpec> overrides;
  std::optional<WrapSpec> wrap;
  core::FileLocation where;
};

/// One [[array]]. `earlier` are the names that it may touch; `surfaces` receives the surfaces of sheets that
/// are defined by their reflector; `formats` are those of elements from mesh files, whose size is needed.
ArraySpec read_array(const config::TomlTable& table, const std::vector<std::string>& earlier,
                     InlineTables& surfaces, const mesh::MeshFormats& formats);

/// Elements "NAME[i,j]" (column i along x, row j along y, from 0; "NAME[k,i,j]" in layers), sheets
/// "NAME_septum_x[..]", "NAME_septum_y[..]", "NAME_wrap[-x]"..., glue "NAME_glue[k]" above layer k, and
/// fillers "NAME_filler" or "NAME_filler[k]". The lowest layer stands on z = 0; layers are centred on
/// x = y = 0 apart from their offsets.
BuiltBody expand(const ArraySpec& array);

}  // namespace scintray::scene_file
