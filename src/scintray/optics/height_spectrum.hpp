#pragma once
/// Power spectra of the heights of isotropic surfaces: how the squared height is distributed over spatial
/// frequencies. A spectrum is two-dimensional, S(f) in nm^4 at the frequency f in 1/nm.

#include <vector>

namespace scintray::optics {

/// A spectrum, by the integral of 2 pi f S(f).
class HeightSpectrum {
 public:
  virtual ~HeightSpectrum() = default;

  /// Mean square of the heights, nm^2, of frequencies up to one (1/nm; infinity: of all).
  virtual double variance_nm2(double per_nm) const = 0;
  /// The frequency (1/nm) up to which a share in [0, 1) of variance_nm2(limit_per_nm) lies.
  virtual double frequency_per_nm(double share, double limit_per_nm) const = 0;

 protected:
  HeightSpectrum() = default;
  HeightSpectrum(const HeightSpectrum&) = default;
  HeightSpectrum(HeightSpectrum&&) = default;
  HeightSpectrum& operator=(const HeightSpectrum&) = default;
  HeightSpectrum& operator=(HeightSpectrum&&) = default;
};

/// Heights of the autocorrelation function Sq^2 exp(-r^2 / T^2).
class GaussianSpectrum : public HeightSpectrum {
 public:
  GaussianSpectrum(double rms_nm, double correlation_nm) : rms_nm_(rms_nm), correlation_nm_(correlation_nm) {}
  double variance_nm2(double per_nm) const override;
  double frequency_per_nm(double share, double limit_per_nm) const override;

 private:
  double rms_nm_, correlation_nm_;
};

/// S(f) = A / (1 + (B f)^2)^((C + 1) / 2), C above 1: docs/surfaces.md, "Make".
class KCorrelationSpectrum : public HeightSpectrum {
 public:
  KCorrelationSpectrum(double rms_nm, double knee_nm, double exponent)
      : rms_nm_(rms_nm), knee_nm_(knee_nm), exponent_(exponent) {}
  double variance_nm2(double per_nm) const override;
  double frequency_per_nm(double share, double limit_per_nm) const override;

 private:
  /// Share of the squared height in frequencies up to one.
  double band(double per_nm) const;
  double rms_nm_, knee_nm_, exponent_;
};

/// A table, linear in log S against log f, in f and S where one of two values is 0; 0 beyond its ends.
class TabulatedSpectrum : public HeightSpectrum {
 public:
  /// @param per_nm  frequencies, positive, strictly increasing, two at least
  TabulatedSpectrum(std::vector<double> per_nm, std::vector<double> density_nm4);
  double variance_nm2(double per_nm) const override;
  double frequency_per_nm(double share, double limit_per_nm) const override;

 private:
  /// Variance between the start of a segment and a frequency in it.
  double within(std::size_t segment, double per_nm) const;

  std::vector<double> per_nm_, density_nm4_;
  std::vector<double> sums_nm2_;  ///< variance below each frequency
};

}  // namespace scintray::optics
