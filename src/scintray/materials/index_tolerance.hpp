#pragma once
/// Whether a surface table is for the indices that it is used between.

#include "scintray/materials/microsurface_spec.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::materials {

/// Relative change of an index ratio that a table may be used over.
inline constexpr double kIndexTolerance = 0.01;

/// Relative difference between the ratio of indices in a setting and the table's, at a wavelength. Of a table
/// that lets nothing through, only the inside index matters.
double index_mismatch(const optics::SurfaceTable& table, const SurfaceSetting& setting, double wavelength_nm);

}  // namespace scintray::materials
