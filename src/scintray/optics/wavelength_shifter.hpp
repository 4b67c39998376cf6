#pragma once
/// Dyes and phosphors: light absorbed at one wavelength and re-emitted at a longer one.

#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/core/philox.hpp"
#include "scintray/optics/decay_time.hpp"

namespace scintray::optics {

/// Energy of a photon of a wavelength in vacuum, eV: hc = 1239.841984 eV nm (SI 2019, exact).
constexpr double photon_energy_eV(double wavelength_nm) { return 1239.8419843320026 / wavelength_nm; }

/// What wavelength shifters did: every photon that one absorbs is re-emitted or kept.
struct ShiftCount {
  std::uint64_t absorbed = 0;  ///< photons
  std::uint64_t emitted = 0;   ///< photons re-emitted
  double before_eV = 0.0;      ///< energy of those re-emitted, as they were absorbed
  double after_eV = 0.0;       ///< ... and as they were re-emitted; the difference is the Stokes loss
  double kept_eV = 0.0;        ///< energy of those not re-emitted

  ShiftCount& operator+=(const ShiftCount& other);
  bool operator==(const ShiftCount& other) const = default;
};

/// A photon re-emitted.
struct ShiftedLight {
  double wavelength_nm = 0.0;
  double delay_ns = 0.0;
};

/// A wavelength shifter. Immutable.
///
/// A photon that it absorbs comes back with the quantum yield of its wavelength. The new wavelength is
/// drawn from the emission spectrum beyond the absorbed one, so that no photon gains energy; where the
/// spectrum has nothing beyond it, the photon is kept. This is what Geant4's G4OpWLS does by drawing again.
/// Light that a dye absorbs within its own emission band thus comes back a little redder than by Kasha's
/// rule, which takes the difference from heat.
class WavelengthShifter {
 public:
  /// @param absorption_per_mm  1/absorption length of the shifter alone, against wavelength (nm)
  /// @param quantum_yield      photons re-emitted per photon absorbed, 0 to 1, against wavelength (nm)
  /// @param emission           relative number of photons per nm against wavelength (nm), a table
  /// @param decay              at least one component
  /// Throws InputError as CurveSampler does.
  WavelengthShifter(core::Curve absorption_per_mm, core::Curve quantum_yield, core::Curve emission,
                    std::vector<DecayComponent> decay);

  const core::Curve& absorption_per_mm() const { return absorption_per_mm_; }
  const core::Curve& quantum_yield() const { return quantum_yield_; }
  const core::Curve& emission() const { return emission_; }

  /// Absorbs a photon, and counts it. Nothing when it is kept.
  std::optional<ShiftedLight> absorb(double wavelength_nm, core::Rng& rng, ShiftCount& count) const;

 private:
  core::Curve absorption_per_mm_, quantum_yield_, emission_;
  core::CurveSampler spectrum_;
  std::vector<DecayComponent> decay_;
};

}  // namespace scintray::optics
