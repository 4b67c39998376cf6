#pragma once
/// Height maps whose numbers are known in closed form.

#include <cmath>
#include <functional>

#include "scintray/core/rng.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/topography/detail/fourier.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray::test {

inline topography::HeightMap map_of(std::uint32_t columns, std::uint32_t rows, double pitch_um,
                                    const std::function<double(double x_um, double y_um)>& height) {
  topography::HeightMap map;
  map.columns = columns;
  map.rows = rows;
  map.pitch_x_um = map.pitch_y_um = pitch_um;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) map.heights_um.push_back(height(i * pitch_um, j * pitch_um));
  return map;
}

/// amplitude sin(2 pi (m x / width + n y / width)) on a periodic square.
inline topography::HeightMap sinusoid(std::uint32_t points, double pitch_um, double amplitude_um, int m,
                                      int n) {
  const double width = points * pitch_um;
  topography::HeightMap map = map_of(points, points, pitch_um, [&](double x, double y) {
    return amplitude_um * std::sin(core::kTwoPi * (m * x + n * y) / width);
  });
  map.periodic = true;
  return map;
}

/// A periodic map with random phases and exactly this power spectrum, so that its autocorrelation is
/// exactly the spectrum's transform, not only on average.
inline topography::HeightMap random_phases(std::uint32_t points, double pitch_um, std::uint64_t seed,
                                           const std::function<double(double fx, double fy)>& density_um4) {
  core::Rng rng(seed, core::StreamKind::other, 0);
  topography::HeightMap map =
      map_of(points, points, pitch_um, [&](double, double) { return rng.uniform() - 0.5; });
  topography::HalfSpectrum spectrum = topography::fourier_transform(map.heights_um, points, points);
  const double n = static_cast<double>(points) * points, width = points * pitch_um;
  for (std::uint32_t l = 0; l < points; ++l)
    for (std::uint32_t k = 0; k < spectrum.kept(); ++k) {
      const double density = density_um4(topography::spatial_frequency(k, points, pitch_um),
                                         topography::spatial_frequency(l, points, pitch_um));
      spectrum.at(k, l) *= n * std::sqrt(density) / width / std::abs(spectrum.at(k, l));
    }
  spectrum.at(0, 0) = 0.0;
  map.heights_um = topography::inverse_fourier_transform(spectrum);
  map.periodic = true;
  return map;
}

}  // namespace scintray::test
