#pragma once
/// The sheet behind a face: reflects, absorbs, and may let some light through.

#include <optional>
#include <string>

#include "scintray/core/curve.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/reflection_log.hpp"

namespace scintray::optics {

/// A sheet that reflects, from either of its sides.
struct Reflector {
  std::string name;
  core::Curve reflectance;      ///< against wavelength (nm)
  double specular_share = 0.0;  ///< share of reflected light that is mirrored; the rest Lambertian
  /// Volume-like reflectors (PTFE, paint): index of the binder, 0 for none. Light is refracted into it, and
  /// the light scattered back, Lambertian inside, is refracted out or reflected in again; `reflectance` is
  /// then that of the volume for diffuse light from within. After L. B. Wolff 1994, J. Opt. Soc. Am. A 11,
  /// 2956, "Diffuse-reflectance model for smooth dielectric surfaces".
  double volume_index = 0.0;
  /// Share of the light that goes through to the other side, against wavelength (nm); nothing: none does.
  /// With `reflectance` at most 1 at every wavelength; what is left is absorbed. Of a volume-like
  /// reflector, that of the volume for diffuse light from within.
  std::optional<core::Curve> transmittance = std::nullopt;
};

/// Where light is after it reached a reflector.
enum class SheetOutcome { back, through, absorbed };

/// The side of a sheet that light reaches.
struct SheetSide {
  core::Vec3 normal;    ///< unit normal of the sheet, against the ray
  double index_here;    ///< of the medium the ray is in
  double index_beyond;  ///< of that behind the sheet
};

/// Sends `ray` back from a reflector, or through it.
///
/// The specular share of what passes goes straight on, as through a film: refracted by Snell's law from
/// `index_here` to `index_beyond`, without a loss of its own. The rest leaves by Lambert's law on the far
/// side, as from a diffuser. Where the far side is the thinner medium, light beyond the critical angle and
/// the share 1 - (index_beyond / index_here)^2 of the diffuse light find no way out (the conservation of
/// etendue, W. T. Welford and R. Winston, High Collection Nonimaging Optics, 1989, chapter 2) and come back
/// as light reflected by the sheet does. So `transmittance` is that between equal indices, or from the
/// thinner side, and the sheet is reciprocal between any two media. A volume-like reflector passes light
/// through its binder instead, and both faces refract.
///
/// @param log  takes what was sent back by a draw against the reflectance, not what a volume's face mirrored
///             or what passed; may be null
SheetOutcome interact_at_reflector(const Reflector& reflector, Ray& ray, const SheetSide& side,
                                   double wavelength_nm, core::Rng& rng, ReflectionLog* log = nullptr);

/// Largest share of the light that is not absorbed, reflectance and transmittance together, over all
/// wavelengths. At most 1 for a sheet that can be.
double most_kept(const Reflector& reflector);

/// One of two equal faces, with nothing but a clear space between, that reflect and let through together
/// what `sheet` does: r = R / (1 + T) and t = sqrt(T (1 - r^2)), from the sum over the turns between them
/// (G. G. Stokes 1862, Proc. R. Soc. London 11, 545), at 1 nm steps. A sheet that lets nothing through is
/// its own face.
Reflector face_of_sheet(const Reflector& sheet);

}  // namespace scintray::optics
