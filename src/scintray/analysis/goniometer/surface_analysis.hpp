#pragma once
/// Readings of the surfaces of a scene's goniometers over angles of incidence: figures 6 to 8 of E. Roncali
/// and S. R. Cherry 2013, Phys. Med. Biol. 58, 2185.

#include <string>
#include <vector>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/scene_file/goniometer.hpp"

namespace scintray::analysis {

/// Readings of one surface between two media.
struct SurfaceAnalysis {
  std::string goniometer;  ///< its title
  SamplePlace place;
  optics::IndexPair index;
  std::uint64_t rays = 0;  ///< per incidence
  std::vector<double> incidence_rad;
  std::vector<core::Estimate> reflectance;  ///< at each, of light from inside
  std::vector<core::Estimate> slope_rad;    ///< mean angle of the facets hit first; empty: it has no facets
  /// Reading at one incidence; of its settings only incidence and rays are meaningful.
  GoniometerReading directions;
};

/// Readings of every surface of every goniometer, in their order, the surface varying fastest.
/// @param database   with the scene's own definitions
/// @param surfaces  makes them, as for the crystals
/// @param seed      of the rays
/// @throws InputError as make_sample_surface, with the place in the scene
std::vector<SurfaceAnalysis> analyze_surfaces(const std::vector<scene_file::GoniometerSpec>& goniometers,
                                              const materials::MaterialDatabase& database,
                                              materials::SurfaceFactory& surfaces, std::uint64_t seed);

}  // namespace scintray::analysis
