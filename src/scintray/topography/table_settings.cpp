#include <cmath>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::topography {

void require_valid(const TableSettings& s, const std::vector<SpectralPoint>& spectrum) {
  core::Problems problems;
  if (spectrum.empty()) problems.add({}, "no wavelength or pair of indices to build the table for");
  const auto positive = [&](double value, const std::string& name) {
    if (!(value > 0.0 && std::isfinite(value)))
      problems.add({}, name + " is " + std::to_string(value) + "; expected a positive number");
  };
  for (const SpectralPoint& point : spectrum) {
    positive(point.index.inside, "index inside");
    positive(point.index.outside, "index outside");
  }
  if (!(s.target_error >= 0.0 && s.target_error < 1.0))
    problems.add({}, "target error is " + std::to_string(s.target_error) + "; expected 0 up to 1");
  if (s.reciprocal && s.directional)
    problems.add({}, "a table with direction cannot be made reciprocal", "set one of the two");
  if (s.most_rays == 0) problems.add({}, "at most 0 times the rays; expected at least 1");
  positive(s.refine_change, "change of reflectance to refine at");
  positive(s.refine_down_to_rad, "smallest incidence interval");
  if (!(s.incidence_step_rad > 0.0 && s.incidence_step_rad <= 0.5 * core::kPi))
    problems.add({}, "incidence step is " + std::to_string(s.incidence_step_rad / core::kDegree) +
                         " deg; expected above 0, up to 90 deg");
  if (!(s.azimuth_step_rad > 0.0 && s.azimuth_step_rad <= core::kTwoPi))
    problems.add({}, "azimuth step is " + std::to_string(s.azimuth_step_rad / core::kDegree) +
                         " deg; expected above 0, up to 360 deg");
  if (!(s.grazing_rad > 0.0 && s.grazing_rad < 0.5 * core::kPi))
    problems.add({}, "grazing incidence is " + std::to_string(s.grazing_rad / core::kDegree) +
                         " deg; expected between 0 and 90 deg");
  if (s.rays == 0) problems.add({}, "0 rays per direction; expected at least 1");
  problems.throw_if_any();
}

}  // namespace scintray::topography
