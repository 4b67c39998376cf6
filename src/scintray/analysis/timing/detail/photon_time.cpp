#include "scintray/analysis/timing/detail/photon_time.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_erf.h>
#include <gsl/gsl_sf_gamma.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "scintray/analysis/fit/detail/gsl_errors.hpp"
#include "scintray/analysis/spectrum/peak_fit.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::analysis {

namespace {

/// exp(-21) and the tail of a Gaussian beyond 6 sigma are below 1e-9.
constexpr double kDecays = 21.0, kSigmas = 7.0;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Relative difference to which rise and decay times are separated: the formulas divide by their difference.
constexpr double kApart = 1e-6;

core::InputError bad_time(const std::string& what, const std::string& hint) {
  return core::InputError(core::Problem{{}, what, hint});
}

double rise_of(const EmissionTime& part) {
  const bool alike = std::abs(part.decay_ns - part.rise_ns) < kApart * part.decay_ns;
  return alike ? part.decay_ns * (1.0 - kApart) : part.rise_ns;
}

/// Integral over all times of the density: panels fine where it rises, growing with time after.
double integral(const PhotonTime& time, const std::function<double(double)>& function) {
  constexpr int kRisePanels = 64, kDecayPanels = 128;
  constexpr std::size_t kNodes = 20;
  struct FreeTable {
    void operator()(gsl_integration_glfixed_table* table) const { gsl_integration_glfixed_table_free(table); }
  };
  const std::unique_ptr<gsl_integration_glfixed_table, FreeTable> table(
      gsl_integration_glfixed_table_alloc(kNodes));
  if (!table) throw core::SystemError("no memory for an integral");
  const double first = time.earliest_ns(), last = time.latest_ns();
  std::vector<double> knots{first};
  const double risen = time.jitter_ns() > 0.0 ? std::min(-first, 0.5 * last) : 1e-9 * last;
  const int rise_panels = time.jitter_ns() > 0.0 ? kRisePanels : 1;
  for (int i = 1; i <= rise_panels; ++i) knots.push_back(first + (risen - first) * i / rise_panels);
  for (int i = 1; i <= kDecayPanels; ++i)
    knots.push_back(risen * std::pow(last / risen, static_cast<double>(i) / kDecayPanels));
  double sum = 0.0;
  for (std::size_t panel = 0; panel + 1 < knots.size(); ++panel)
    for (std::size_t node = 0; node < kNodes; ++node) {
      double at = 0.0, weight = 0.0;
      check_gsl(
          gsl_integration_glfixed_point(knots[panel], knots[panel + 1], node, &at, &weight, table.get()),
          "an integral over time");
      sum += weight * function(at);
    }
  return sum;
}

}  // namespace

PhotonTime::PhotonTime(std::vector<EmissionTime> emission, double jitter_sigma_ns)
    : emission_(std::move(emission)), jitter_ns_(jitter_sigma_ns) {
  silence_gsl();
  double shares = 0.0;
  for (const EmissionTime& part : emission_) {
    if (!(part.decay_ns > 0.0) || !(part.rise_ns >= 0.0) || !(part.share > 0.0) ||
        !std::isfinite(part.decay_ns))
      throw bad_time("an emission with a decay that is not positive, or a negative rise time or share",
                     "use a decay time above 0, a rise time of 0 or more, a share above 0");
    shares += part.share;
  }
  if (std::abs(shares - 1.0) > 1e-6)
    throw bad_time("the shares of the emission sum to " + std::to_string(shares) + "; expected 1",
                   "divide them by their sum");
  if (!(jitter_ns_ >= 0.0) || !std::isfinite(jitter_ns_))
    throw bad_time("a jitter of " + std::to_string(jitter_ns_) + " ns; expected 0 or more",
                   "use its standard deviation");
}

double PhotonTime::edge(double t_ns) const {
  if (jitter_ns_ == 0.0) return 0.0;
  const double u = t_ns / jitter_ns_;
  return std::exp(-0.5 * u * u) / (std::sqrt(core::kTwoPi) * jitter_ns_);
}

double PhotonTime::one_density(double t_ns, double tau_ns) const {
  if (jitter_ns_ == 0.0) return t_ns < 0.0 ? 0.0 : std::exp(-t_ns / tau_ns) / tau_ns;
  const double ratio = jitter_ns_ / tau_ns;
  const double power = 0.5 * ratio * ratio - t_ns / tau_ns;
  const double z = (ratio - t_ns / jitter_ns_) / std::sqrt(2.0);
  // Far before the event the power is large and the complementary error function small.
  if (z > 5.0) return 0.5 / tau_ns * std::exp(power + gsl_sf_log_erfc(z));
  return 0.5 / tau_ns * std::exp(power) * std::erfc(z);
}

double PhotonTime::one_before(double t_ns, double tau_ns) const {
  if (jitter_ns_ == 0.0) return t_ns < 0.0 ? 0.0 : -std::expm1(-t_ns / tau_ns);
  return 0.5 * std::erfc(-t_ns / (std::sqrt(2.0) * jitter_ns_)) - tau_ns * one_density(t_ns, tau_ns);
}

