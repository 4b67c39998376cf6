#include "scintray/scene_file/gamma_source.hpp"

#include "scintray/materials/material_forms.hpp"
#include "scintray/scene_file/detail/column_keys.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

/// Largest accepted energy of a deposit; larger ones are errors of unit.
constexpr double kGreatestDeposit_keV = 1e6;

constexpr core::Word<OriginKind> kSpectrumOrigins[] = {{"region", OriginKind::region},
                                                       {"position", OriginKind::position}};
constexpr core::Word<OriginKind> kEmitterOrigins[] = {
    {"region", OriginKind::region}, {"position", OriginKind::position}, {"plane", OriginKind::plane}};

/// Keys for the energies of deposits.
enum class EnergyForm { one, spectrum };
constexpr core::Word<EnergyForm> kEnergyForms[] = {{"energy", EnergyForm::one},
                                                   {"spectrum", EnergyForm::spectrum}};

SpectrumSpec read_spectrum(const config::TomlTable& table, const std::vector<std::string>& parts) {
  SpectrumSpec source;
  if (const auto* kind = table.one_of(kSpectrumOrigins, true)) {
    read_origin(table, kind->value, parts, source.origin);
    source.origin_where = table.where(kind->word);
  }
  const core::Word<EnergyForm>* form = table.one_of(kEnergyForms, true);
  if (form && form->value == EnergyForm::one) {
    source.energy_keV = table.quantity("energy", core::Dimension::energy);
    table.expect("energy", *source.energy_keV > 0.0 && *source.energy_keV <= kGreatestDeposit_keV,
                 "an energy lies above 0 and up to 1 GeV", "give the energy of an event, as \"511 keV\"");
  } else if (form) {
    source.spectrum = table.curve("spectrum", core::Dimension::dimensionless, core::Dimension::energy);
    const core::Curve& spectrum = source.spectrum;
    table.expect("spectrum", !spectrum.is_constant(), "a spectrum needs energies, but this is one value",
                 "write { file = \"spectrum.csv\", energy_unit = \"keV\" }, or energy = \"511 keV\" for one "
                 "energy");
    table.expect(
        "spectrum", spectrum.min_y() >= 0.0,
        "a spectrum cannot be negative, but this one goes down to " + std::to_string(spectrum.min_y()),
        "subtract no more background than there are counts");
    table.expect("spectrum", spectrum.max_y() > 0.0, "this spectrum is zero everywhere",
                 "give counts, or any number proportional to them, per energy");
    table.expect("spectrum", spectrum.x().front() >= 0.0 && spectrum.x().back() <= kGreatestDeposit_keV,
                 "energies lie between 0 and 1 GeV, but these run from " +
                     std::to_string(spectrum.x().front()) + " to " + std::to_string(spectrum.x().back()) +
                     " keV",
                 "check energy_unit");
  }
  source.particle = table.choice("particle", kDepositing, Depositing::gamma);
  return source;
}

PlaneSpec read_plane(const config::TomlTable& table) {
  PlaneSpec plane;
  plane.where = table.where();
  for (const char* key : {"center", "x", "y"})
    if (!table.has(key))
      table.report(
          key, std::string("a plane needs \"") + key + "\"",
          "write { center = [...], x = [...], y = [...] }, three lengths each; x and y are the edges");
  plane.centre = table.optional_quantity3("center", core::Dimension::length).value_or(plane.centre);
  plane.x = table.optional_quantity3("x", core::Dimension::length).value_or(plane.x);
  plane.y = table.optional_quantity3("y", core::Dimension::length).value_or(plane.y);
  return plane;
}

void read_emission(const config::TomlTable& table, EmitterSpec& source) {
  source.emission = table.choice("emission", kEmissions);
  source.emission_where = table.where("emission");
  if (source.emission == Emission::gamma) {
    source.energy_keV = table.quantity("energy", core::Dimension::energy);
    table.expect("energy", source.energy_keV >= kLowestGamma_keV && source.energy_keV <= kHighestGamma_keV,
                 "gammas are followed between 10 keV and 3 MeV", "give an energy in this range");
  } else if (table.has("energy")) {
    table.report("energy", "the energies of this emission are known",
                 "remove energy, or write emission = \"gamma\"");
  }
  const bool directed = source.emission == Emission::gamma || source.emission == Emission::pair;
  if (directed || table.has("direction")) source.direction = read_direction(table);
  table.expect("direction", directed || source.direction.kind == DirectionKind::isotropic,
               "a nuclide emits in all directions", "write direction = \"isotropic\", or remove it");
  if (source.emission == Emission::pair || source.emission == Emission::sodium)
    source.acollinearity_rad = table.quantity("acollinearity", core::Dimension::angle, 0.0);
  table.expect("acollinearity", source.acollinearity_rad >= 0.0 && source.acollinearity_rad < 0.1,
               "an acollinearity lies between 0 and 0.1 rad",
               "give the full width at half maximum, as \"0.5 deg\"");
}

