#pragma once
/// Reweighting of detected photons to other absorption lengths and reflectances, without tracing.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/tally/photon_history.hpp"

namespace scintray::analysis {

/// History of one detected photon, from its emission to its detection.
struct PhotonHistory {
  std::span<const float> path_mm;              ///< path length in each medium
  std::span<const float> absorption_depth;     ///< there: integral of 1 / absorption length as traced
  std::span<const std::uint32_t> reflections;  ///< survived at each reflector
  std::span<const float> reflection_depth;     ///< there: sum of -ln(reflectance) as traced
};

/// Target of an absorption coefficient or a reflectance.
struct WantedProperty {
  enum class As {
    traced,    ///< unchanged
    constant,  ///< `value` (1/mm; 0 to 1) at all wavelengths
    times,     ///< `value` times the traced one, at every wavelength
  };
  As as = As::traced;
  double value = 0.0;
};

/// Media and reflectors as traced, and their targets.
struct OpticalChange {
  std::vector<tally::TracedRange> traced_absorption_per_mm;  ///< per medium, over the wavelengths in use
  std::vector<WantedProperty> absorption_per_mm;
  std::vector<tally::TracedRange> traced_reflectance;  ///< per reflector
  std::vector<WantedProperty> reflectance;
  std::vector<std::string> reflector_names;  ///< for messages
};

struct Reweighted {
  core::Estimate detected_fraction;  ///< of the emitted photons, with the target optics
  core::Estimate relative;           ///< relative to the traced one: the mean weight
  double effective_photons = 0.0;    ///< (sum of weights)^2 / sum of squares (L. Kish 1965, Survey Sampling)
  double effective_share = 0.0;      ///< over the photons detected when traced
  double largest_share = 0.0;        ///< of the largest weight in the sum of weights
  double tail_shape = 0.0;           ///< of the weights, when photons of larger weight may be missing; else 0
  bool valid = false;
  std::string reason;  ///< when not valid: which condition fails
};

/// Reweighting: each detected photon has as weight the ratio of its probabilities of survival with the target
/// optics and with the traced ones,
///
///     ln w = sum over media of (traced depth - target depth)
///          + sum over reflectors of (reflections ln(target) + traced reflection depth),
///
/// which is exact in expectation for changes of survival only, not of the path: absorption in media, and
/// reflectances that do not depend on angle (importance sampling with the density of paths unchanged; J. M.
/// Hammersley and D. C. Handscomb 1964, Monte Carlo Methods, section 5.4). They may depend on wavelength: a
/// photon's depths are those at its own. Indices, scattering and finishes change paths and cannot be treated
/// like this. The fraction is the sum of the weights over the emitted photons, its error sqrt(sum w^2 - (sum
/// w)^2 / emitted) / emitted.
///
/// Valid while the detected photons represent the target:
/// - at least 100 effective photons, at least a tenth of those traced, none with more than 2 % of the weight;
/// - no target restores a complete loss of the traced optics (a reflectance of 0);
/// and where the target loses less, so that photons of larger weight than any detected one may exist:
/// - one more reflection of the photon of largest weight would not raise its share above 2 % either;
/// - the tail of the weights falls faster than the power law whose variance is infinite: its shape, Hill's
///   estimate (B. M. Hill 1975, Ann. Statist. 3, 1163) from the 3 sqrt(photons) largest weights, at most a
///   fifth of them, is below 1/2 (A. Vehtari, D. Simpson, A. Gelman, Y. Yao and J. Gabry 2024, J. Mach.
///   Learn. Res. 25(72), use that number and that limit for importance sampling);
/// - photons that the run cut are fewer than the error of the fraction.
class Reweighting {
 public:
  /// @param detected  number of photons that will be added
  /// @throws std::invalid_argument when sizes differ, or a number is out of its range: a negative or infinite
  ///         absorption, a target reflectance outside 0 to 1 at some wavelength in use
  Reweighting(OpticalChange change, std::uint64_t detected);

  /// Adds a photon and returns its weight. @throws std::invalid_argument for another number of media or
  /// reflectors
  double add(const PhotonHistory& photon);

  /// @param emitted    photons emitted when traced, at least as many as were added (std::invalid_argument)
  /// @param cut_share  share of them that the run cut at its limits
  Reweighted finish(std::uint64_t emitted, double cut_share = 0.0) const;

 private:
  double log_weight(const PhotonHistory& photon) const;
  void keep_largest(double log_weight);
  double tail_shape() const;
  std::string objection(const Reweighted& result, double cut_share) const;

  OpticalChange change_;
  std::vector<double> log_wanted_;    ///< per reflector: of the constant or the factor; -infinity for 0
  bool gains_ = false;                ///< some loss is smaller than traced
  double greatest_step_ = 1.0;        ///< weight of one more reflection, at most
  std::size_t tail_ = 0;              ///< number of the largest weights to keep: the tail and its threshold
  std::vector<double> largest_logs_;  ///< a heap, the smallest on top
  std::uint64_t count_ = 0;
  double sum_ = 0.0, squares_ = 0.0, largest_ = 0.0;
};

}  // namespace scintray::analysis
