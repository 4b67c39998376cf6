#include "scintray/topography/preparation.hpp"

#include "scintray/core/activity.hpp"
#include "scintray/topography/detail/missing_points.hpp"

namespace scintray::topography {

namespace {

void level(HeightMap& map, const Leveling& leveling) {
  switch (leveling.kind) {
    case Leveling::Kind::none:
      return;
    case Leveling::Kind::mean:
      return subtract_mean(map);
    case Leveling::Kind::plane:
      return level_plane(map);
    case Leveling::Kind::polynomial:
      return level_polynomial(map, leveling.degree);
  }
}

}  // namespace

void prepare(HeightMap& map, const Preparation& p) {
  if (const auto* box = std::get_if<CropBox>(&p.crop)) crop(map, *box);
  if (const auto* box = std::get_if<CropLengths>(&p.crop))
    crop(map, crop_box_um(map, box->x_um, box->y_um, box->width_um, box->height_um));
  const auto step = [](const char* what, std::size_t number) {
    constexpr std::size_t kSteps = 6;
    core::report_activity(what, number, kSteps);
  };
  step("preparing the map: outliers", 0);
  if (p.outlier_limit) remove_outliers(map, *p.outlier_limit, p.outlier_radius);
  step("preparing the map: missing points", 1);
  if (p.fill_missing) fill_missing(map);
  step("preparing the map: median filter", 2);
  if (p.median_radius) filter_median(map, *p.median_radius);
  step("preparing the map: LOESS", 3);
  if (p.loess_width_um) filter_loess_lines(map, *p.loess_width_um);
  step("preparing the map: Gaussian filter", 4);
  if (p.gaussian_um) filter_gaussian(map, *p.gaussian_um);
  step("preparing the map: levelling", 5);
  level(map, p.leveling);
}

}  // namespace scintray::topography
