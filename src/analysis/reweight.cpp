#include "scintray/analysis/reweight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scintray {

namespace {

constexpr double kLeastEffective = 100.0, kLeastShare = 0.1, kLargestShare = 0.02;

void check_change(const OpticalChange& change) {
  if (change.traced_absorption_per_mm.size() != change.wanted_absorption_per_mm.size() ||
      change.traced_reflectance.size() != change.wanted_reflectance.size())
    throw std::invalid_argument("traced and wanted optics differ in number");
  const auto is_absorption = [](double mu) { return mu >= 0.0 && std::isfinite(mu); };
  const auto is_reflectance = [](double r) { return r >= 0.0 && r <= 1.0; };
  for (const std::vector<double>* all : {&change.traced_absorption_per_mm, &change.wanted_absorption_per_mm})
    if (!std::all_of(all->begin(), all->end(), is_absorption))
      throw std::invalid_argument("an absorption is 0 or more and finite");
  for (const std::vector<double>* all : {&change.traced_reflectance, &change.wanted_reflectance})
    if (!std::all_of(all->begin(), all->end(), is_reflectance))
      throw std::invalid_argument("a reflectance is from 0 to 1");
}

double weight_of(const PhotonHistory& photon, const OpticalChange& change) {
  if (photon.path_mm.size() != change.traced_absorption_per_mm.size() ||
      photon.bounces.size() != change.traced_reflectance.size())
    throw std::invalid_argument("a photon with other media or surfaces than the optics");
  double power = 0.0, factor = 1.0;
  for (std::size_t i = 0; i < photon.path_mm.size(); ++i)
    power -= (change.wanted_absorption_per_mm[i] - change.traced_absorption_per_mm[i]) *
             static_cast<double>(photon.path_mm[i]);
  for (std::size_t i = 0; i < photon.bounces.size(); ++i) {
    if (photon.bounces[i] == 0) continue;
    if (change.traced_reflectance[i] == 0.0)
      throw std::invalid_argument("a photon that survived a surface of no reflectance");
    factor *= std::pow(change.wanted_reflectance[i] / change.traced_reflectance[i], photon.bounces[i]);
  }
  return factor * std::exp(power);
}

/// Which condition of validity fails; empty when none does.
std::string objection(const Reweighted& result, const OpticalChange& change) {
  for (std::size_t i = 0; i < change.traced_reflectance.size(); ++i)
    if (change.traced_reflectance[i] == 0.0 && change.wanted_reflectance[i] > 0.0)
      return fmt::format("surface {} reflected nothing when traced: no photon knows what lies behind it", i);
  if (result.effective_photons < kLeastEffective)
    return fmt::format("{:.0f} effective photons; {:.0f} are needed", result.effective_photons,
                       kLeastEffective);
  if (result.effective_share < kLeastShare)
    return fmt::format("the weights are worth {:.1f} % of the photons; {:.0f} % are needed",
                       100.0 * result.effective_share, 100.0 * kLeastShare);
  if (result.largest_share > kLargestShare)
    return fmt::format("one photon has {:.1f} % of the weight; {:.0f} % are allowed",
                       100.0 * result.largest_share, 100.0 * kLargestShare);
  return {};
}

}  // namespace

Reweighted reweight(std::span<const PhotonHistory> detected, std::uint64_t emitted,
                    const OpticalChange& change) {
  check_change(change);
  if (emitted == 0 || emitted < detected.size())
    throw std::invalid_argument("fewer photons emitted than detected, or none");
  double sum = 0.0, squares = 0.0, largest = 0.0;
  for (const PhotonHistory& photon : detected) {
    const double weight = weight_of(photon, change);
    sum += weight;
    squares += weight * weight;
    largest = std::max(largest, weight);
  }
  const auto photons = static_cast<double>(emitted);
  Reweighted result;
  result.detected_fraction = {sum / photons,
                              std::sqrt(std::max(0.0, squares - sum * sum / photons)) / photons};
  if (squares > 0.0) {
    result.effective_photons = sum * sum / squares;
    result.effective_share = result.effective_photons / static_cast<double>(detected.size());
    result.largest_share = largest / sum;
  }
  result.reason = objection(result, change);
  result.valid = result.reason.empty();
  return result;
}

}  // namespace scintray
