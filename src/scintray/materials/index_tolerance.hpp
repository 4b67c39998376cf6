#pragma once
/// Agreement of a surface table with the indices between which it is used.

#include "scintray/materials/microsurface_spec.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::materials {

/// Relative deviation of the index ratio up to which a table may be used. Chosen: beyond it a table file is
/// refused, and the dispersion over the wavelengths in use is warned of.
inline constexpr double kIndexTolerance = 0.01;

/// Relative difference between the ratio of indices in a setting and the table's, at a wavelength. For an
/// opaque table only the inside index is compared.
double index_mismatch(const optics::SurfaceTable& table, const SurfaceSetting& setting, double wavelength_nm);

}  // namespace scintray::materials
