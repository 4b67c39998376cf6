#include <algorithm>
#include <numeric>
#include <set>

#include "scintray/core/curve.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/scene/detail/build_steps.hpp"

namespace scintray::scene {

namespace {

/// Placeholder for the wavelengths of a scene with an error, until all errors are found.
constexpr WavelengthRange kNoLight{400.0, 400.0, 400.0};

/// Range of the non-zero part of an emission spectrum.
WavelengthRange range_of(const core::Curve& emission) {
  WavelengthRange range;
  const auto &x = emission.x(), &y = emission.y();
  std::size_t first = 0, last = x.size() - 1;
  while (first + 1 < x.size() && y[first + 1] == 0.0) ++first;
  while (last > 0 && y[last - 1] == 0.0) --last;
  range.low_nm = x[std::min(first, last)];
  range.high_nm = x[last];
  range.reference_nm = core::CurveSampler(emission).mean();
  return range;
}

/// Range of the wavelengths emitted by the parts of a name or pattern. Parts that do not scintillate are
/// ignored for an event source, and are errors for a source of photons.
WavelengthRange emission_of(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                            const config::NameRef& parts, const materials::MaterialDatabase& database,
                            core::Problems& problems) {
  std::optional<WavelengthRange> found;
  for (const contact::PlacedMesh& part : placed) {
    if (!core::matches_pattern(parts.name, part.name) || part.medium.empty() ||
        part.medium.name == scene_file::kOpaqueMedium)
      continue;
    try {
      const optics::Medium& medium = database.medium(part.medium.name, part.medium.where);
      const bool emits = medium.emission.max_y() > 0.0 && !medium.emission.is_constant();
      if (emits) {
        WavelengthRange range = range_of(medium.emission);
        for (const optics::ParticleLight& light : medium.by_particle) {
          if (!light.emission) continue;
          range.low_nm = std::min(range.low_nm, range_of(*light.emission).low_nm);
          range.high_nm = std::max(range.high_nm, range_of(*light.emission).high_nm);
        }
        if (!found) found = range;
        found->low_nm = std::min(found->low_nm, range.low_nm);
        found->high_nm = std::max(found->high_nm, range.high_nm);
      } else if (!spec.energy_source) {
        problems.add(spec.source.wavelength_where,
                     "medium \"" + medium.name + "\" has no emission spectrum to draw wavelengths from",
                     "give a wavelength, as wavelength = \"420 nm\", or an emission in the medium's file");
        return kNoLight;
      }
    } catch (const core::InputError&) {
      // reported where the part is added
    }
  }
  // Steps of particles emit Cherenkov light in media that do not scintillate, too.
  if (!found && spec.energy_source && spec.energy_source->cherenkov_nm &&
      std::holds_alternative<scene_file::HitsSpec>(spec.energy_source->kind)) {
    const auto [low, high] = *spec.energy_source->cherenkov_nm;
    return {low, high, 0.5 * (low + high)};
  }
  if (!found && spec.energy_source && problems.empty())
    problems.add(spec.energy_source->where, "no part scintillates, so energy makes no light",
                 "give a part's medium [yield], [emission] and [[decay]], or use one that has them, as "
                 "\"LSO\"");
  return found.value_or(kNoLight);
}

WavelengthRange wavelengths_of_source(const scene_file::SceneSpec& spec,
                                      const std::vector<contact::PlacedMesh>& placed,
                                      const materials::MaterialDatabase& database, core::Problems& problems) {
  if (const auto* list =
          spec.energy_source ? std::get_if<scene_file::PhotonListSpec>(&spec.energy_source->kind) : nullptr) {
    try {
      const std::vector<double>& nm = list->photons().wavelength_nm;
      const auto [low, high] = std::minmax_element(nm.begin(), nm.end());
      return {*low, *high, std::accumulate(nm.begin(), nm.end(), 0.0) / static_cast<double>(nm.size())};
    } catch (const core::InputError& error) {
      for (const core::Problem& problem : error.problems()) problems.add(problem);
      return kNoLight;
    }
  }
  if (spec.energy_source) {
    WavelengthRange range = emission_of(spec, placed, {"*", {}}, database, problems);
    if (const auto& cherenkov_nm = spec.energy_source->cherenkov_nm) {
      range.low_nm = std::min(range.low_nm, (*cherenkov_nm)[0]);
      range.high_nm = std::max(range.high_nm, (*cherenkov_nm)[1]);
    }
    return range;
  }
  if (spec.source.wavelength_nm) {
    const double nm = *spec.source.wavelength_nm;
    return {nm, nm, nm};
  }
  if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec.source.origin))
    return emission_of(spec, placed, region->part, database, problems);
  problems.add(spec.source.wavelength_where,
               "wavelength = \"emission\" needs a source region with a part, since a point may lie anywhere",
               "give a wavelength, as wavelength = \"420 nm\"");
  return kNoLight;
}

/// Upper end (nm) of an emission spectrum: the last point, or the first of the zeros at its end.
double end_of(const core::Curve& emission) {
  std::size_t last = emission.y().size() - 1;
  while (last > 0 && emission.y()[last - 1] == 0.0) --last;
  return emission.x()[last];
}

/// Extends a range by that of the light that a shifter re-emits; beyond the source's shortest wavelength only
/// by fluorophores whose emission does not depend on what they absorbed.
void extend(WavelengthRange& range, const optics::WavelengthShifter* shifter) {
  if (!shifter) return;
  for (const optics::Fluorophore& fluorophore : shifter->fluorophores()) {
    range.high_nm = std::max(range.high_nm, end_of(fluorophore.emission));
    if (fluorophore.rule == optics::ShiftRule::kasha)
      range.low_nm = std::min(range.low_nm, fluorophore.emission.x().front());
  }
}

void extend(WavelengthRange& range, const materials::SurfaceSpec& surface) {
  extend(range, surface.gap_shifter.get());
  for (const materials::ShareSpec& part : surface.mixture) extend(range, *part.surface);
}

/// Extends a range by the light that the wavelength shifters of the scene re-emit.
void extend_by_shifters(WavelengthRange& range, const scene_file::SceneSpec& spec,
                        const std::vector<contact::PlacedMesh>& placed,
                        const materials::MaterialDatabase& database) {
  std::set<std::string> media{spec.ambient.name}, surfaces;
  for (const contact::PlacedMesh& part : placed) {
    if (!part.medium.empty() && part.medium.name != scene_file::kOpaqueMedium) media.insert(part.medium.name);
    surfaces.insert(part.surface.name);
    for (const contact::PlacedFace& face : part.faces) surfaces.insert(face.surface.name);
  }
  for (const scene_file::ContactSpec& contact : spec.contacts)
    surfaces.insert({contact.surface.name, contact.leaving[0].name, contact.leaving[1].name});
  surfaces.erase("");

  const auto look_up = [&](const auto& extend_by_definition) {
    try {
      extend_by_definition();
    } catch (const core::InputError&) {
      // reported where the part is added
    }
  };
  for (const std::string& name : media) look_up([&] { extend(range, database.medium(name).shifter.get()); });
  for (const std::string& name : surfaces) look_up([&] { extend(range, database.surface(name)); });
}

}  // namespace

WavelengthRange find_wavelengths(const scene_file::SceneSpec& spec,
                                 const std::vector<contact::PlacedMesh>& placed,
                                 const materials::MaterialDatabase& database, core::Problems& problems) {
  WavelengthRange range = wavelengths_of_source(spec, placed, database, problems);
  extend_by_shifters(range, spec, placed, database);
  return range;
}

}  // namespace scintray::scene
