#include "scintray/analysis/bench_surface.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scintray/topography/map_statistics.hpp"

namespace scintray {

namespace {

constexpr std::uint64_t kSlopeRays = 40'000;

void check_covers(Problems& problems, const Curve& curve, double nm, const std::string& whose,
                  const std::string& what) {
  if (curve.covers(nm, nm)) return;
  problems.add({},
               fmt::format("{} has {} from {:g} to {:g} nm, but light of {:g} nm is asked for", whose, what,
                           curve.x().front(), curve.x().back(), nm),
               "choose another wavelength, or extend the table in its definition");
}

/// Everything of a surface, and of those it is mixed of, that is tabulated against wavelength.
void check_covers(Problems& problems, const SurfaceSpec& spec, double nm) {
  const std::string gap = "the gap of surface \"" + spec.name + "\"";
  check_covers(problems, spec.gap_index, nm, gap, "refractive indices");
  check_covers(problems, spec.gap_absorption_per_mm, nm, gap, "an absorption");
  if (spec.reflector)
    check_covers(problems, spec.reflector->reflectance, nm, "reflector \"" + spec.reflector->name + "\"",
                 "reflectances");
  for (const ShareSpec& part : spec.mixture) check_covers(problems, *part.surface, nm);
}

SurfaceSpec traced_on_the_spot(SurfaceSpec spec) {
  if (auto* map = std::get_if<HeightMapSpec>(&spec.microsurface)) map->table.reset();
  if (auto* recipe = std::get_if<RecipeSpec>(&spec.microsurface)) recipe->table.reset();
  for (ShareSpec& part : spec.mixture)
    part.surface = std::make_shared<const SurfaceSpec>(traced_on_the_spot(*part.surface));
  return spec;
}

/// Of the first wavelength, over all azimuths: facets do not change with the light's colour.
double slope_in_table(const SurfaceTable& table, Side side, double incidence_rad) {
  double sum = 0.0;
  for (std::size_t slice = 0; slice < table.azimuths(); ++slice) {
    const std::vector<TableNode>& nodes = table.nodes(side, slice);
    std::size_t next = 1;
    while (next + 1 < nodes.size() && nodes[next].incidence_rad < incidence_rad) ++next;
    const TableNode &a = nodes[next - 1], &b = nodes[next];
    const double share = (incidence_rad - a.incidence_rad) / (b.incidence_rad - a.incidence_rad);
    sum += std::lerp(a.mean_slope_rad, b.mean_slope_rad, share);
  }
  return sum / static_cast<double>(table.azimuths());
}

}  // namespace

BenchSurface make_bench_surface(const Library& library, SurfaceMaker& maker, const BenchPlace& place,
                                bool on_the_spot) {
  Problems problems;
  const auto looked_up = [&](auto look_up, const std::string& name) {
    try {
      return look_up(name);
    } catch (const InputError& error) {
      problems.add(error);
      return decltype(look_up(name)){};
    }
  };
  const Medium inside =
      looked_up([&](const std::string& name) { return library.medium(name); }, place.inside);
  const Medium outside =
      looked_up([&](const std::string& name) { return library.medium(name); }, place.outside);
  SurfaceSpec spec = looked_up([&](const std::string& name) { return library.surface(name); }, place.surface);
  problems.throw_if_any();

  const double nm = place.wavelength_nm;
  if (!(nm > 0.0))
    problems.add({}, fmt::format("a wavelength of {:g} nm; expected more than 0", nm), "as \"420 nm\"");
  for (const Medium* medium : {&inside, &outside})
    check_covers(problems, medium->index, nm, "medium \"" + medium->name + "\"", "refractive indices");
  check_covers(problems, spec, nm);
  problems.throw_if_any();

  if (on_the_spot) spec = traced_on_the_spot(std::move(spec));
  MadeSurface made = maker.make(spec, inside, outside, nm, nm, nm);
  BenchSurface bench;
  bench.place = place;
  bench.surface = std::move(made.surface);
  bench.index = {inside.index(nm), outside.index(nm)};
  bench.sources = std::move(spec.sources);
  bench.warnings = std::move(made.warnings);
  return bench;
}

Estimate mean_slope_met(const Surface& surface, Side side, double incidence_rad) {
  if (surface.mixture.empty()) {
    if (std::holds_alternative<SmoothSurface>(surface.microsurface)) return {};
    if (const auto* map = std::get_if<std::shared_ptr<const HeightField>>(&surface.microsurface))
      return mean_slope_met(**map, side, incidence_rad, kSlopeRays);
    const auto* table = std::get_if<std::shared_ptr<const SurfaceTable>>(&surface.microsurface);
    if (table && (*table)->provenance().stack.empty())  // a table of a stack does not know
      return {slope_in_table(**table, side, incidence_rad), 0.0};
  }
  throw InputError({{},
                    "surface \"" + surface.name + "\" has no facets whose slopes could be met",
                    "slopes are those of a height map, a recipe, a table of one, or a smooth face"});
}

}  // namespace scintray
