#pragma once
/// Quantities written with their unit, such as "2 mm" or "0.5 1/cm".
///
/// Inside ScintRay: mm, ns, nm (wavelength only), rad, keV; lengths and wavelengths are distinct
/// dimensions here because their internal units differ.

#include <string>
#include <string_view>
#include <vector>

namespace scintray::core {

enum class Dimension {
  length,              ///< mm
  inverse_length,      ///< 1/mm
  wavelength,          ///< nm; photon energies ("2.95 eV") convert through hc
  time,                ///< ns
  frequency,           ///< 1/ns
  angle,               ///< rad
  energy,              ///< keV
  density,             ///< g/cm3
  photons_per_energy,  ///< photons/keV
  length_per_energy,   ///< mm/keV
  dimensionless,       ///< 1; "97 %" is accepted
};

/// Name of a dimension and its accepted units, for messages: "length", {"nm","um","mm",...}.
std::string dimension_name(Dimension dimension);
std::vector<std::string> units_of(Dimension dimension);

/// Value of a quantity written as text, in ScintRay's internal unit for `dimension`.
/// Throws InputError (no location; callers add theirs) on a malformed number, a missing unit, or a
/// unit of another dimension; the hint lists what is accepted.
double parse_quantity(std::string_view text, Dimension dimension);

/// Value of one `unit` in the internal unit; throws InputError for a unit of another dimension.
double unit_factor(std::string_view unit, Dimension dimension);

/// hc, for photon energy E (eV) = kHc_eV_nm / wavelength (nm). Exact SI values (CODATA 2018).
inline constexpr double kHc_eV_nm = 1239.8419843320026;

}  // namespace scintray::core
