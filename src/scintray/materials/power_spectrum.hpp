#pragma once
/// Power spectra of surfaces in CSV files.

#include <filesystem>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::materials {

/// Power spectrum of a CSV file: spatial frequencies (first column) and two-dimensional, isotropic power
/// spectral densities (second column), in the given units: an inverse length such as "1/um", and a length to
/// the fourth power such as "um4". Throws InputError, at the file's lines, for frequencies that are not
/// positive and increasing, for negative densities and for fewer than two rows; at `where`, for wrong units.
topography::SpectrumRelief read_power_spectrum(const std::filesystem::path& path,
                                               const std::string& frequency_unit,
                                               const std::string& density_unit,
                                               const core::FileLocation& where = {});

}  // namespace scintray::materials
