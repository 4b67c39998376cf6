#include "scintray/cli/map_text.hpp"

#include <fmt/format.h>

#include <iostream>

#include "scintray/report/map_numbers.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/map_texture.hpp"

namespace scintray::cli {

namespace {

void print_histogram(const MapStatistics& statistics) {
  std::cout << "\nslopes of the map, share of its area\n        deg      share\n";
  constexpr std::size_t kStep = 5;
  for (std::size_t low = 0; low < statistics.slope_histogram.size(); low += kStep) {
    double share = 0.0;
    for (std::size_t k = low; k < low + kStep; ++k) share += statistics.slope_histogram[k];
    if (share > 0.0) std::cout << fmt::format("{:>5} to {:>2}{:>10.4f} %\n", low, low + kStep, 100.0 * share);
  }
}

}  // namespace

void print_summary(const HeightMap& map) {
  const MapStatistics s = map_statistics(map);
  std::cout << fmt::format("map          {} x {} points, pitch {:.6g} x {:.6g} um\n", map.columns, map.rows,
                           map.pitch_x_um, map.pitch_y_um);
  for (const std::string& step : map.steps) std::cout << "             " << step << "\n";
  std::cout << fmt::format("heights      Sa {:.4g} um, Sq {:.4g} um, Sz {:.4g} um ({:+.4g} to {:+.4g} um)\n",
                           s.sa_um, s.sq_um, s.sz_um, s.lowest_um, s.highest_um);
  std::cout << fmt::format("slopes       mean {:.2f} deg, rms {:.3f} along x, {:.3f} along y\n",
                           s.mean_slope_rad / kDegree, s.rms_slope_x, s.rms_slope_y);
}

void print_slopes_met(const HeightField& field) {
  std::cout << fmt::format("\nmean slope met, deg\n{:>11}{:>18}{:>18}\n", "incidence", "from inside",
                           "from outside");
  for (const double degrees : {0.0, 30.0, 45.0, 60.0, 75.0, 80.0, 85.0, 87.0, kGrazingStated_rad / kDegree}) {
    const Estimate inside = mean_slope_met(field, Side::inside, degrees * kDegree);
    const Estimate outside = mean_slope_met(field, Side::outside, degrees * kDegree);
    std::cout << fmt::format("{:>11.2f}{:>9.2f} +- {:.2f}{:>9.2f} +- {:.2f}\n", degrees,
                             inside.value / kDegree, inside.error / kDegree, outside.value / kDegree,
                             outside.error / kDegree);
  }
}

void print_warnings(const HeightMap& map) {
  for (const std::string& warning : map_warnings(map, map_statistics(map), map_texture(map)))
    std::cout << "warning: " << warning << "\n";
}

void print_description(const HeightMap& map) {
  std::cout << fmt::format("map          {} x {} points, pitch {:.6g} x {:.6g} um\n", map.columns, map.rows,
                           map.pitch_x_um, map.pitch_y_um);
  for (const std::string& step : map.steps) std::cout << "             " << step << "\n";
  std::cout << "\n";
  for (const report::MapNumber& number : report::map_numbers(map))
    std::cout << fmt::format("{:<20}{:>16}  {}\n", number.name, number.value, number.meaning);
  const MapStatistics statistics = map_statistics(map);
  print_histogram(statistics);
  if (statistics.missing == 0) print_slopes_met(make_height_field(map));
}

}  // namespace scintray::cli
