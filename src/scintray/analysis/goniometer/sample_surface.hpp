#pragma once
/// A surface of the database between two media at one wavelength, for the goniometer.

#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/surface_factory.hpp"

namespace scintray::analysis {

/// The surface, the media on both sides, and the wavelength.
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

/// The surface with these names, including its table.
/// @param on_the_spot  rays are traced on the height map or recipe itself, without a table
/// @throws InputError for unknown names (with the nearest), for a medium, gap or reflector without a value at
///         the wavelength, and for errors of the definitions
SampleSurface make_sample_surface(const materials::MaterialDatabase& database,
                                  materials::SurfaceFactory& factory, const SamplePlace& place,
                                  bool on_the_spot = false);

/// True when the surface has facets of its own, and so a visible slope.
bool has_facets(const optics::Surface& surface);

/// Mean visible slope: mean angle (rad) between the mean normal and the first facet hit by light from `side`
/// at an incidence angle in [0, 90 deg): traced with 40,000 rays on a height map, interpolated from a table's
/// nodes (then without an error), 0 for a smooth surface. InputError for surfaces without facets of their own
/// (statistical models, painted, mixtures, tables of stacks).
core::Estimate mean_visible_slope(const optics::Surface& surface, optics::Side side, double incidence_rad);

}  // namespace scintray::analysis
