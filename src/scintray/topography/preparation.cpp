#include "scintray/topography/preparation.hpp"

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
  if (p.outlier_limit) remove_outliers(map, *p.outlier_limit, p.outlier_radius);
  if (p.fill_missing) fill_missing(map);
  if (p.median_radius) filter_median(map, *p.median_radius);
  if (p.loess_width_um) filter_loess_lines(map, *p.loess_width_um);
  if (p.gaussian_um) filter_gaussian(map, *p.gaussian_um);
  level(map, p.leveling);
}

}  // namespace scintray::topography
