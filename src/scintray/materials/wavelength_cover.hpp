#pragma once
/// Whether what is tabulated against wavelength reaches as far as the light in use.

#include <string>

#include "scintray/core/error.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::materials {

/// A curve against wavelength, and how to speak of it: "WHOSE has WHAT from ... to ... nm, but light of ...
/// nm is in use".
struct TabulatedCurve {
  const core::Curve& curve;
  std::string whose, what, hint;
};

/// Adds a problem at `where` unless the curve covers [low_nm, high_nm].
void check_cover(core::Problems& problems, const core::FileLocation& where, const TabulatedCurve& tabulated,
                 double low_nm, double high_nm);

/// The medium's refractive index, and what its wavelength shifter absorbs and re-emits.
void check_cover(core::Problems& problems, const core::FileLocation& where, const optics::Medium& medium,
                 double low_nm, double high_nm);

/// Gap and reflector of a surface, and of those it is mixed of.
void check_cover(core::Problems& problems, const SurfaceSpec& surface, double low_nm, double high_nm);

}  // namespace scintray::materials
