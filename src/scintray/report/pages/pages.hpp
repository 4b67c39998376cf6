#pragma once
/// The self-contained HTML pages, which load nothing from elsewhere: runs, comparisons, goniometer, surfaces,
/// height maps, fits.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/fit/fit_record.hpp"
#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/measured_profile.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/report/run_analysis.hpp"
#include "scintray/report/view/view_page.hpp"
#include "scintray/tally/result.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray::report {

/// The page: the main result first, then events, fates, sensors, angles, paths, the scene in three
/// dimensions, conditions and the scene file.
std::string html_report(const tally::RunResult& run, const RunAnalysis& analyses = {},
                        const RunView& view = {});

/// Writes the page under a temporary name and renames it, so that a partly written page is never found.
/// Throws SystemError with path and reason.
void write_report(const std::filesystem::path& path, const tally::RunResult& run,
                  const RunAnalysis& analyses = {}, const RunView& view = {});

/// A measurement shown with the reflected light of the only reading.
struct Overlay {
  analysis::ScaledProfile scaled;
  std::string name;  ///< of its file
};

/// Media, indices and wavelength of a sample: "LSO (n 1.8270) to air (n 1.0003), 420 nm, from inside".
std::string sample_text(const analysis::SampleSurface& sample, optics::Side side);

/// One self-contained page: shares with errors, mean directions and widths, and for each reading the
/// in-plane profile and maps of reflected and transmitted light.
std::string goniometer_page(const analysis::SampleSurface& sample,
                            const std::vector<analysis::GoniometerReading>& readings,
                            const std::optional<Overlay>& overlay);

/// Scale of a measurement and its deviation: "scaled by 0.0123, to the same area as ...".
std::string overlay_text(const Overlay& overlay);

/// Readings of a surface that could be made.
struct SurfaceReadings {
  analysis::SampleSurface sample;
  std::vector<analysis::GoniometerReading> sweep;  ///< over incidence, increasing
  analysis::GoniometerReading profile;             ///< at one incidence
};

struct SurfaceEntry {
  std::string name;
  materials::SurfaceOutline outline;
  std::optional<SurfaceReadings> readings;
  std::string not_made;  ///< reason why there are no readings
};

/// One self-contained page: for each surface its model, sources and needs, and, where it was made,
/// reflectance and absorptance against incidence beside Fresnel, and the in-plane profile. `under` states
/// the media and the wavelength.
std::string surface_page(const std::vector<SurfaceEntry>& entries, const std::string& under);

/// One self-contained HTML page: both maps, which show the same part of a surface, as pictures, a line
/// profile along x and one along y through their middles, the numbers of both, and the steps. `before` is
/// shown less its mean height. InputError when every point of a map is missing.
std::string map_page(const std::string& title, const topography::HeightMap& before,
                     const topography::HeightMap& after);

/// Writes the page. Throws SystemError on failure.
void write_map_page(const std::filesystem::path& path, const std::string& title,
                    const topography::HeightMap& before, const topography::HeightMap& after);

/// Page of a fit: measured points, the curves of the start and of the result, residuals, parameters.
std::string fit_page(const analysis::FitRecord& record);

/// A result with the name under which it is shown.
struct NamedResult {
  std::string name;
  tally::RunResult run;
  RunAnalysis analyses;
};

/// A quantity of a point in several results.
struct ComparedNumber {
  std::string point;                                  ///< label of the point: its swept values
  std::string quantity;                               ///< "detected", "energy resolution (FWHM)", ...
  std::vector<std::optional<core::Estimate>> values;  ///< in the order of the results; nothing: it has none
  /// Difference from the first result over the standard error of the difference, for each result; nothing for
  /// the first, for one without the quantity, and where both errors are zero.
  std::vector<std::optional<double>> sigmas;
};

/// Quantities of all points that the first result has, in its order: shares of the photons by fate, light and
/// photons detected per event, photopeak, resolution, depth of interaction and coincidence time resolution.
/// Points are matched by their swept values; a single point by itself. Quantities of fewer than two results
/// are left out. @throws std::invalid_argument without results
std::vector<ComparedNumber> compare_results(const std::vector<NamedResult>& results);

/// The comparison for a terminal: a table, the largest difference, and the probability of such a difference
/// by chance.
std::string comparison_text(const std::vector<NamedResult>& results);

/// The comparison as JSON: the names of the results, and of each quantity of each point its values (null:
/// none) and differences in sigma, the effects that the figures do not include, and the cautions.
std::string comparison_json(const std::vector<NamedResult>& results);

/// The comparison as a self-contained page.
std::string comparison_page(const std::vector<NamedResult>& results);

}  // namespace scintray::report
