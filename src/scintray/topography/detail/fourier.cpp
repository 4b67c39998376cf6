#include "scintray/topography/detail/fourier.hpp"

#include <unsupported/Eigen/FFT>

namespace scintray::topography {

namespace {

/// Transforms every column of a spectrum, forward or back.
void transform_columns(HalfSpectrum& spectrum, bool forward) {
  if (spectrum.rows == 1) return;  // the transform of one point is that point; Eigen's cannot compute it
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> column(spectrum.rows), result;
  for (std::uint32_t k = 0; k < spectrum.kept(); ++k) {
    for (std::uint32_t l = 0; l < spectrum.rows; ++l) column[l] = spectrum.at(k, l);
    if (forward)
      fft.fwd(result, column);
    else
      fft.inv(result, column);
    for (std::uint32_t l = 0; l < spectrum.rows; ++l) spectrum.at(k, l) = result[l];
  }
}

}  // namespace

HalfSpectrum fourier_transform(const std::vector<double>& heights, std::uint32_t columns,
                               std::uint32_t rows) {
  HalfSpectrum spectrum{columns, rows, {}};
  spectrum.values.resize(std::size_t{rows} * spectrum.kept());
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> line(columns);
  std::vector<std::complex<double>> result;
  for (std::uint32_t l = 0; l < rows; ++l) {
    std::copy_n(heights.begin() + static_cast<std::ptrdiff_t>(std::size_t{l} * columns), columns,
                line.begin());
    if (columns == 1)
      result.assign(1, line[0]);
    else
      fft.fwd(result, line);
    std::copy(result.begin(), result.end(), &spectrum.at(0, l));
  }
  transform_columns(spectrum, true);
  return spectrum;
}

std::vector<double> inverse_fourier_transform(const HalfSpectrum& spectrum) {
  HalfSpectrum work = spectrum;
  transform_columns(work, false);
  std::vector<double> heights;
  heights.reserve(std::size_t{work.columns} * work.rows);
  // With the whole spectrum: Eigen's inverse of half a spectrum needs an even number of points.
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> line(work.columns), result;
  for (std::uint32_t l = 0; l < work.rows; ++l) {
    for (std::uint32_t k = 0; k < work.columns; ++k)
      line[k] = k < work.kept() ? work.at(k, l) : std::conj(work.at(work.columns - k, l));
    if (work.columns == 1)
      result = line;
    else
      fft.inv(result, line);
    for (const auto& value : result) heights.push_back(value.real());
  }
  return heights;
}

double spatial_frequency(std::uint32_t k, std::uint32_t n, double pitch_um) {
  const double signed_k = 2 * std::uint64_t{k} <= n ? static_cast<double>(k) : static_cast<double>(k) - n;
  return signed_k / (n * pitch_um);
}

std::uint32_t quick_size(std::uint32_t n) {
  for (std::uint32_t size = n;; ++size) {
    std::uint32_t rest = size;
    for (const std::uint32_t factor : {2u, 3u, 5u})
      while (rest > 1 && rest % factor == 0) rest /= factor;
    if (rest <= 1) return size;
  }
}

}  // namespace scintray::topography
