#pragma once
/// A surface table as comma-separated values, one row per direction.

#include <filesystem>

#include "scintray/optics/table.hpp"

namespace scintray::tables {

/// Writes every node of both sides and all wavelengths (0: not stated): wavelength (nm), side, incidence,
/// way, middle of the cell in polar angle and |azimuth| (deg), probability density of the outgoing direction
/// (1/sr, per incident photon), and its standard error from the rays of the table. Cells are 5 deg of
/// polar angle by 15 deg of |azimuth|, on both sides of the plane of incidence; the densities times the
/// cells' solid angles add up to the reflectance or transmittance. Lines that begin with # describe the
/// surface of the table. SystemError when it cannot be written.
void write_table_csv(const std::filesystem::path& path, const optics::SurfaceTable& table);

}  // namespace scintray::tables
