#pragma once
/// Density of the detection time of the photons of an event, and the lower bounds on timing from it.

#include <cstddef>
#include <span>
#include <vector>

namespace scintray::analysis {

/// One exponential of the emission, as in a medium file.
struct EmissionTime {
  double decay_ns = 0.0;  ///< above 0
  double rise_ns = 0.0;   ///< 0: instantaneous
  double share = 1.0;     ///< of the light
};

/// Density of the time at which one photon is detected after an event at time 0: bi-exponential emission,
/// (exp(-t / decay) - exp(-t / rise)) / (decay - rise), smeared with a Gaussian (the sensor's jitter for
/// single photons and the spread of transit times).
class PhotonTime {
 public:
  /// @throws InputError for no emission, decays that are not positive, negative rise, jitter or shares, or
  /// shares that do not sum to 1 within 1e-6
  PhotonTime(std::vector<EmissionTime> emission, double jitter_sigma_ns);

  double density(double t_ns) const;
  /// Derivative of the density by time, 1/ns^2.
  double slope(double t_ns) const;
  /// Share of the photons detected before t.
  double before(double t_ns) const;

  const std::vector<EmissionTime>& emission() const { return emission_; }
  double jitter_ns() const { return jitter_ns_; }
  /// Times before and after which less than 1e-9 of the photons are detected.
  double earliest_ns() const;
  double latest_ns() const;

 private:
  /// The same three functions for one exponential alone.
  double one_density(double t_ns, double tau_ns) const;
  double one_before(double t_ns, double tau_ns) const;
  double edge(double t_ns) const;  ///< density of the jitter

  std::vector<EmissionTime> emission_;
  double jitter_ns_;
};

/// Fisher information about the time of an event, 1/ns^2, in the first `first` detected photons when their
/// number is Poisson distributed with mean `photons`:
///
///     I = photons * integral of p'(t)^2 / p(t) Prob(fewer than `first` photons before t) dt
///
/// That is the information of a Poisson process observed until its `first`-th point (D. L. Snyder and M. I.
/// Miller 1991, Random Point Processes in Time and Space: the log-likelihood of the points up to a
/// stopping time); with `first` large it is photons times that of one photon, the bound of S. Seifert, H. T.
/// van Dam and D. R. Schaart 2012, Phys. Med. Biol. 57, 1797. Integrals by GSL. Infinite without jitter: the
/// density then starts with a corner or a step, and no bound of this kind exists.
double time_information(const PhotonTime& time, double photons, std::size_t first);
/// Fisher information in all photons.
double time_information(const PhotonTime& time, double photons);
/// Fisher information in the time of the n-th photon alone, whose density is
/// photons p(t) exp(-m) m^(n - 1) / (n - 1)! with m = photons * (share before t).
double time_information_of_photon(const PhotonTime& time, double photons, std::size_t n);

/// FWHM of the difference of two independent event times that each have this information: no unbiased
/// estimator has less (Cramer and Rao).
double coincidence_bound_fwhm_ns(double information);

/// Expected time of the first of `photons` (Poisson) detected photons, given that there is one:
/// integral of (exp(-m(t)) - exp(-photons)) / (1 - exp(-photons)) from time 0 on, minus the part before it.
/// For an instantaneous rise without jitter and many photons this is decay / photons; for a rise that is not
/// instantaneous sqrt(pi rise decay / (2 photons)), since the share before t is then t^2 / (2 rise decay).
double mean_first_photon_ns(const PhotonTime& time, double photons);

/// Maximum-likelihood estimator of the event time: the maximum of the sum of
/// ln p(t_i - time), by Fisher scoring with halved steps. With one decay the density is a convolution of
/// log-concave ones and so log-concave itself: there is one maximum.
class MostLikelyTime {
 public:
  /// @throws InputError without jitter
  explicit MostLikelyTime(PhotonTime time);
  /// @param photon_times_ns  of all photons of one event, in any order  @throws InputError without photons
  double operator()(std::span<const double> photon_times_ns) const;

 private:
  PhotonTime time_;
  double information_;  ///< of one photon
};

}  // namespace scintray::analysis
