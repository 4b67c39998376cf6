#pragma once
/// Coverage of the wavelengths in use by quantities tabulated against wavelength.

#include <string>

#include "scintray/core/error.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::materials {

/// A curve against wavelength, with the words of its message: "WHOSE has WHAT from ... to ... nm, but light
/// of ... nm is in use".
struct TabulatedCurve {
  const core::Curve& curve;
  std::string whose, what, hint;
};

/// Adds a problem at `where` unless the curve covers [low_nm, high_nm].
void check_cover(core::Problems& problems, const core::FileLocation& where, const TabulatedCurve& tabulated,
                 double low_nm, double high_nm);

/// The same for the medium's refractive index, and the absorption and re-emission of its wavelength shifter.
void check_cover(core::Problems& problems, const core::FileLocation& where, const optics::Medium& medium,
                 double low_nm, double high_nm);

/// The same for gap and reflector of a surface, and of the shares of its mixture.
void check_cover(core::Problems& problems, const SurfaceSpec& surface, double low_nm, double high_nm);

}  // namespace scintray::materials
