#pragma once
/// Reading of tabulated scattering functions in the layout of bsdf_text.hpp (Zemax, "BSDF Data Interchange
/// File Format Specification", R. Rykowski 2008, pages 3 and 4 of the knowledge base's article 229).

#include <string>
#include <string_view>
#include <vector>

#include "scintray/tables/brdf_table.hpp"
#include "scintray/tables/bsdf_text.hpp"

namespace scintray::tables {

/// The scattering function of a file: reflected light of one orientation of the sample, at one wavelength.
/// Azimuths may extend to 360 deg. Throws InputError, at the line of `file`, for a word or a number that is
/// out of place or out of range, for transmitted light, several orientations and tristimulus values, and
/// where the values of an angle of incidence add up to another share of the light than stated (TIS), by a
/// fifth or more.
Bsdf parse_bsdf(std::string_view content, const std::string& file);

/// The values above the horizon and above 0, as measured values without a wavelength (0 nm). A value of 0 is
/// one that was not measured.
std::vector<BrdfPoint> brdf_points(const Bsdf& bsdf);

}  // namespace scintray::tables
