#pragma once
/// Light in birefringent media: uniaxial and biaxial crystals without optical activity.
///
/// In such a medium light of a direction has one of two linear polarisations, each with its own refractive
/// index; the direction of its energy (the ray) is not that of its wave normal. A ray in the medium is a
/// `Ray` as elsewhere: `direction` is the ray, along which the photon travels, and `polarisation` the
/// electric field, which is across it. The two determine the mode, with its wave normal and index: with D =
/// epsilon E and H along (ray x E), the wave normal is along D x H, and n^2 = D.D / E.D.
///
/// Light that splits in two does so by chance, with the shares of the power: the two parts of one photon's
/// field do not interfere with each other afterwards. That holds where their retardation is many wavelengths
/// over the spectrum of the light, as in crystals of millimetres, and not in wave plates.
///
/// Equations: Maxwell's, for plane waves; those of faces are in birefringent_faces.cpp.
/// tests/surface/birefringence_test.cpp checks them against closed forms.

#include <array>
#include <optional>
#include <type_traits>

#include "scintray/core/curve.hpp"
#include "scintray/core/plain_vec.hpp"
#include "scintray/optics/fresnel.hpp"

namespace scintray::optics {

/// Light whose electric field is along one of the principal axes of a medium.
struct PrincipalAxis {
  core::Curve index;                       ///< refractive index against wavelength (nm)
  std::optional<core::Curve> group_index;  ///< nothing: from the slope of `index`
  core::Curve absorption_per_mm;           ///< without re-emission, against wavelength (nm)
};

/// True when light of two axes has the same properties.
bool alike(const PrincipalAxis& a, const PrincipalAxis& b);

/// What makes a medium birefringent.
struct Birefringence {
  std::array<PrincipalAxis, 3> axes;  ///< x, y, z
  /// Directions of the principal axes, in columns; a rotation.
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
};

/// A birefringent medium at one wavelength.
struct BirefringentOptics {
  std::array<double, 3> index, group_index, absorption_per_mm;  ///< of the principal axes
  core::PlainMatrix3 directions;                                ///< of the axes, in columns; world
  core::PlainMatrix3 permittivity;                              ///< relative; world
  /// Power that a dipole along each of the principal axes radiates, relative to their mean: all 1 until
  /// find_dipole_emission.
  std::array<double, 3> dipole_emission{1.0, 1.0, 1.0};

  BirefringentOptics(const Birefringence& medium, double wavelength_nm);
  /// The same with directions in a frame.
  BirefringentOptics in_frame(const core::Frame& frame) const;
  /// Sets `dipole_emission`, the integral over all waves of emission (emit_isotropic) times the squares of
  /// the components of their fields, within 1e-8 where the indices are in a ratio of up to 1.7 (3e-3 for a
  /// ratio of 4). For a uniaxial crystal the integral is that of a closed form: a dipole along the optic axis
  /// radiates 4 n_o^2 / (n_e^2 + 3 n_o^2) times as much as one across it.
  void find_dipole_emission();
};
static_assert(std::is_trivially_copyable_v<BirefringentOptics>);

/// Numbers of the mode of a ray in a birefringent medium.
struct ModeOptics {
  core::Vec3 wave_normal;          ///< unit vector
  double index = 1.0;              ///< of the wave, along its normal
  double group_index = 1.0;        ///< c over the speed of the energy along the ray
  double absorption_per_mm = 0.0;  ///< along the ray
  /// Rate per path at which dipoles of random orientation scatter it, relative: the square of its field over
  /// the flux of energy, 1 / (n cos) with the angle between ray and normal.
  double dipole_rate = 1.0;
  /// The same of dipoles along its field, as in Rayleigh scattering: times the power that they radiate.
  double rayleigh_rate = 1.0;
};

/// The mode of a ray that has one (take_mode).
ModeOptics mode_of(const BirefringentOptics& medium, const Ray& ray);

/// True when the ray's polarisation is one of the two of its direction.
bool has_mode(const BirefringentOptics& medium, const Ray& ray);

/// Draws one of the two modes of the direction for a ray that has neither, with the shares of its field as
/// probabilities; for an unpolarised ray with equal ones. A ray that has a mode keeps it.
void take_mode(const BirefringentOptics& medium, Ray& ray, core::Rng& rng);

/// Draws direction and polarisation of light from dipoles of random orientation. Per solid angle of wave
/// normals the emission into a mode is proportional to the density of states, n^2 n_g, and to the square of
/// the field of a photon, n / (n_g E.D) for a unit vector E: their product is n / cos^2 of the angle between
/// ray and normal.
void emit_isotropic(const BirefringentOptics& medium, Ray& ray, core::Rng& rng);

/// Rayleigh scattering: as emit_isotropic, with the square of the cosine between the fields before and after.
/// With ModeOptics::rayleigh_rate each way is as frequent as its reverse.
void scatter_rayleigh(const BirefringentOptics& medium, Ray& ray, core::Rng& rng);

/// Shares of the power of what leaves a face between media of which one is birefringent at least, of light of
/// the power 1: two reflected modes, then two transmitted ones (in a medium of one index: polarised across
/// and in the plane of incidence). Arguments as for interact_at_birefringent.
std::array<double, 4> power_shares(const Ray& ray, const core::Vec3& m, const FaceMedium& here,
                                   const FaceMedium& behind);

}  // namespace scintray::optics
