#pragma once
/// Discrete Fourier transforms of height maps.

#include <complex>
#include <cstdint>
#include <vector>

namespace scintray::topography {

/// Transform of a real map of columns x rows points, of which half is stored: the other half is its
/// complex conjugate.
struct HalfSpectrum {
  std::uint32_t columns = 0, rows = 0;       ///< of the map
  std::vector<std::complex<double>> values;  ///< row-major, rows x kept()

  std::uint32_t kept() const { return columns / 2 + 1; }
  std::complex<double>& at(std::uint32_t k, std::uint32_t l) { return values[std::size_t{l} * kept() + k]; }
  const std::complex<double>& at(std::uint32_t k, std::uint32_t l) const {
    return values[std::size_t{l} * kept() + k];
  }
  /// Number of terms of the complete transform that column k represents: 1 or 2.
  double weight(std::uint32_t k) const { return k == 0 || 2 * k == columns ? 1.0 : 2.0; }
};

/// Transform: sum over points of h exp(-2 pi i (k i / columns + l j / rows)); `heights` is row-major.
HalfSpectrum fourier_transform(const std::vector<double>& heights, std::uint32_t columns, std::uint32_t rows);

/// Inverse transform, with its factor 1 / (columns rows).
std::vector<double> inverse_fourier_transform(const HalfSpectrum& spectrum);

/// Spatial frequency, 1/um, of term k of n points at this pitch: negative above the middle.
double spatial_frequency(std::uint32_t k, std::uint32_t n, double pitch_um);

/// The smallest number not below n without prime factors above 5, for which transforms are fast.
std::uint32_t quick_size(std::uint32_t n);

}  // namespace scintray::topography
