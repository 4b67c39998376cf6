#pragma once
/// Wavelength shifters (dyes and phosphors): absorption at one wavelength and re-emission at a longer one.

#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/core/philox.hpp"
#include "scintray/optics/decay_time.hpp"

namespace scintray::optics {

/// Photon energy at a vacuum wavelength, eV: hc = 1239.841984 eV nm (SI 2019, exact).
constexpr double photon_energy_eV(double wavelength_nm) { return 1239.8419843320026 / wavelength_nm; }

/// Numbers and energies of photons absorbed by wavelength shifters; each is re-emitted or kept.
struct ShiftCount {
  std::uint64_t absorbed = 0;  ///< photons
  std::uint64_t emitted = 0;   ///< photons re-emitted
  double before_eV = 0.0;      ///< energy at absorption of the re-emitted photons
  double after_eV = 0.0;       ///< energy at emission of these; the difference is the Stokes loss
  double kept_eV = 0.0;        ///< energy of photons not re-emitted

  ShiftCount& operator+=(const ShiftCount& other);
  bool operator==(const ShiftCount& other) const = default;
};

/// A re-emitted photon.
struct ShiftedLight {
  double wavelength_nm = 0.0;
  double delay_ns = 0.0;
};

/// A wavelength shifter. Immutable.
///
/// An absorbed photon is re-emitted with the probability of the quantum yield at its wavelength. The new
/// wavelength is drawn from the emission spectrum beyond the absorbed one, so that no photon gains energy;
/// where the spectrum is zero beyond it, the photon is kept. Geant4's G4OpWLS does the same by drawing again.
/// Light absorbed by a dye within its own emission band is thus re-emitted at slightly longer wavelengths
/// than by Kasha's rule, by which the difference is taken from thermal energy.
class WavelengthShifter {
 public:
  /// @param absorption_per_mm  1/absorption length of the shifter alone, against wavelength (nm)
  /// @param quantum_yield      photons re-emitted per photon absorbed, 0 to 1, against wavelength (nm)
  /// @param emission           relative number of photons per nm against wavelength (nm), a table
  /// @param decay              one component at least
  /// Throws InputError as CurveSampler does.
  WavelengthShifter(core::Curve absorption_per_mm, core::Curve quantum_yield, core::Curve emission,
                    std::vector<DecayComponent> decay);

  const core::Curve& absorption_per_mm() const { return absorption_per_mm_; }
  const core::Curve& quantum_yield() const { return quantum_yield_; }
  const core::Curve& emission() const { return emission_; }

  /// Wavelength and delay of an absorbed photon that is re-emitted; nothing when it is kept. Counts it in
  /// `count`.
  std::optional<ShiftedLight> absorb(double wavelength_nm, core::Rng& rng, ShiftCount& count) const;

 private:
  core::Curve absorption_per_mm_, quantum_yield_, emission_;
  core::CurveSampler spectrum_;
  std::vector<DecayComponent> decay_;
};

}  // namespace scintray::optics