void read_matter(const config::TomlTable& table, const std::vector<std::string>& parts, EmitterSpec& source) {
  std::vector<std::string> names = parts;
  names.push_back(kAmbientName);
  for (const std::string& name : table.strings("vacuum", 0, false)) {
    const MatterSpec matter{{name, table.where("vacuum")}, {}, 0.0, table.where("vacuum")};
    expect_parts(table, "vacuum", matter.part, names);
    source.matter.push_back(matter);
  }
  for (const config::TomlTable& block : table.tables("matter")) {
    MatterSpec matter;
    matter.where = block.where();
    matter.part = read_name(block, "part", true);
    expect_parts(block, "part", matter.part, names);
    matter.composition = materials::read_composition(block);
    matter.density_g_per_cm3 = block.quantity("density", core::Dimension::density);
    block.expect("density", matter.density_g_per_cm3 > 0.0, "a density must be positive");
    source.matter.push_back(std::move(matter));
  }
}

EmitterSpec read_emitter(const config::TomlTable& table, const std::vector<std::string>& parts) {
  EmitterSpec source;
  if (const auto* kind = table.one_of(kEmitterOrigins, true)) {
    read_origin(table, kind->value, parts, source.origin);
    if (kind->value == OriginKind::plane) source.origin = read_plane(table.table("plane"));
    source.origin_where = table.where(kind->word);
  }
  read_emission(table, source);
  source.fluorescence = table.boolean("fluorescence", true);
  read_matter(table, parts, source);
  return source;
}

HitsSpec read_hits(const config::TomlTable& table) {
  HitsSpec hits;
  hits.arrays = table.boolean("arrays", false);
  if (hits.arrays) {
    hits.where = table.where("arrays");
    if (table.has("file")) table.report("file", "a file of hits beside arrays = true", "remove one of them");
    return hits;
  }
  hits.where = table.where("file");
  hits.file = table.existing_file("file");
  hits.group = read_column_group(table, hits.file, "hits");
  hits.length_mm = read_unit(table, "length_unit", core::Dimension::length);
  hits.energy_keV = read_unit(table, "energy_unit", core::Dimension::energy);
  if (table.has("time_unit")) hits.time_ns = read_unit(table, "time_unit", core::Dimension::time);
  if (const std::optional<config::TomlTable> columns = table.optional_table("columns")) {
    for (const auto& [key, name] :
         {std::pair{"event", &hits.event}, std::pair{"x", &hits.x}, std::pair{"y", &hits.y},
          std::pair{"z", &hits.z}, std::pair{"energy", &hits.energy}, std::pair{"time", &hits.time}})
      *name = columns->string(key, *name);
    for (const auto& [key, column] : kStepColumns)
      hits.steps[static_cast<std::size_t>(column)] = columns->string(key, "");
    columns->expect("time", hits.time_ns.has_value(), "a column of times without their unit",
                    "add time_unit, as \"ns\"");
    for (const char* key : {"decay", "rise"})
      columns->expect(key, hits.time_ns.has_value(), "a column of times without their unit",
                      "add time_unit, as \"ns\"");
  }
  return hits;
}

/// Reads whether there is Cherenkov light, and its wavelengths.
void read_cherenkov(const config::TomlTable& table, GammaSpec& spec) {
  constexpr double kShortest_nm = 100.0, kLongest_nm = 3000.0;
  spec.cherenkov = table.boolean("cherenkov", false);
  const std::vector<double> range =
      table.quantities("cherenkov_range", core::Dimension::wavelength, 2, false);
  if (range.size() != 2) return;
  table.expect("cherenkov_range", range[0] >= kShortest_nm && range[0] < range[1] && range[1] <= kLongest_nm,
               "the wavelengths of Cherenkov light rise, and lie between 100 and 3000 nm",
               "write the shortest and the longest, as [\"310 nm\", \"750 nm\"]");
  table.expect("cherenkov_range", spec.cherenkov, "a range of wavelengths for light that there is none of",
               "add cherenkov = true, or remove cherenkov_range");
  spec.cherenkov_nm = {range[0], range[1]};
}

}  // namespace

GammaSpec read_gamma_source(const config::TomlTable& source, const std::vector<std::string>& parts) {
  GammaSpec spec;
  spec.where = source.where();
  const GammaSourceType type = source.choice("type", kGammaSourceTypes);
  if (type == GammaSourceType::photons) {
    spec.kind = read_photon_list(source, spec.unpolarised);
  } else {
    spec.unpolarised = source.choice("polarisation", kUnpolarised, false);
    read_cherenkov(source, spec);
  }
  if (const auto quick = source.optional_integer("quick_events"))
    spec.quick_events = positive_count(source, "quick_events", *quick);
  if (type == GammaSourceType::hits || type == GammaSourceType::photons) {
    if (type == GammaSourceType::hits) spec.kind = read_hits(source);
    if (const auto events = source.optional_integer("events"))
      spec.events = positive_count(source, "events", *events);
    return spec;
  }
  if (type == GammaSourceType::emitter)
    spec.kind = read_emitter(source, parts);
  else
    spec.kind = read_spectrum(source, parts);
  spec.events = positive_count(source, "events", source.integer("events"));
  return spec;
}

}  // namespace scintray::scene_file
