#pragma once
/// Other absorption lengths and reflectances without tracing again, from what detected photons went through.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/tally/photon_history.hpp"

namespace scintray::analysis {

/// The way of one detected photon, from its emission to its detection.
struct PhotonHistory {
  std::span<const float> path_mm;              ///< in each medium
  std::span<const float> absorption_depth;     ///< there: integral of 1 / absorption length as traced
  std::span<const std::uint32_t> reflections;  ///< survived at each reflector
  std::span<const float> reflection_depth;     ///< there: sum of -ln(reflectance) as traced
};

/// How an absorption coefficient or a reflectance is wanted.
struct WantedProperty {
  enum class As {
    traced,    ///< as it was
    constant,  ///< `value` (1/mm; 0 to 1) at all wavelengths
    times,     ///< `value` times what it was, at every wavelength
  };
  As as = As::traced;
  double value = 0.0;
};

/// Media and reflectors as they were traced, and as they are wanted.
struct OpticalChange {
  std::vector<tally::TracedRange> traced_absorption_per_mm;  ///< per medium, over the wavelengths in use
  std::vector<WantedProperty> absorption_per_mm;
  std::vector<tally::TracedRange> traced_reflectance;  ///< per reflector
  std::vector<WantedProperty> reflectance;
  std::vector<std::string> reflector_names;  ///< for messages
};

struct Reweighted {
  core::Estimate detected_fraction;  ///< of the emitted photons, under the wanted optics
  core::Estimate relative;           ///< to what was detected when traced: the mean weight
  double effective_photons = 0.0;    ///< (sum of weights)^2 / sum of squares (L. Kish 1965, Survey Sampling)
  double effective_share = 0.0;      ///< over the photons detected when traced
  double largest_share = 0.0;        ///< of the sum of weights, that the heaviest photon has
  double tail_shape = 0.0;           ///< of the weights, when photons of more weight may be missing; else 0
  bool valid = false;
  std::string reason;  ///< when not valid: which condition fails
};

/// Weights each detected photon with the ratio of its probabilities of survival under the wanted optics and
/// under those that it was traced with,
///
///     ln w = sum over media of (traced depth - wanted depth)
///          + sum over reflectors of (reflections ln(wanted) + traced reflection depth),
///
/// which is exact in expectation for what changes survival only and not the way: absorption in media, and
/// reflectances that do not depend on angle (importance sampling with the way's density unchanged; J. M.
/// Hammersley and D. C. Handscomb 1964, Monte Carlo Methods, section 5.4). They may depend on wavelength: a
/// photon's depths are those at its own. Indices, scattering and finishes change ways and cannot be had like
/// this. The fraction is the sum of the weights over the emitted photons, its error
/// sqrt(sum w^2 - (sum w)^2 / emitted) / emitted.
///
/// Valid while the detected photons still represent the wanted ones:
/// - at least 100 effective photons, at least a tenth of those traced, none with more than 2 % of the weight;
/// - nothing that was lost entirely when traced is wanted back (a reflectance of 0);
/// and where less is lost than when traced, so that photons of more weight than any that was seen may exist:
/// - one more reflection of the heaviest photon would not give it more than 2 % either;
/// - the tail of the weights falls faster than the power law whose variance is infinite: its shape, Hill's
///   estimate (B. M. Hill 1975, Ann. Statist. 3, 1163) from the 3 sqrt(photons) largest weights, at most a
///   fifth of them, is below 1/2 (A. Vehtari, D. Simpson, A. Gelman, Y. Yao and J. Gabry 2024, J. Mach.
///   Learn. Res. 25(72), use that number and that limit for importance sampling);
/// - photons that the run cut are fewer than the error of the fraction.
class Reweighting {
 public:
  /// @param detected  number of photons that will be added
  /// @throws std::invalid_argument when sizes differ, or a number is out of its range: a negative or infinite
  ///         absorption, a reflectance that is wanted outside 0 to 1 at some wavelength in use
  Reweighting(OpticalChange change, std::uint64_t detected);

  /// Takes a photon and returns its weight. @throws std::invalid_argument for another number of media or
  /// reflectors
  double add(const PhotonHistory& photon);

  /// @param emitted    photons emitted when traced, at least as many as were added (std::invalid_argument)
  /// @param cut_share  of them, that the run cut at its limits
  Reweighted finish(std::uint64_t emitted, double cut_share = 0.0) const;

 private:
  double log_weight(const PhotonHistory& photon) const;
  void keep_largest(double log_weight);
  double tail_shape() const;
  std::string objection(const Reweighted& result, double cut_share) const;

  OpticalChange change_;
  std::vector<double> log_wanted_;  ///< per reflector: of the constant or the factor; -infinity for 0
  bool gains_ = false;              ///< something is lost less than when traced
  double greatest_step_ = 1.0;      ///< weight of one more reflection, at most
  std::size_t tail_ = 0;            ///< number of the largest weights to keep: the tail and what it begins at
  std::vector<double> largest_logs_;  ///< a heap, the least on top
  std::uint64_t count_ = 0;
  double sum_ = 0.0, squares_ = 0.0, largest_ = 0.0;
};

}  // namespace scintray::analysis
