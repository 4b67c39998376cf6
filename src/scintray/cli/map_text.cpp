#include "scintray/cli/map_text.hpp"

#include <fmt/format.h>

#include <iostream>

#include "scintray/report/text/map_numbers.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/map_texture.hpp"

namespace scintray::cli {

namespace {

void print_histogram(const topography::MapStatistics& statistics) {
  std::cout << "\nslopes of the map, share of its area\n        deg      share\n";
  constexpr std::size_t kStep = 5;
  for (std::size_t low = 0; low < statistics.slope_histogram.size(); low += kStep) {
    double share = 0.0;
    for (std::size_t k = low; k < low + kStep; ++k) share += statistics.slope_histogram[k];
    if (share > 0.0) std::cout << fmt::format("{:>5} to {:>2}{:>10.4f} %\n", low, low + kStep, 100.0 * share);
  }
}

}  // namespace

void print_summary(const topography::HeightMap& map) {
  const topography::MapStatistics s = topography::map_statistics(map);
  std::cout << fmt::format("map          {} x {} points, pitch {:.6g} x {:.6g} um\n", map.columns, map.rows,
                           map.pitch_x_um, map.pitch_y_um);
  for (const std::string& step : map.steps) std::cout << "             " << step << "\n";
  std::cout << fmt::format("heights      Sa {:.4g} um, Sq {:.4g} um, Sz {:.4g} um ({:+.4g} to {:+.4g} um)\n",
                           s.sa_um, s.sq_um, s.sz_um, s.lowest_um, s.highest_um);
  std::cout << fmt::format("slopes       mean {:.2f} deg, rms {:.3f} along x, {:.3f} along y\n",
                           s.mean_slope_rad / core::kDegree, s.rms_slope_x, s.rms_slope_y);
}

void print_visible_slopes(const optics::HeightField& field) {
  std::cout << fmt::format("\nmean visible slope, deg\n{:>11}{:>18}{:>18}\n", "incidence", "from inside",
                           "from outside");
  for (const double degrees :
       {0.0, 30.0, 45.0, 60.0, 75.0, 80.0, 85.0, 87.0, topography::kGrazingStated_rad / core::kDegree}) {
    const core::Estimate inside =
        topography::mean_visible_slope(field, optics::Side::inside, degrees * core::kDegree);
    const core::Estimate outside =
        topography::mean_visible_slope(field, optics::Side::outside, degrees * core::kDegree);
    std::cout << fmt::format("{:>11.2f}{:>9.2f} +- {:.2f}{:>9.2f} +- {:.2f}\n", degrees,
                             inside.value / core::kDegree, inside.error / core::kDegree,
                             outside.value / core::kDegree, outside.error / core::kDegree);
  }
}

void print_warnings(const topography::HeightMap& map) {
  for (const std::string& warning :
       topography::map_warnings(map, topography::map_statistics(map), topography::map_texture(map)))
    std::cout << "warning: " << warning << "\n";
}

Json map_json(const topography::HeightMap& map) {
  const topography::MapStatistics s = topography::map_statistics(map);
  return {{"columns", map.columns},
          {"rows", map.rows},
          {"pitch_x_um", json_of(map.pitch_x_um)},
          {"pitch_y_um", json_of(map.pitch_y_um)},
          {"points_missing", s.missing},
          {"sa_um", json_of(s.sa_um)},
          {"sq_um", json_of(s.sq_um)},
          {"sz_um", json_of(s.sz_um)},
          {"lowest_um", json_of(s.lowest_um)},
          {"highest_um", json_of(s.highest_um)},
          {"skewness", json_of(s.ssk)},
          {"kurtosis", json_of(s.sku)},
          {"rms_gradient", json_of(s.sdq)},
          {"developed_area_ratio", json_of(s.sdr)},
          {"rms_slope_x", json_of(s.rms_slope_x)},
          {"rms_slope_y", json_of(s.rms_slope_y)},
          {"mean_slope_deg", json_of(s.mean_slope_rad / core::kDegree)},
          {"steps", map.steps},
          {"warnings", topography::map_warnings(map, s, topography::map_texture(map))}};
}

void print_description(const topography::HeightMap& map) {
  std::cout << fmt::format("map          {} x {} points, pitch {:.6g} x {:.6g} um\n", map.columns, map.rows,
                           map.pitch_x_um, map.pitch_y_um);
  for (const std::string& step : map.steps) std::cout << "             " << step << "\n";
  std::cout << "\n";
  for (const report::MapNumber& number : report::map_numbers(map))
    std::cout << fmt::format("{:<20}{:>16}  {}\n", number.name, number.value, number.meaning);
  const topography::MapStatistics statistics = topography::map_statistics(map);
  print_histogram(statistics);
  if (statistics.missing == 0) print_visible_slopes(topography::make_height_field(map));
}

}  // namespace scintray::cli
