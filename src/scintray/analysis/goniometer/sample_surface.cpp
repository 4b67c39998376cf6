#include "scintray/analysis/goniometer/sample_surface.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scintray/materials/wavelength_cover.hpp"
#include "scintray/optics/height_field.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/topography/map_statistics.hpp"

namespace scintray::analysis {

namespace {

constexpr std::uint64_t kSlopeRays = 40'000;

/// Mean visible slope at the first wavelength, over all azimuths: facets do not depend on wavelength.
double slope_in_table(const optics::SurfaceTable& table, optics::Side side, double incidence_rad) {
  double sum = 0.0;
  for (std::size_t slice = 0; slice < table.azimuths(); ++slice)
    sum += table.mean_slope(side, incidence_rad, slice);
  return sum / static_cast<double>(table.azimuths());
}

}  // namespace

SampleSurface make_sample_surface(const materials::MaterialDatabase& database,
                                  materials::SurfaceFactory& factory, const SamplePlace& place,
                                  bool on_the_spot) {
  core::Problems problems;
  const auto looked_up = [&](auto look_up, const std::string& name) {
    try {
      return look_up(name);
    } catch (const core::InputError& error) {
      problems.add(error);
      return decltype(look_up(name)){};
    }
  };
  const optics::Medium inside =
      looked_up([&](const std::string& name) { return database.medium(name); }, place.inside);
  const optics::Medium outside =
      looked_up([&](const std::string& name) { return database.medium(name); }, place.outside);
  materials::SurfaceSpec spec =
      looked_up([&](const std::string& name) { return database.surface(name); }, place.surface);
  problems.throw_if_any();

  const double nm = place.wavelength_nm;
  if (!(nm > 0.0))
    problems.add({}, fmt::format("a wavelength of {:g} nm; expected more than 0", nm), "as \"420 nm\"");
  for (const optics::Medium* medium : {&inside, &outside})
    materials::check_cover(problems, {}, *medium, nm, nm);
  materials::check_cover(problems, spec, nm, nm);
  problems.throw_if_any();

  if (on_the_spot) spec = materials::traced_on_the_spot(std::move(spec));
  materials::MadeSurface made = factory.make(spec, inside, outside, nm, nm, nm);
  SampleSurface sample;
  sample.place = place;
  sample.surface = std::move(made.surface);
  sample.index = {inside.index(nm), outside.index(nm)};
  sample.sources = std::move(spec.sources);
  sample.warnings = std::move(made.warnings);
  return sample;
}

bool has_facets(const optics::Surface& surface) {
  if (!surface.mixture.empty()) return false;
  if (const auto* table = surface.microsurface.get_if<optics::SurfaceTable>())
    return table->provenance().stack.empty();  // not available in a table of a stack
  return surface.microsurface->kind() == optics::MicrosurfaceKind::smooth ||
         surface.microsurface.get_if<optics::HeightField>();
}

core::Estimate mean_visible_slope(const optics::Surface& surface, optics::Side side, double incidence_rad) {
  if (!has_facets(surface))
    throw core::InputError({{},
                            "surface \"" + surface.name + "\" has no facets whose slopes could be visible",
                            "slopes are those of a height map, a recipe, a table of one, or a smooth face"});
  if (const auto* map = surface.microsurface.get_if<optics::HeightField>())
    return topography::mean_visible_slope(*map, side, incidence_rad, kSlopeRays);
  if (const auto* table = surface.microsurface.get_if<optics::SurfaceTable>())
    return {slope_in_table(*table, side, incidence_rad), 0.0};
  return {};
}

}  // namespace scintray::analysis
