#pragma once
/// Radiation of the nuclides of a source.

#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/scene_file/gamma_source.hpp"

namespace scintray::source {

/// Radiation of one decay, or of one emission of a source.
struct Emitted {
  std::vector<double> gammas_keV;     ///< independent and isotropic
  bool pair = false;                  ///< two annihilation gammas in addition
  std::vector<double> electrons_keV;  ///< deposited at the place of the decay: of one electron each
};

/// Sampling of the decays of the nuclides of a source. Immutable.
class DecaySampler {
 public:
  /// @param emission  one of the nuclides, or pair, or gamma (which emits nothing here)
  explicit DecaySampler(scene_file::Emission emission);
  Emitted sample(core::Rng& rng) const;

 private:
  scene_file::Emission emission_;
  core::CurveSampler beta_;
};

/// End point and transitions of 176Lu, keV: 99.66 % of its decays go to the 597 keV level of 176Hf, followed
/// by three transitions, each by a gamma or a conversion electron. The 0.34 % to the next level are treated
/// alike. Source: M. S. Basunia 2006, Nucl. Data Sheets 107 791 (ENSDF); the same numbers in H. Alva-Sanchez
/// et al. 2018, Sci. Rep. 8 17310, doi:10.1038/s41598-018-35684-x.
struct LutetiumTransition {
  double energy_keV;
  double gammas;  ///< per decay
};
inline constexpr double kLutetiumBetaEnd_keV = 593.0;
inline constexpr LutetiumTransition kLutetiumTransitions[]{{306.78, 0.936}, {201.83, 0.780}, {88.34, 0.145}};

/// 137Cs: one gamma. Source: E. Browne and J. K. Tuli 2007, Nucl. Data Sheets 108 2173 (ENSDF). The K X-rays
/// of barium (32 and 36 keV, 7 % of the decays) and all electrons are absorbed in the source's capsule.
inline constexpr double kCaesiumGamma_keV = 661.657;
inline constexpr double kCaesiumGammas = 0.851;

/// 22Na: one gamma, and a positron that annihilates at the place of the decay; its kinetic energy is
/// deposited in the source's capsule. Source: M. Galan 2010 in Table of Radionuclides (DDEP), BIPM-5 vol. 5:
/// 99.94 gammas of 1274.537 keV and 180.7 of 511 keV per 100 decays.
inline constexpr double kSodiumGamma_keV = 1274.537;
inline constexpr double kSodiumGammas = 0.9994;
inline constexpr double kSodiumPositrons = 0.9035;

/// Relative number of electrons per keV of an allowed beta decay against kinetic energy, keV: F(Z, E) p E
/// (Q - T)^2, with the Fermi function of a point nucleus cut at its radius 1.2 A^(1/3) fm (E. Fermi 1934, Z.
/// Phys. 88 161, eq. 38). Approximately also the shape of non-unique first forbidden decays, such as that of
/// 176Lu.
core::Curve beta_spectrum(double end_keV, int daughter_atomic_number, int mass_number);

}  // namespace scintray::source