double PhotonTime::density(double t_ns) const {
  double sum = 0.0;
  for (const EmissionTime& part : emission_) {
    const double decay = part.decay_ns, rise = rise_of(part);
    const double here =
        rise == 0.0 ? one_density(t_ns, decay)
                    : (decay * one_density(t_ns, decay) - rise * one_density(t_ns, rise)) / (decay - rise);
    sum += part.share * here;
  }
  return std::max(0.0, sum);
}

double PhotonTime::slope(double t_ns) const {
  double sum = 0.0;
  for (const EmissionTime& part : emission_) {
    const double decay = part.decay_ns, rise = rise_of(part);
    // The smeared exponential g obeys g' = (jitter - g) / tau.
    sum += part.share * (rise == 0.0 ? (edge(t_ns) - one_density(t_ns, decay)) / decay
                                     : (one_density(t_ns, rise) - one_density(t_ns, decay)) / (decay - rise));
  }
  return sum;
}

double PhotonTime::before(double t_ns) const {
  double sum = 0.0;
  for (const EmissionTime& part : emission_) {
    const double decay = part.decay_ns, rise = rise_of(part);
    sum += part.share *
           (rise == 0.0 ? one_before(t_ns, decay)
                        : (decay * one_before(t_ns, decay) - rise * one_before(t_ns, rise)) / (decay - rise));
  }
  return std::clamp(sum, 0.0, 1.0);
}

double PhotonTime::earliest_ns() const { return -kSigmas * jitter_ns_; }

double PhotonTime::latest_ns() const {
  double slowest = 0.0;
  for (const EmissionTime& part : emission_) slowest = std::max({slowest, part.decay_ns, part.rise_ns});
  return kDecays * slowest + kSigmas * jitter_ns_;
}

double time_information(const PhotonTime& time, double photons, std::size_t first) {
  if (time.jitter_ns() == 0.0) return kInfinite;
  if (first == 0) return 0.0;
  return photons * integral(time, [&](double t) {
           const double p = time.density(t), slope = time.slope(t);
           if (!(p > 0.0)) return 0.0;
           return slope * slope / p *
                  gsl_cdf_poisson_P(static_cast<unsigned int>(first - 1), photons * time.before(t));
         });
}

double time_information(const PhotonTime& time, double photons) {
  if (time.jitter_ns() == 0.0) return kInfinite;
  return photons * integral(time, [&](double t) {
           const double p = time.density(t), slope = time.slope(t);
           return p > 0.0 ? slope * slope / p : 0.0;
         });
}

double time_information_of_photon(const PhotonTime& time, double photons, std::size_t n) {
  if (n == 0) return 0.0;
  if (time.jitter_ns() == 0.0) return kInfinite;
  const auto order = static_cast<double>(n);
  return integral(time, [&](double t) {
    const double p = time.density(t), share = time.before(t);
    if (!(p > 0.0) || !(share > 0.0)) return 0.0;
    const double expected = photons * share;
    const double density =
        photons * p * std::exp((order - 1.0) * std::log(expected) - expected - gsl_sf_lngamma(order));
    const double slope = time.slope(t) / p - photons * p + (order - 1.0) * p / share;
    return density * slope * slope;
  });
}

double coincidence_bound_fwhm_ns(double information) {
  return core::kFwhmPerSigma * std::sqrt(2.0 / information);
}

double mean_first_photon_ns(const PhotonTime& time, double photons) {
  return time.earliest_ns() + integral(time, [&](double t) {
           return (std::exp(-photons * time.before(t)) - std::exp(-photons)) / -std::expm1(-photons);
         });
}

MostLikelyTime::MostLikelyTime(PhotonTime time)
    : time_(std::move(time)), information_(time_information(time_, 1.0)) {
  if (!std::isfinite(information_))
    throw bad_time("a most likely time without jitter of single photons",
                   "set the jitter; without it the first photon determines the time");
}

double MostLikelyTime::operator()(std::span<const double> photon_times_ns) const {
  if (photon_times_ns.empty()) throw bad_time("an event without photons has no time", "leave it out");
  const auto likelihood = [&](double event) {
    double sum = 0.0;
    for (const double t : photon_times_ns) sum += std::log(std::max(time_.density(t - event), 1e-300));
    return sum;
  };
  const double total = information_ * static_cast<double>(photon_times_ns.size());
  const double fine = 1e-4 / std::sqrt(total);
  // From the first photon, before which the density of no photon vanishes.
  double event = *std::min_element(photon_times_ns.begin(), photon_times_ns.end());
  double best = likelihood(event);
  constexpr int kMostSteps = 60;
  for (int round = 0; round < kMostSteps; ++round) {
    double score = 0.0;
    for (const double t : photon_times_ns) {
      const double p = time_.density(t - event);
      if (p > 0.0) score -= time_.slope(t - event) / p;
    }
    double step = score / total;
    double next = likelihood(event + step);
    while (next < best && std::abs(step) > fine) {
      step *= 0.5;
      next = likelihood(event + step);
    }
    if (next > best) {
      event += step;
      best = next;
    }
    if (std::abs(step) <= fine) break;
  }
  return event;
}

}  // namespace scintray::analysis
