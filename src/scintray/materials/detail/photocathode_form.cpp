#include <fmt/format.h>

#include "scintray/materials/detail/forms.hpp"
#include "scintray/materials/detail/sensor_parts.hpp"
#include "scintray/optics/fresnel.hpp"

namespace scintray::materials {

namespace {

constexpr double kGreatestFilmIndex = 10.0;
constexpr double kGreatestExtinction = 20.0;
/// Thicker films are errors of unit: no electron would leave them.
constexpr double kThickestCathode_nm = 1000.0;

optics::CoatingLayer read_film(const config::TomlTable& table) {
  optics::CoatingLayer film;
  film.index = table.curve("n", core::Dimension::dimensionless);
  table.expect("n", film.index.min_y() > 0.0 && film.index.max_y() <= kGreatestFilmIndex,
               "the index of a photocathode lies above 0, up to 10");
  film.extinction = table.curve("k", core::Dimension::dimensionless);
  table.expect("k", film.extinction.min_y() > 0.0 && film.extinction.max_y() <= kGreatestExtinction,
               "the extinction of a photocathode, the imaginary part of its index, lies above 0, up to 20",
               "write the index as n + i k with k positive; a film that does not absorb converts nothing");
  constexpr double kNmPerMm = 1e6;
  film.thickness_nm = table.quantity("thickness", core::Dimension::length) * kNmPerMm;
  table.expect(
      "thickness", film.thickness_nm > 0.0 && film.thickness_nm <= kThickestCathode_nm,
      fmt::format("the thickness of a photocathode lies above 0, up to 1 um, but this one is {:g} nm",
                  film.thickness_nm),
      "give the thickness of the film, as \"26 nm\"");
  return film;
}

/// Share of the light that enters the window, of what the published efficiency counts.
double entering(const detector::Sensor& sensor) {
  if (sensor.definition != detector::EfficiencyDefinition::external) return 1.0;
  return 1.0 - optics::fresnel(1.0, sensor.reference_index, sensor.window_index).unpolarised();
}

void find_escape(const config::TomlTable& efficiency, detector::Sensor& sensor) {
  detector::Photocathode& cathode = *sensor.cathode;
  if (sensor.definition == detector::EfficiencyDefinition::absorbed) {
    cathode.escape = sensor.efficiency;
    return;
  }
  const double window_index = sensor.window_index;
  const core::Curve escape = detector::escape_probability(cathode.film, window_index, sensor.efficiency);
  std::vector<double> values;
  for (const double value : escape.y()) values.push_back(value / entering(sensor));
  cathode.escape = core::Curve(escape.x(), std::move(values));
  for (std::size_t i = 0; i < escape.x().size(); ++i) {
    if (cathode.escape.y()[i] <= 1.0) continue;
    const double nm = escape.x()[i];
    efficiency.report(
        "value",
        fmt::format("at {:g} nm the photocathode absorbs {:.3g} of the light in the window, less than this "
                    "efficiency of {:.3g} converts",
                    nm, detector::film_absorptance(cathode.film, window_index, 1.0, 1.0, nm),
                    sensor.efficiency(nm) / entering(sensor)),
        "check n, k and thickness of [photocathode], and how the efficiency was measured");
    return;
  }
}

}  // namespace

void read_photocathode(const config::TomlTable& sensor_table, const config::TomlTable& efficiency,
                       SourceRule rule, detector::Sensor& sensor) {
  const config::TomlTable table = sensor_table.table("photocathode");
  read_source(table, rule, sensor.sources);
  sensor.cathode = detector::Photocathode{read_film(table), core::Curve::constant(0.0)};
  if (sensor_table.has("converts"))
    sensor_table.report("converts", "a photocathode converts the light that its film absorbs, and no other",
                        "leave \"converts\" out");
  sensor.converts = detector::ConvertedLight::absorbed;
  if (sensor_table.has("angle"))
    sensor_table.report("angle", "the dependence on angle follows from the film of [photocathode]",
                        "leave one of the two out");
  if (sensor.window_matched)
    sensor_table.report("window", "the film of a photocathode lies on a window of a known index",
                        "give [window] the index of the glass, as index = 1.47");
  const bool good = table.good("n") && table.good("k") && table.good("thickness") &&
                    efficiency.good("value") && efficiency.good("definition") && !sensor.window_matched;
  if (good) find_escape(efficiency, sensor);
}

}  // namespace scintray::materials
