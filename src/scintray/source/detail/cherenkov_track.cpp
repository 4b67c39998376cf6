#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/source/detail/cherenkov.hpp"
#include "scintray/source/detail/gamma/element_data.hpp"

namespace scintray::source {

namespace {

constexpr double kTrackStep_nm = 2.0, kNmInMm = 1e6;
constexpr std::size_t kVelocities = 2000;  ///< of the table, from the threshold to that of light
constexpr int kPieces = 32;                ///< of a step, for Simpson's rule

double beta_at(const ParticleStep& step, double along) {
  return step.beta + along * (step.beta_end - step.beta);
}

}  // namespace

CherenkovTrack::CherenkovTrack(const optics::Medium& medium, double low_nm, double high_nm)
    : index_(medium.index), low_nm_(low_nm), high_nm_(high_nm), greatest_index_(1.0) {
  check_cherenkov_range(medium, low_nm, high_nm);
  const auto steps = static_cast<std::size_t>(std::ceil((high_nm - low_nm) / kTrackStep_nm));
  std::vector<double> wavelengths_nm, inverse_n2;
  for (std::size_t i = 0; i <= steps; ++i) {
    wavelengths_nm.push_back(low_nm +
                             (high_nm - low_nm) * static_cast<double>(i) / static_cast<double>(steps));
    const double n = index_(wavelengths_nm.back());
    greatest_index_ = std::max(greatest_index_, n);
    inverse_n2.push_back(1.0 / (n * n));
  }
  const double threshold = 1.0 / greatest_index_;
  if (threshold >= 1.0) return;
  std::vector<double> betas, numbers;
  for (std::size_t k = 0; k <= kVelocities; ++k) {
    const double beta =
        threshold + (1.0 - threshold) * static_cast<double>(k) / static_cast<double>(kVelocities);
    const auto density = [&](std::size_t i) {
      return std::max(0.0, 1.0 - inverse_n2[i] / (beta * beta)) / (wavelengths_nm[i] * wavelengths_nm[i]);
    };
    double sum = 0.0;
    for (std::size_t i = 1; i < wavelengths_nm.size(); ++i)
      sum += 0.5 * (density(i) + density(i - 1)) * (wavelengths_nm[i] - wavelengths_nm[i - 1]);
    betas.push_back(beta);
    numbers.push_back(k == 0 ? 0.0 : core::kTwoPi * kFineStructure * kNmInMm * sum);
  }
  per_mm_ = core::Curve(std::move(betas), std::move(numbers));
}

double CherenkovTrack::per_mm(double beta) const {
  return per_mm_.is_constant() || beta * greatest_index_ <= 1.0 ? 0.0 : per_mm_(beta);
}

double CherenkovTrack::mean_photons(const ParticleStep& step) const {
  const double length_mm = step.displacement.norm();
  if (step.charge == 0.0 || length_mm == 0.0) return 0.0;
  double sum = per_mm(step.beta) + per_mm(step.beta_end);
  for (int i = 1; i < kPieces; ++i)
    sum += (i % 2 == 1 ? 4.0 : 2.0) * per_mm(beta_at(step, static_cast<double>(i) / kPieces));
  return step.charge * step.charge * length_mm * sum / (3.0 * kPieces);
}

CherenkovTrack::Emission CherenkovTrack::sample(const ParticleStep& step, core::Rng& rng) const {
  const double most = std::max(per_mm(step.beta), per_mm(step.beta_end));
  if (!(most > 0.0) || step.displacement.isZero(0.0))
    throw core::InputError(
        {{},
         fmt::format("a step with Cherenkov photons is slower than light: beta {:g}, index {:g}",
                     std::max(step.beta, step.beta_end), greatest_index_),
         "check beta, beta_end, dx, dy, dz and the refractive index of the medium"});
  Emission photon;
  do photon.along = rng.uniform();
  while (rng.uniform() * most >= per_mm(beta_at(step, photon.along)));
  const double beta = beta_at(step, photon.along);
  const double least_cosine = 1.0 / (beta * greatest_index_);
  double cosine = 1.0;
  do {  // 1 / wavelength is uniform; the rest of the density by rejection
    const double u = rng.uniform();
    photon.wavelength_nm = 1.0 / (u / low_nm_ + (1.0 - u) / high_nm_);
    cosine = 1.0 / (beta * index_(photon.wavelength_nm));
  } while (rng.uniform() * (1.0 - least_cosine * least_cosine) >= 1.0 - cosine * cosine);
  const core::Vec3 axis = step.displacement.normalized();
  photon.direction = core::turned(axis, cosine, core::kTwoPi * rng.uniform());
  photon.polarisation = (axis - axis.dot(photon.direction) * photon.direction).normalized();
  return photon;
}

}  // namespace scintray::source
