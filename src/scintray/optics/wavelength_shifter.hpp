#pragma once
/// Wavelength shifters (dyes and phosphors): absorption at one wavelength and re-emission at others.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/units.hpp"
#include "scintray/optics/decay_time.hpp"

namespace scintray::optics {

/// Photon energy at a vacuum wavelength, eV.
constexpr double photon_energy_eV(double wavelength_nm) { return core::kHc_eV_nm / wavelength_nm; }

/// Numbers and energies of photons absorbed by wavelength shifters; each is re-emitted or kept.
struct ShiftCount {
  std::uint64_t absorbed = 0;    ///< photons
  std::uint64_t emitted = 0;     ///< of these, photons re-emitted, as one or more
  std::uint64_t additional = 0;  ///< photons re-emitted beyond one for each of `emitted`
  double before_eV = 0.0;        ///< energy at absorption of the photons re-emitted
  double after_eV = 0.0;         ///< energy of all photons at their emission
  double kept_eV = 0.0;          ///< energy of photons not re-emitted

  ShiftCount& operator+=(const ShiftCount& other);
  bool operator==(const ShiftCount& other) const = default;
};

/// A re-emitted photon.
struct ShiftedLight {
  double wavelength_nm = 0.0;
  double delay_ns = 0.0;
};

/// Number of photons re-emitted per photon absorbed, about its mean, the quantum yield.
enum class ShiftStatistics {
  single,  ///< none or one
  poisson  ///< Poisson distributed, as of Geant4's WLSMEANNUMBERPHOTONS
};

/// Wavelengths of re-emitted light by that of the absorbed photon.
enum class ShiftRule {
  no_gain,  ///< the spectrum beyond the absorbed wavelength: no photon gains energy; Geant4's G4OpWLS
  kasha     ///< the whole spectrum, whatever the absorbed wavelength; the difference is heat (M. Kasha 1950,
            ///< cited from memory)
};

/// One dye or phosphor.
struct Fluorophore {
  core::Curve absorption_per_mm;      ///< 1/absorption length of it alone, against wavelength (nm)
  core::Curve quantum_yield;          ///< mean number re-emitted per photon absorbed, against wavelength (nm)
  core::Curve emission;               ///< relative number of photons per nm against wavelength (nm), a table
  std::vector<DecayComponent> decay;  ///< one component at least
  ShiftStatistics statistics = ShiftStatistics::single;
  ShiftRule rule = ShiftRule::no_gain;
};

/// The wavelength shifters of a medium: one fluorophore or several, which absorb side by side. Immutable.
///
/// A photon is absorbed by one of them, in proportion to their coefficients at its wavelength, and re-emitted
/// as a number of photons about that one's quantum yield; the wavelength of each is drawn by its rule, its
/// delay from its decay times. By ShiftRule::no_gain a photon is kept where the spectrum is zero beyond its
/// wavelength; Geant4's G4OpWLS and G4OpWLS2 (11.4) limit the energies in the same way.
class WavelengthShifter {
 public:
  /// @param absorption_per_mm  1/absorption length of the shifter alone, against wavelength (nm)
  /// @param quantum_yield      photons re-emitted per photon absorbed, 0 to 1, against wavelength (nm)
  /// @param emission           relative number of photons per nm against wavelength (nm), a table
  /// @param decay              one component at least
  /// Throws InputError as CurveSampler does.
  WavelengthShifter(core::Curve absorption_per_mm, core::Curve quantum_yield, core::Curve emission,
                    std::vector<DecayComponent> decay);
  /// @param fluorophores  one at least
  /// Throws InputError as CurveSampler does.
  explicit WavelengthShifter(std::vector<Fluorophore> fluorophores);

  /// 1/absorption length of all fluorophores together, against wavelength (nm).
  const core::Curve& absorption_per_mm() const { return absorption_per_mm_; }
  const std::vector<Fluorophore>& fluorophores() const { return fluorophores_; }
  /// True when more photons may be re-emitted than were absorbed.
  bool multiplies() const { return multiplies_; }

  /// The fluorophore that absorbs a photon, drawn at random in proportion to the coefficients. With one
  /// fluorophore no random number is drawn.
  std::size_t pick(double wavelength_nm, core::Rng& rng) const;

  /// Wavelength and delay of an absorbed photon that is re-emitted, the first one of several; nothing when it
  /// is kept. Counts it in `count`.
  /// @param more  receives the others; without it they are drawn, so that the random numbers are the same
  std::optional<ShiftedLight> absorb(double wavelength_nm, core::Rng& rng, ShiftCount& count,
                                     std::vector<ShiftedLight>* more = nullptr) const;
  /// The same by a given fluorophore.
  std::optional<ShiftedLight> absorb_by(std::size_t fluorophore, double wavelength_nm, core::Rng& rng,
                                        ShiftCount& count, std::vector<ShiftedLight>* more = nullptr) const;

 private:
  std::vector<Fluorophore> fluorophores_;
  std::vector<core::CurveSampler> spectra_;
  core::Curve absorption_per_mm_;
  bool multiplies_ = false;
};

}  // namespace scintray::optics
