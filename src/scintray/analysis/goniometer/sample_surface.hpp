#pragma once
/// A surface of the database between two media at one wavelength, ready for the goniometer.

#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/surface_factory.hpp"

namespace scintray::analysis {

/// What lies where.
struct SamplePlace {
  std::string surface;
  std::string inside, outside;  ///< media
  double wavelength_nm = 0.0;
};

struct SampleSurface {
  SamplePlace place;
  optics::Surface surface;
  optics::IndexPair index;
  std::vector<std::string> sources, warnings;
};

/// Looks the names up and makes the surface, its table included.
/// @param on_the_spot  rays on height maps and recipes are followed on the map itself, without a table
/// InputError for unknown names (with the nearest), for a medium, gap or reflector that has no value at the
/// wavelength, and for what the database and the factory refuse.
SampleSurface make_sample_surface(const materials::MaterialDatabase& database,
                                  materials::SurfaceFactory& factory, const SamplePlace& place,
                                  bool on_the_spot = false);

/// True when the surface has facets of its own whose slopes light can hit.
bool has_facets(const optics::Surface& surface);

/// Mean angle (rad) between the mean normal and the first facet hit, by light from `side` at an incidence
/// angle in [0, 90 deg): traced with 40,000 rays on a height map, interpolated from a table's nodes (then
/// without an error), 0 for a smooth surface.
/// InputError for surfaces without known facets (statistical models, painted, mixtures, tables of stacks).
core::Estimate mean_visible_slope(const optics::Surface& surface, optics::Side side, double incidence_rad);

}  // namespace scintray::analysis
