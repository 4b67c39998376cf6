#pragma once
/// Reflectors: sheets behind a face that reflect, absorb and may transmit light.

#include <optional>
#include <string>

#include "scintray/core/curve.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/reflection_log.hpp"

namespace scintray::optics {

/// Polarisation of light after a reflection by Lambert's law.
enum class PaintPolarisation {
  random,  ///< multiple scattering depolarises
  /// As in Geant4 when light returns through a back-painted face: its boundary process continues with the
  /// vector from before the paint, whose component perpendicular to the plane of incidence is taken as such
  /// and all the rest as parallel (G4OpBoundaryProcess::DielectricDielectric). The plane is here that of the
  /// mean face.
  geant4
};

/// A sheet that reflects on both of its sides.
struct Reflector {
  std::string name;
  core::Curve reflectance;      ///< against wavelength (nm)
  double specular_share = 0.0;  ///< share of reflected light that is specular; the rest is Lambertian
  /// Volume-like reflectors (PTFE, paint): index of the binder, 0 for none. Light is refracted into it, and
  /// the light scattered back, Lambertian inside, is refracted out or reflected back into it; `reflectance`
  /// is then that of the volume for diffuse light from within. After L. B. Wolff 1994, J. Opt. Soc. Am. A 11,
  /// 2956, "Diffuse-reflectance model for smooth dielectric surfaces".
  double volume_index = 0.0;
  /// Share of the light that is transmitted to the other side, against wavelength (nm); nothing: none. The
  /// sum with `reflectance` is at most 1 at every wavelength; the remainder is absorbed. Of a volume-like
  /// reflector, that of the volume for diffuse light from within.
  std::optional<core::Curve> transmittance = std::nullopt;
  PaintPolarisation polarisation = PaintPolarisation::random;  ///< of light reflected by Lambert's law
  /// Transmitted light keeps its direction, whatever the indices and `specular_share`, as in Geant4 at a
  /// back-painted face (G4OpBoundaryProcess::DoTransmission, release 11.4); it then obeys no etendue.
  bool undeflected = false;
};

/// Outcome of light incident on a reflector.
enum class SheetOutcome { back, through, absorbed };

/// The side of a sheet on which light is incident.
struct SheetSide {
  core::Vec3 normal;    ///< unit normal of the sheet, opposed to the ray
  double index_here;    ///< of the medium of incidence
  double index_beyond;  ///< of the medium behind the sheet
};

/// Interaction of `ray` with a reflector: reflection, transmission or absorption.
///
/// The specular share of transmitted light continues as through a film: refracted by Snell's law from
/// `index_here` to `index_beyond`, without further loss. The rest leaves by Lambert's law on the far side, as
/// from a diffuser. Where the far side has the lower index, light beyond the critical angle and the share
/// 1 - (index_beyond / index_here)^2 of the diffuse light are not transmitted (the conservation of etendue,
/// W. T. Welford and R. Winston, High Collection Nonimaging Optics, 1989, chapter 2) and return like light
/// reflected by the sheet. `transmittance` is therefore that between equal indices, or from the side of lower
/// index, and the sheet is reciprocal between any two media. A volume-like reflector passes light through its
/// binder instead, and both faces refract.
///
/// @param log  receives reflections survived in a draw against the reflectance, not those at the face of a
///             volume-like reflector, and no transmission; may be null
SheetOutcome interact_at_reflector(const Reflector& reflector, Ray& ray, const SheetSide& side,
                                   double wavelength_nm, core::Rng& rng, ReflectionLog* log = nullptr);

/// Largest share of the light that is not absorbed, reflectance and transmittance together, over all
/// wavelengths. At most 1 for a physical sheet.
double most_kept(const Reflector& reflector);

/// One of two equal faces, separated by a clear space, that together have the reflectance and transmittance
/// of `sheet`: r = R / (1 + T) and t = sqrt(T (1 - r^2)), from the sum over the reflections between them (G.
/// G. Stokes 1862, Proc. R. Soc. London 11, 545), at 1 nm steps. A sheet without transmittance is returned
/// unchanged.
Reflector face_of_sheet(const Reflector& sheet);

}  // namespace scintray::optics
