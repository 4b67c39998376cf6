#pragma once
/// Interaction of the atoms of one element with gammas of 10 keV to 3 MeV.
///
/// Data from xraylib 4 (T. Schoonjans et al. 2011, Spectrochim. Acta B 66 776,
/// doi:10.1016/j.sab.2011.09.011), and beyond their range formulae with their source below.

#include <array>
#include <vector>

#include "scintray/core/constants.hpp"
#include "scintray/core/rng.hpp"

namespace scintray::source {

inline constexpr double kFineStructure = 1.0 / 137.035999;  ///< CODATA 2018

/// Interaction process of a gamma with an atom.
enum class GammaProcess { photoelectric, compton, rayleigh, pair };
inline constexpr std::array<GammaProcess, 4> kGammaProcesses{
    GammaProcess::photoelectric, GammaProcess::compton, GammaProcess::rayleigh, GammaProcess::pair};

/// A characteristic X-ray.
struct XrayLine {
  double energy_keV = 0.0;
  double most = 1.0;  ///< cumulative share of the K X-rays, this one included
};

/// Photoelectric absorption in the K shell and the subsequent K fluorescence.
struct KShell {
  double edge_keV = 0.0;
  double share = 0.0;           ///< of the photoelectric absorptions above the edge: 1 - 1/jump ratio
  double yield = 0.0;           ///< K X-rays per vacancy
  std::vector<XrayLine> lines;  ///< empty when not available
};

/// Cross sections and angular distributions of one element. Immutable.
class ElementData {
 public:
  /// @param atomic_number  1 to kGreatestAtomicNumber
  explicit ElementData(int atomic_number);

  int atomic_number() const { return z_; }

  /// Cross section, cm2/g, at an energy of 10 keV to 3 MeV.
  ///  - photoelectric: xraylib to 790 keV, beyond that proportional to the K shell's Born cross section (F.
  ///    Sauter 1931, Ann. Phys. 403 217; the form of Heitler, Quantum Theory of Radiation, eq. 21.16),
  ///  - compton: Klein-Nishina times the incoherent scattering function, integrated,
  ///  - rayleigh: Thomson times the form factor squared, integrated,
  ///  - pair: the fit of Geant4's Physics Reference Manual (Bethe-Heitler model; 1.5 MeV and up within
  ///    5 %) to J. H. Hubbell, H. A. Gimm and I. Overbo 1980, J. Phys. Chem. Ref. Data 9 1023; from the
  ///    threshold to 1.5 MeV it rises as (E - 2 m)^2.
  double cross_section_cm2_per_g(GammaProcess process, double energy_keV) const;

  /// Incoherent scattering function per electron, 0 to 1, of x = sin(angle / 2) E / hc, 1/angstrom.
  double incoherent(double x) const;

  /// Cosine of the angle of Rayleigh scattering, drawn at random: x^2 by the integral of the form factor
  /// squared, accepted with (1 + cos^2) / 2.
  double sample_rayleigh_cosine(double energy_keV, core::Rng& rng) const;

  const KShell& k_shell() const { return k_; }
  /// Absorption edges from 10 keV on, keV.
  const std::vector<double>& edges_keV() const { return edges_; }

 private:
  void tabulate_scattering();
  void read_k_shell();
  double photoelectric(double energy_keV) const;
  double pair_barn(double energy_keV) const;
  double rayleigh_barn(double energy_keV) const;
  double compton_barn(double energy_keV) const;
  /// Integral over solid angle of `weight`(t, i) at t = sin(angle / 2), i its point of the grid of x.
  template <class Weight>
  double integrate(double energy_keV, const Weight& weight) const;

  int z_;
  double atoms_per_g_barn_ = 0.0;            ///< cm2/g per barn an atom
  std::vector<double> x_;                    ///< 1/angstrom, logarithmic
  std::vector<double> incoherent_;           ///< per electron, at x_
  std::vector<double> form_factor_squared_;  ///< at x_
  std::vector<double> form_integral_;        ///< of the form factor squared over x^2, up to x_
  KShell k_;
  std::vector<double> edges_;
};

/// 1 / (hc) in 1/(keV angstrom): the momentum transfer x = sin(angle / 2) E / hc is this times E in keV times
/// the sine.
inline constexpr double kPerAngstromPerkeV = 1.0 / 12.398419843320026;

}  // namespace scintray::source
