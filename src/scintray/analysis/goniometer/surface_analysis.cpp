#include "scintray/analysis/goniometer/surface_analysis.hpp"

#include <map>
#include <utility>

namespace scintray::analysis {

namespace {

/// Slopes met on surfaces, which do not depend on what lies behind them: each is traced once. They are met on
/// the height map itself where there is one: towards grazing incidence they rise too fast for a table's
/// nodes.
class SlopeReader {
 public:
  SlopeReader(const materials::Library& library, materials::SurfaceMaker& surfaces)
      : library_(library), surfaces_(surfaces) {}

  /// At every incidence; empty when the surface has no facets of its own.
  const std::vector<core::Estimate>& read(const BenchPlace& place, const std::vector<double>& incidence_rad) {
    const auto [known, is_new] = read_.try_emplace({place.surface, incidence_rad});
    if (!is_new) return known->second;
    const optics::Surface surface = make_bench_surface(library_, surfaces_, place, true).surface;
    if (has_facets(surface))
      for (const double incidence : incidence_rad)
        known->second.push_back(mean_slope_met(surface, optics::Side::inside, incidence));
    return known->second;
  }

 private:
  const materials::Library& library_;
  materials::SurfaceMaker& surfaces_;
  std::map<std::pair<std::string, std::vector<double>>, std::vector<core::Estimate>> read_;
};

SurfaceStudy study_surface(const scene_file::BenchSpec& bench, const BenchSurface& on_bench,
                           std::uint64_t seed) {
  SurfaceStudy study;
  study.bench = bench.title;
  study.place = on_bench.place;
  study.index = on_bench.index;
  study.rays = bench.rays;
  study.incidence_rad = bench.incidence_rad;
  GoniometerSettings settings;
  settings.wavelength_nm = bench.wavelength_nm;
  settings.rays = bench.rays;
  settings.seed = seed;
  for (const GoniometerReading& reading :
       sweep_incidence(on_bench.surface, on_bench.index, settings, bench.incidence_rad))
    study.reflectance.push_back(reading.reflectance());
  settings.stream = bench.incidence_rad.size();
  settings.incidence_rad = bench.directions_at_rad;
  study.directions = read_goniometer(on_bench.surface, on_bench.index, settings);
  return study;
}

}  // namespace

std::vector<SurfaceStudy> study_surfaces(const std::vector<scene_file::BenchSpec>& benches,
                                         const materials::Library& library, materials::SurfaceMaker& surfaces,
                                         std::uint64_t seed) {
  std::vector<SurfaceStudy> studies;
  SlopeReader slopes(library, surfaces);
  core::Problems problems;
  for (const scene_file::BenchSpec& bench : benches)
    for (const config::NameRef& outside : bench.outside)
      for (const config::NameRef& surface : bench.surfaces) {
        try {
          const BenchPlace place{surface.name, bench.inside.name, outside.name, bench.wavelength_nm};
          studies.push_back(study_surface(bench, make_bench_surface(library, surfaces, place), seed));
          studies.back().slope_rad = slopes.read(place, bench.incidence_rad);
        } catch (const core::InputError& error) {
          for (core::Problem problem : error.problems()) {
            if (problem.where.file.empty()) problem.where = surface.where;
            problems.add(problem);
          }
        }
      }
  problems.throw_if_any();
  return studies;
}

}  // namespace scintray::analysis
