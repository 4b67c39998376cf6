#include "scintray/detector/photocathode.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace scintray::detector {

namespace {

constexpr double kVacuum = 1.0;

}  // namespace

double film_absorptance(const optics::CoatingLayer& film, double window_index, double index_behind,
                        double cos_i, double wavelength_nm) {
  const optics::Film layer{{film.index(wavelength_nm), film.extinction(wavelength_nm)}, film.thickness_nm};
  const optics::FilmResponse response =
      optics::film_response(cos_i, window_index, {&layer, 1}, index_behind, wavelength_nm);
  return 1.0 - response.reflectance() - response.transmittance();
}

core::Curve escape_probability(const optics::CoatingLayer& film, double window_index,
                               const core::Curve& efficiency) {
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  std::set<double> points;
  for (const core::Curve* table : {&film.index, &film.extinction, &efficiency}) {
    if (table->is_constant()) continue;
    low = std::max(low, table->x().front());
    high = std::min(high, table->x().back());
    points.insert(table->x().begin(), table->x().end());
  }
  constexpr double kAnywhere_nm = 400.0;
  if (points.empty() || low > high) points = {kAnywhere_nm};
  std::vector<double> nm, escape;
  for (const double at : points) {
    if (at < low || at > high) continue;
    nm.push_back(at);
    escape.push_back(efficiency(at) / film_absorptance(film, window_index, kVacuum, 1.0, at));
  }
  return core::Curve(std::move(nm), std::move(escape));
}

}  // namespace scintray::detector
