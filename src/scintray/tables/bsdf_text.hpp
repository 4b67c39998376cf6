#pragma once
/// Tabulated scattering functions as text, in the layout of the "BSDF Data Interchange file format" that
/// Zemax OpticStudio, LightTools and others read (Radiant Zemax knowledge base, article 50076; Zemax,
/// "Zemax Tabular BSDF data file format").

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/tables/brdf_table.hpp"
#include "scintray/tables/import_settings.hpp"
#include "scintray/tables/table_side.hpp"

namespace scintray::tables {

/// Angles of the table, deg. `specular` are the angles of the reflected or refracted ray, the format's
/// AngleOfIncidence. The azimuth is measured about that ray from the side of the normal, 0 to 180; the radial
/// angle from that ray, 0 to 180.
struct BsdfAngles {
  std::vector<double> specular, azimuth, radial;
};

/// 0 to 85 deg in steps of 5, azimuths in steps of 10, radial angles from 0.5 deg apart near the specular
/// ray to 5 deg apart far from it.
BsdfAngles default_bsdf_angles();

/// A scattering function on such angles: mean radiance over irradiance (1/sr) in the cell about each point,
/// whose borders lie halfway to the next.
struct Bsdf {
  BsdfAngles angles;
  std::vector<double> total;   ///< per specular angle: reflectance or transmittance
  std::vector<double> values;  ///< [specular][azimuth][radial], 1/sr; 0 below the horizon
};

struct BsdfSettings {
  optics::Side side = optics::Side::inside;
  Leaving way = Leaving::reflected;
  std::size_t slice = 0;        ///< of the table, as from slice_at
  std::uint64_t rays = 200000;  ///< quasi-random points of the distribution, for each specular angle
  std::uint64_t seed = 1;
  BsdfAngles angles = default_bsdf_angles();
};

/// Scattering function of a surface table. For transmitted light, specular angles without a refracted ray are
/// left out, and so is all light incident beyond the critical angle. Throws InputError when nothing is left.
Bsdf bsdf_of(const optics::SurfaceTable& table, const BsdfSettings& settings);

/// Solid angle of each cell weighted by the cosine to the normal (sr), [azimuth][radial], on both sides of
/// the plane of incidence and above the horizon: the sum of the values times this is the total.
/// @param parts  subdivisions of each side of a cell
std::vector<double> projected_cells(const BsdfAngles& angles, double specular_rad, int parts = 24);

/// Writes the text; SystemError when it cannot be written.
void write_bsdf(const std::filesystem::path& path, const Bsdf& bsdf, const optics::SurfaceTable& table,
                const BsdfSettings& settings);

/// The scattering function of a file: light of one way, at one orientation of the sample and one wavelength.
/// Azimuths may extend to 360 deg. Throws InputError, at the line of `file`, for a word or a number that is
/// out of place or out of range, for light of the other way, several orientations and tristimulus values, and
/// where the values of an angle of incidence integrate to a share that differs from the stated one (TIS) by a
/// fifth or more (chosen).
Bsdf parse_bsdf(std::string_view content, const std::string& file, Leaving way = Leaving::reflected);

/// The values above the horizon and above 0, as measured values without a wavelength (0 nm). A value of 0 is
/// one that was not measured.
std::vector<BrdfPoint> brdf_points(const Bsdf& bsdf);

/// A surface table of scattering functions of light from inside. Between two angles both are interpolated,
/// each about its specular ray; beyond the last one they are constant. Beyond the critical angle, where the
/// format has no ray to refer to, nothing is transmitted. What is neither reflected nor transmitted is
/// absorbed.
/// @param transmitted  null: nothing is transmitted
optics::SurfaceTable bsdf_table(const Bsdf& reflected, const Bsdf* transmitted,
                                const ImportSettings& settings, const std::string& name);

}  // namespace scintray::tables
