/// Reliefs that are white noise under a filter: Gaussian random surfaces of a given power spectrum.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scintray/core/normals.hpp"
#include "scintray/topography/detail/fourier.hpp"
#include "scintray/topography/detail/relief.hpp"

namespace scintray::topography {

namespace {

using Density = std::function<double(double fx, double fy)>;

/// One realisation with the expected power spectrum `density`, um^4. White noise of unit variance has
/// the power N in each of the N terms of its transform; a term of the heights must have
/// N^2 S / area = N S / pitch^2.
std::vector<double> realisation(const SynthesisRecipe& recipe, ReliefPart part, const Density& density) {
  ReliefRandom random(recipe, part);
  std::vector<double> noise(std::size_t{recipe.columns} * recipe.rows);
  for (double& deviate : noise) deviate = random.normal();
  HalfSpectrum spectrum = fourier_transform(noise, recipe.columns, recipe.rows);
  for (std::uint32_t l = 0; l < recipe.rows; ++l)
    for (std::uint32_t k = 0; k < spectrum.kept(); ++k) {
      const double fx = spatial_frequency(k, recipe.columns, recipe.pitch_um);
      const double fy = spatial_frequency(l, recipe.rows, recipe.pitch_um);
      spectrum.at(k, l) *= std::sqrt(density(fx, fy)) / recipe.pitch_um;
    }
  spectrum.at(0, 0) = 0.0;  // the mean height is arbitrary
  return inverse_fourier_transform(spectrum);
}

void add(const std::vector<double>& field, double factor, std::vector<double>& heights) {
  for (std::size_t k = 0; k < field.size(); ++k) heights[k] += factor * field[k];
}

}  // namespace

double gaussian_density(const GaussianRelief& relief, double fx, double fy) {
  const double across = relief.correlation_length_um;
  const double along = relief.lay_length_um > 0.0 ? relief.lay_length_um : across;
  const double c = std::cos(relief.lay_angle_rad), s = std::sin(relief.lay_angle_rad);
  const double u = along * (c * fx + s * fy), v = across * (c * fy - s * fx);
  return relief.rms_height_um * relief.rms_height_um * core::kPi * along * across *
         std::exp(-core::kPi * core::kPi * (u * u + v * v));
}

double k_correlation_density(const KCorrelationRelief& relief, double f) {
  const double b = relief.knee_length_um, c = relief.exponent;
  const double at_zero = std::pow(relief.rms_height_um * b, 2) * (c - 1.0) / core::kTwoPi;
  return at_zero / std::pow(1.0 + b * b * f * f, 0.5 * (c + 1.0));
}

double tabulated_density(const SpectrumRelief& relief, double f) {
  const std::vector<double>& x = relief.frequency_per_um;
  const std::vector<double>& y = relief.density_um4;
  if (!(f >= x.front() && f <= x.back())) return 0.0;
  const auto above = std::upper_bound(x.begin(), x.end(), f);
  if (above == x.end()) return y.back();
  const auto k = static_cast<std::size_t>(above - x.begin());
  if (y[k - 1] > 0.0 && y[k] > 0.0) {
    const double t = std::log(f / x[k - 1]) / std::log(x[k] / x[k - 1]);
    return y[k - 1] * std::pow(y[k] / y[k - 1], t);
  }
  return std::lerp(y[k - 1], y[k], (f - x[k - 1]) / (x[k] - x[k - 1]));
}

void add_gaussian(const SynthesisRecipe& recipe, std::vector<double>& heights_um) {
  if (recipe.gaussian.rms_height_um == 0.0) return;
  const auto field = realisation(recipe, ReliefPart::gaussian, [&](double fx, double fy) {
    return gaussian_density(recipe.gaussian, fx, fy);
  });
  const double squares = std::inner_product(field.begin(), field.end(), field.begin(), 0.0);
  add(field, recipe.gaussian.rms_height_um / std::sqrt(squares / static_cast<double>(field.size())),
      heights_um);
}

void add_k_correlation(const SynthesisRecipe& recipe, std::vector<double>& heights_um) {
  if (recipe.k_correlation.rms_height_um == 0.0) return;
  add(realisation(recipe, ReliefPart::k_correlation,
                  [&](double fx, double fy) {
                    return k_correlation_density(recipe.k_correlation, std::hypot(fx, fy));
                  }),
      1.0, heights_um);
}

void add_spectrum(const SynthesisRecipe& recipe, std::vector<double>& heights_um) {
  if (recipe.spectrum.frequency_per_um.empty()) return;
  add(realisation(
          recipe, ReliefPart::spectrum,
          [&](double fx, double fy) { return tabulated_density(recipe.spectrum, std::hypot(fx, fy)); }),
      1.0, heights_um);
}

}  // namespace scintray::topography
