#include "scintray/analysis/goniometer/surface_analysis.hpp"

#include <map>
#include <utility>

namespace scintray::analysis {

namespace {

/// Visible slopes on surfaces, which do not depend on the medium behind them: each is traced once. They are
/// traced on the height map itself where there is one: towards grazing incidence they increase too fast for
/// the nodes of a table.
class SlopeReader {
 public:
  SlopeReader(const materials::MaterialDatabase& database, materials::SurfaceFactory& surfaces)
      : database_(database), surfaces_(surfaces) {}

  /// At every incidence; empty when the surface has no facets of its own.
  const std::vector<core::Estimate>& read(const SamplePlace& place,
                                          const std::vector<double>& incidence_rad) {
    const auto [known, is_new] = read_.try_emplace({place.surface, incidence_rad});
    if (!is_new) return known->second;
    const optics::Surface surface = make_sample_surface(database_, surfaces_, place, true).surface;
    if (has_facets(surface))
      for (const double incidence : incidence_rad)
        known->second.push_back(mean_visible_slope(surface, optics::Side::inside, incidence));
    return known->second;
  }

 private:
  const materials::MaterialDatabase& database_;
  materials::SurfaceFactory& surfaces_;
  std::map<std::pair<std::string, std::vector<double>>, std::vector<core::Estimate>> read_;
};

SurfaceAnalysis analyze_surface(const scene_file::GoniometerSpec& goniometer, const SampleSurface& sample,
                                std::uint64_t seed) {
  SurfaceAnalysis analysis;
  analysis.goniometer = goniometer.title;
  analysis.place = sample.place;
  analysis.index = sample.index;
  analysis.rays = goniometer.rays;
  analysis.incidence_rad = goniometer.incidence_rad;
  GoniometerSettings settings;
  settings.wavelength_nm = goniometer.wavelength_nm;
  settings.rays = goniometer.rays;
  settings.seed = seed;
  for (const GoniometerReading& reading :
       sweep_incidence(sample.surface, sample.index, settings, goniometer.incidence_rad))
    analysis.reflectance.push_back(reading.reflectance());
  settings.stream = goniometer.incidence_rad.size();
  settings.incidence_rad = goniometer.directions_at_rad;
  analysis.directions = read_goniometer(sample.surface, sample.index, settings);
  return analysis;
}

}  // namespace

std::vector<SurfaceAnalysis> analyze_surfaces(const std::vector<scene_file::GoniometerSpec>& goniometers,
                                              const materials::MaterialDatabase& database,
                                              materials::SurfaceFactory& surfaces, std::uint64_t seed) {
  std::vector<SurfaceAnalysis> analyses;
  SlopeReader slopes(database, surfaces);
  core::Problems problems;
  for (const scene_file::GoniometerSpec& goniometer : goniometers)
    for (const config::NameRef& outside : goniometer.outside)
      for (const config::NameRef& surface : goniometer.surfaces) {
        try {
          const SamplePlace place{surface.name, goniometer.inside.name, outside.name,
                                  goniometer.wavelength_nm};
          analyses.push_back(
              analyze_surface(goniometer, make_sample_surface(database, surfaces, place), seed));
          analyses.back().slope_rad = slopes.read(place, goniometer.incidence_rad);
        } catch (const core::InputError& error) {
          for (core::Problem problem : error.problems()) {
            if (problem.where.file.empty()) problem.where = surface.where;
            problems.add(problem);
          }
        }
      }
  problems.throw_if_any();
  return analyses;
}

}  // namespace scintray::analysis
