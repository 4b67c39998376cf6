#include "scintray/report/text/map_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/map_texture.hpp"

namespace scintray::report {

namespace {

std::string length(const std::optional<double>& um) { return um ? fmt::format("{:.4g} um", *um) : "-"; }

}  // namespace

std::vector<MapNumber> map_numbers(const topography::HeightMap& map) {
  const topography::MapStatistics s = topography::map_statistics(map);
  const topography::MapTexture t = topography::map_texture(map);
  const double width = std::min(map.columns * map.pitch_x_um, map.rows * map.pitch_y_um);
  return {
      {"points", fmt::format("{}", s.points), "with a height"},
      {"missing", fmt::format("{}", s.missing), "without"},
      {"Sa", length(s.sa_um), "mean absolute height"},
      {"Sq", length(s.sq_um), "root mean square height"},
      {"Sz", length(s.sz_um), "highest minus lowest"},
      {"lowest", fmt::format("{:+.4g} um", s.lowest_um), "from the mean"},
      {"highest", fmt::format("{:+.4g} um", s.highest_um), "from the mean"},
      {"Ssk", fmt::format("{:.3f}", s.ssk), "skewness of heights, 0 for a Gaussian surface"},
      {"Sku", fmt::format("{:.3f}", s.sku), "kurtosis of heights, 3 for a Gaussian surface"},
      {"mean slope", fmt::format("{:.3f} deg", s.mean_slope_rad / core::kDegree), "angle of the facets"},
      {"rms slope", fmt::format("{:.3f} deg", s.rms_slope_rad / core::kDegree), "angle of the facets"},
      {"Sdq", fmt::format("{:.4g}", s.sdq), "root mean square gradient"},
      {"Sdr", fmt::format("{:.4g} %", 100.0 * s.sdr), "area in excess of the projected area"},
      {"Sal", length(t.sal_um), "shortest length at which the autocorrelation is 0.2"},
      {"correlation length", length(t.correlation_length_um),
       "where the autocorrelation, averaged over directions, is 1/e"},
      {"Str", t.str ? fmt::format("{}{:.3f}", t.str_is_bound ? "at most " : "", *t.str) : "-",
       "shortest over longest such length: 1 the same in all directions, 0 grooved"},
      {"Std", t.std_rad ? fmt::format("{:.1f} deg", *t.std_rad / core::kDegree) : "-",
       "direction of the lay from x; not significant when Str is near 1"},
      {"slope at two pitches", fmt::format("{:.1f} %", 100.0 * s.slope_ratio_at_two_pitches),
       "of the rms slope over one pitch; below 90 % the pitch is too coarse"},
      {"width over Sal", t.sal_um ? fmt::format("{:.1f}", width / *t.sal_um) : "-",
       "autocorrelation lengths in the shorter side; below 10 the map is too small"},
  };
}

}  // namespace scintray::report
