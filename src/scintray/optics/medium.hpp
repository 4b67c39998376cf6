#pragma once
/// Optical properties of a homogeneous medium.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/optics/birefringence.hpp"
#include "scintray/optics/composition.hpp"
#include "scintray/optics/decay_time.hpp"
#include "scintray/optics/wavelength_shifter.hpp"

namespace scintray::optics {

enum class ScatteringKind { isotropic, rayleigh };

/// Scattering by particles, in addition to that of the medium itself: two lobes of Henyey and Greenstein
/// 1941, Astrophys. J. 93, 70 (cited from memory), one forward and one backward, as Geant4's MIEHG. The mean
/// cosine is forward_share * forward_g - (1 - forward_share) * backward_g.
struct ParticleScattering {
  core::Curve per_mm;                        ///< 1/scattering length against wavelength (nm)
  double forward_g = 0.0, backward_g = 0.0;  ///< mean cosine of each lobe to its axis, within -1 and 1
  double forward_share = 1.0;                ///< of the scattered light, the forward lobe's
};

/// Kinds of particles whose scintillation light may differ, those of Geant4's G4Scintillation.
enum class Particle { electron, proton, deuteron, triton, alpha, ion };

/// Scintillation light of one kind of particle.
struct ParticleLight {
  Particle particle = Particle::electron;
  /// Mean number of photons of a particle that stops, against its kinetic energy (keV).
  core::Curve photons;
  std::optional<core::Curve> emission{};  ///< relative photon number per nm; nothing: as of all particles
  std::vector<DecayComponent> decay;      ///< empty: as of all particles
};

/// Optical properties of a medium at one wavelength, as transport uses them.
struct MediumOptics {
  double index = 1.0;              ///< refractive index n
  double group_index = 1.0;        ///< n - wavelength dn/dwavelength
  double absorption_per_mm = 0.0;  ///< including that of the wavelength shifter
  double scattering_per_mm = 0.0;  ///< including that of particles
};

/// A medium of the material database (`materials/media/NAME.toml`) or of a scene file.
struct Medium {
  std::string name;
  core::Curve index;  ///< refractive index against wavelength (nm); of a birefringent medium the axes' mean
  /// Group index against wavelength (nm), as measured; nothing: from the slope of `index`.
  std::optional<core::Curve> group_index;
  core::Curve absorption_per_mm;  ///< 1/absorption length (no re-emission) against wavelength (nm); 0: none
  core::Curve scattering_per_mm;  ///< 1/scattering length against wavelength (nm)
  ScatteringKind scattering = ScatteringKind::rayleigh;
  std::optional<ParticleScattering> particles;
  /// Indices and absorption by principal axis, of which `index` and `absorption_per_mm` are the means; null:
  /// light of every polarisation has the same.
  std::shared_ptr<const Birefringence> birefringence;
  /// Wavelength shifter, which absorbs in addition to `absorption_per_mm` and re-emits; null: none.
  std::shared_ptr<const WavelengthShifter> shifter;

  // Scintillation; a medium that does not scintillate has a zero yield.
  double yield_per_keV = 0.0;  ///< photons per keV
  /// Light per keV relative to the yield, against electron energy (keV).
  core::Curve relative_yield = core::Curve::constant(1.0);
  double intrinsic_fwhm = 0.0;  ///< spread of the light beyond counting statistics, full width at half
                                ///< maximum over mean, at `intrinsic_keV`; 0: none
  double intrinsic_keV = 0.0;
  /// kB of J. B. Birks 1951, Proc. Phys. Soc. A 64 874: the light per path is proportional to
  /// (dE/dx) / (1 + kB dE/dx). 0: proportional to the energy.
  double birks_mm_per_keV = 0.0;
  std::vector<ParticleLight> by_particle;  ///< of these kinds, in place of yield and relative yield
  core::Curve emission;                    ///< relative photon number per nm against wavelength (nm)
  std::vector<DecayComponent> decay;
  double density_g_per_cm3 = 0.0;    ///< 0: not available
  Composition composition;           ///< empty: not available; requires the density
  bool empty_space = false;          ///< declared as empty space: gammas pass
  std::vector<std::string> sources;  ///< published sources, as cited in reports

  /// Optical properties at a wavelength (nm). A group index that is not given follows from the slope of the
  /// index table (n_g = n - lambda dn/dlambda, e.g. Born & Wolf, Principles of Optics, section 1.3.4); a
  /// constant index gives n_g = n.
  MediumOptics at(double wavelength_nm) const;
};

}  // namespace scintray::optics
