#pragma once
/// The self-contained HTML pages beside that of a run: goniometer, surfaces, height maps, fits.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/fit/fit_record.hpp"
#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/measured_profile.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray::report {

/// A measurement shown beside the reflected light of the only reading.
struct Overlay {
  analysis::ScaledProfile scaled;
  std::string name;  ///< of its file
};

/// "LSO (n 1.8270) to air (n 1.0003), 420 nm, from inside".
std::string sample_text(const analysis::SampleSurface& sample, optics::Side side);

/// One self-contained page: shares with errors, mean directions and widths, and for each reading the
/// in-plane profile and maps of reflected and transmitted light.
std::string goniometer_page(const analysis::SampleSurface& sample,
                            const std::vector<analysis::GoniometerReading>& readings,
                            const std::optional<Overlay>& overlay);

/// "scaled by 0.0123, to the same area as ...": how a measurement was brought to scale, and how far off it
/// is.
std::string overlay_text(const Overlay& overlay);

/// What was read of a surface that could be made.
struct SurfaceReadings {
  analysis::SampleSurface sample;
  std::vector<analysis::GoniometerReading> sweep;  ///< over incidence, increasing
  analysis::GoniometerReading profile;             ///< at one incidence
};

struct SurfaceEntry {
  std::string name;
  materials::SurfaceOutline outline;
  std::optional<SurfaceReadings> readings;
  std::string not_made;  ///< why there are no readings
};

/// One self-contained page: for each surface its model, sources and needs, and, where it was made,
/// reflectance and absorptance against incidence beside Fresnel, and the in-plane profile. `under` states
/// between what and at which wavelength.
std::string surface_page(const std::vector<SurfaceEntry>& entries, const std::string& under);

/// One self-contained HTML page: both maps, which show the same part of a surface, as pictures, a line
/// profile along x and one along y through their middles, the numbers of both, and the steps. `before` is
/// shown less its mean height. InputError when every point of a map is missing.
std::string map_page(const std::string& title, const topography::HeightMap& before,
                     const topography::HeightMap& after);

/// Writes the page. SystemError when it cannot.
void write_map_page(const std::filesystem::path& path, const std::string& title,
                    const topography::HeightMap& before, const topography::HeightMap& after);

/// Measured points, the curves of the start and of what was found, residuals, parameters.
std::string fit_page(const analysis::FitRecord& record);

}  // namespace scintray::report
