#include "scintray/scene_file/detail/light_guide.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

constexpr core::Word<bool> kFromTop[] = {{"top", true}, {"bottom", false}};

std::array<double, 2> read_end(const config::TomlTable& table, const std::string& key) {
  if (!table.has(key))
    table.report(key, "[light_guide] has no \"" + key + "\", which is needed", "add its size");
  const std::array<double, 2> size = read_length_pair(table, key).value_or(std::array{1.0, 1.0});
  table.expect(key, size[0] > 0.0 && size[1] > 0.0, "a side of \"" + key + "\" is not positive",
               "give lengths above 0, along x and y");
  return table.good(key) ? size : std::array{1.0, 1.0};
}

void read_slits(const config::TomlTable& owner, LightGuideSpec& guide, InlineTables& surfaces) {
  const config::TomlTable table = owner.table("slits");
  guide.segments = read_count(table, "segments");
  guide.slit_depth_mm = table.quantity("depth", core::Dimension::length);
  table.expect("depth", guide.slit_depth_mm > 0.0 && guide.slit_depth_mm <= guide.height_mm,
               "slits that are not deeper than 0, or deeper than the guide is high",
               "give a depth up to the height; the whole height cuts the guide in separate segments");
  guide.slit_width_mm = table.quantity("width", core::Dimension::length);
  double narrowest = HUGE_VAL;
  for (std::size_t axis = 0; axis < 2; ++axis)
    narrowest =
        std::min(narrowest, std::min(guide.bottom_mm[axis], guide.top_mm[axis]) / guide.segments[axis]);
  const bool ends_known = owner.good("bottom") && owner.good("top");
  table.expect("width", guide.slit_width_mm > 0.0 && (!ends_known || guide.slit_width_mm < narrowest),
               "slits that are not wider than 0, or as wide as a segment",
               "the narrowest segment is " + std::to_string(narrowest) + " mm with its share of the slits");
  guide.slits_from_top = table.choice("from", kFromTop, true);
  guide.slit_surface = read_name(table, "surface", false);
  if (const auto sheet = table.optional_table("sheet")) guide.slit_sheet = read_sheet(*sheet, surfaces);
}

}  // namespace

LightGuideSpec read_light_guide(const config::TomlTable& table, const std::vector<std::string>& earlier,
                                InlineTables& surfaces) {
  LightGuideSpec guide;
  guide.where = table.where();
  guide.name = read_name(table, "name", true);
  expect_plain_name(table, "name", guide.name.name);
  guide.placement = read_placement(table, earlier);
  guide.bottom_mm = read_end(table, "bottom");
  guide.top_mm = read_end(table, "top");
  guide.height_mm = table.quantity("height", core::Dimension::length);
  table.expect("height", guide.height_mm > 0.0, "the height of a light guide is not positive",
               "give a length above 0");
  guide.medium = read_name(table, "medium", true);
  guide.surface = read_name(table, "surface", true);
  guide.end_surface = read_name(table, "end_surface", false);
  if (!table.has("slits"))
    table.report("slits", "[light_guide] has no \"slits\", which is needed",
                 "add [light_guide.slits]; a guide without slits is a [[part]] with a \"tapered\" shape");
  else
    read_slits(table, guide, surfaces);
  return guide;
}

}  // namespace scintray::scene_file
