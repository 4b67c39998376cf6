#pragma once
/// A surface measured on a goniometer, with numbers that no two fields share.

#include "scintray/analysis/goniometer/surface_analysis.hpp"

namespace scintray::test {

inline analysis::SurfaceAnalysis made_up_surface(const std::string& surface, const std::string& outside) {
  analysis::SurfaceAnalysis analysis;
  analysis.goniometer = "Faces";
  analysis.place = {surface, "LSO", outside, 420.0};
  analysis.index = {1.82, 1.0};
  analysis.rays = 1000;
  analysis.incidence_rad = {0.0, 20.0 * core::kDegree, 45.0 * core::kDegree};
  analysis.reflectance = {{0.15, 0.011}, {0.33, 0.015}, {0.8, 0.013}};
  analysis.slope_rad = {{18.0 * core::kDegree, 0.1 * core::kDegree},
                        {19.0 * core::kDegree, 0.2 * core::kDegree},
                        {21.0 * core::kDegree, 0.0}};
  analysis::GoniometerReading& reading = analysis.directions;
  reading.settings.incidence_rad = 45.0 * core::kDegree;
  reading.settings.wavelength_nm = 420.0;
  reading.settings.rays = analysis.rays;
  reading.reflected = 800;
  reading.transmitted = 190;
  reading.absorbed = 10;
  reading.reflected_directions.cells[7] = 790;
  reading.reflected_directions.cells[70] = 10;
  reading.reflected_directions.profile[140] = 31;
  reading.transmitted_directions.cells[3] = 190;
  reading.transmitted_directions.profile[90] = 17;
  reading.reflected_lobe.rays = reading.reflected;
  reading.reflected_lobe.width_in_plane = 0.5;  // sine of 30 deg
  return analysis;
}

}  // namespace scintray::test
