#pragma once
/// Other absorption lengths and reflectances without tracing again, from what detected photons went through.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"

namespace scintray {

/// The way of one detected photon, from its emission to its detection.
struct PhotonHistory {
  std::vector<float> path_mm;  ///< in each medium
  std::vector<std::uint32_t>
      bounces;  ///< interactions with each surface that the photon survived by its reflectance
};

/// Media and surfaces as they were traced, and as they are wanted.
struct OpticalChange {
  std::vector<double> traced_absorption_per_mm,
      wanted_absorption_per_mm;                                ///< per medium, 1 / absorption length
  std::vector<double> traced_reflectance, wanted_reflectance;  ///< per surface, 0 to 1
};

struct Reweighted {
  Estimate detected_fraction;      ///< of the emitted photons, under the wanted optics
  double effective_photons = 0.0;  ///< (sum of weights)^2 / sum of squares (L. Kish 1965, Survey Sampling)
  double effective_share = 0.0;    ///< over the photons detected when traced
  double largest_share = 0.0;      ///< of the sum of weights, that the heaviest photon has
  bool valid = false;
  std::string reason;  ///< when not valid: which condition fails
};

/// Weights each detected photon with the ratio of its probabilities of survival,
///
///     w = product over media of exp(-(wanted - traced) path) * product over surfaces of (wanted /
///     traced)^bounces,
///
/// which is exact in expectation for what changes survival only and not the way: absorption in media,
/// reflectances that do not depend on angle, wavelength or the surface's shape (importance sampling with the
/// way's density unchanged; J. M. Hammersley and D. C. Handscomb 1964, Monte Carlo Methods, section 5.4).
/// Indices, scattering and finishes change ways and cannot be had like this. The fraction is the sum of the
/// weights over the emitted photons, its error sqrt(sum w^2 - (sum w)^2 / emitted) / emitted.
///
/// Valid while the detected photons still represent the wanted ones: at least 100 effective photons, at least
/// a tenth of those traced, none with more than 2 % of the weight; and nothing that was lost entirely when
/// traced may be wanted back (a traced reflectance of 0 with a wanted one above it). Weights above 1, where
/// less is absorbed than when traced, come from few photons with long ways, and those absorbed then are not
/// there at all: the error counts the former only while the conditions hold.
/// @param emitted  photons emitted when traced, at least as many as `detected`
/// @throws std::invalid_argument when sizes differ, or a number is out of its range
Reweighted reweight(std::span<const PhotonHistory> detected, std::uint64_t emitted,
                    const OpticalChange& change);

}  // namespace scintray
