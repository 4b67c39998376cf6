#pragma once
/// [[light_guide]], and its expansion into parts. Lengths mm.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/scene_file/detail/builder.hpp"
#include "scintray/scene_file/detail/sheet.hpp"

namespace scintray::scene_file {

/// A frustum of one medium with slits cut from one end, which separate a segment for each cell.
struct LightGuideSpec {
  config::NameRef name;
  PlacementSpec placement;
  std::array<double, 2> bottom_mm{}, top_mm{};  ///< sizes of its ends
  double height_mm = 0.0;
  std::array<int, 2> segments{1, 1};
  double slit_depth_mm = 0.0, slit_width_mm = 0.0;
  bool slits_from_top = true;
  std::optional<SheetSpec> slit_sheet;  ///< fills the slits; nothing: the ambient medium
  config::NameRef medium, surface, end_surface, slit_surface;
  core::FileLocation where;
};

/// One [[light_guide]]. `earlier` are the names that it may touch; `surfaces` receives the surfaces of sheets
/// that are defined by their reflector.
LightGuideSpec read_light_guide(const config::TomlTable& table, const std::vector<std::string>& earlier,
                                InlineTables& surfaces);

/// Segments "NAME[i,j]", the part that joins them "NAME_base" (none when the slits go through), and sheets
/// in the slits, "NAME_slit_x[..]" and "NAME_slit_y[..]". Stands on z = 0, centred on x = y = 0.
BuiltBody expand(const LightGuideSpec& guide);

}  // namespace scintray::scene_file
