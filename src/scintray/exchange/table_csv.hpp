#pragma once
/// A surface table as comma-separated values, one row a direction.

#include <filesystem>

#include "scintray/optics/table.hpp"

namespace scintray::exchange {

/// Writes every node of both sides and all wavelengths (0: not stated): wavelength (nm), side, incidence,
/// way, middle of the cell in polar angle and |azimuth| (deg), probability density of leaving so (1/sr, given
/// that light meets the surface), and its standard error from the rays behind the table. Cells are 5 deg of
/// polar angle by 15 deg of |azimuth|, on both sides of the plane of incidence; the densities times the
/// cells' solid angles add up to the reflectance or transmittance. Lines that begin with # say what the table
/// is for.
void write_table_csv(const std::filesystem::path& path, const optics::SurfaceTable& table);

}  // namespace scintray::exchange
