#include "scintray/materials/material_forms.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scintray/core/share_hint.hpp"
#include "scintray/materials/detail/forms.hpp"

namespace scintray::materials {

void expect_wavelengths(const config::TomlTable& block, const std::string& key, const core::Curve& curve) {
  if (curve.is_constant() && curve.x().front() == 0.0) return;
  block.expect(key, curve.x().front() > 0.0, "\"" + key + "\" has a wavelength that is not positive",
               "give wavelengths in nm, or photon energies in eV");
}

namespace {

constexpr core::Word<optics::ScatteringKind> kScatteringKinds[] = {
    {"rayleigh", optics::ScatteringKind::rayleigh}, {"isotropic", optics::ScatteringKind::isotropic}};

/// Most steps of a formula's table: to 0.1 mm.
constexpr double kMostFormulaSteps = 1e5;

/// Tabulates n(wavelength) over `range` of a formula's table. `index_at` takes 1/wavelength^2 in 1/um^2 and
/// returns a non-finite value where the formula is not defined.
template <class Formula>
core::Curve tabulate(const config::TomlTable& formula, const Formula& index_at) {
  const std::vector<double> range = formula.quantities("range", core::Dimension::wavelength, 2);
  if (range.empty()) return core::Curve::constant(1.0);
  formula.expect("range", range[0] > 0.0 && range[1] > range[0],
                 "\"range\" must be two positive wavelengths, the smaller first");
  if (formula.good("range"))
    formula.expect(
        "range", range[1] - range[0] <= kMostFormulaSteps * kFormulaStep_nm,
        fmt::format("\"range\" ends at {:g} nm, which is far beyond the light that is traced", range[1]),
        "give the wavelengths in which the formula holds, some micrometres at most");
  if (!formula.good("range")) return core::Curve::constant(1.0);
  const auto steps = static_cast<std::size_t>(std::ceil((range[1] - range[0]) / kFormulaStep_nm));
  std::vector<double> x, y;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double wavelength_nm =
        range[0] + (range[1] - range[0]) * static_cast<double>(i) / static_cast<double>(steps);
    x.push_back(wavelength_nm);
    y.push_back(index_at(1e6 / (wavelength_nm * wavelength_nm)));
    if (std::isfinite(y.back())) continue;
    formula.report("range",
                   "the formula gives no refractive index at " + std::to_string(wavelength_nm) + " nm",
                   "check the coefficients, or give the range in which the formula holds");
    return core::Curve::constant(1.0);
  }
  return {std::move(x), std::move(y)};
}

/// n^2 = 1 + sum_i b_i w^2 / (w^2 - c_i), w in um (W. Sellmeier 1871; the form of SCHOTT's data sheets).
core::Curve read_sellmeier(const config::TomlTable& formula) {
  const std::vector<double> b = formula.numbers("b");
  const std::vector<double> c = formula.numbers("c_um2");
  if (b.size() != c.size() && !b.empty() && !c.empty())
    formula.report(
        "c_um2",
        "\"c_um2\" has " + std::to_string(c.size()) + " numbers, but \"b\" has " + std::to_string(b.size()),
        "give one c_um2 (in um^2) for every b");
  const bool usable = !b.empty() && b.size() == c.size();
  return tabulate(formula, [&](double inverse_square) {
    double n2 = 1.0;
    for (std::size_t i = 0; usable && i < b.size(); ++i) n2 += b[i] / (1.0 - c[i] * inverse_square);
    return std::sqrt(n2);
  });
}

/// n = a_0 + a_1 / w^2 + a_2 / w^4 + ..., w in um (A.-L. Cauchy 1836).
core::Curve read_cauchy(const config::TomlTable& formula) {
  const std::vector<double> a = formula.numbers("a");
  return tabulate(formula, [&](double inverse_square) {
    double n = 0.0, power = 1.0;
    for (const double coefficient : a) {
      n += coefficient * power;
      power *= inverse_square;
    }
    return a.empty() ? 1.0 : n;
  });
}

using CurveReader = core::Curve (*)(const config::TomlTable& block);

core::Curve read_index_table(const config::TomlTable& block) {
  return block.curve("n", core::Dimension::dimensionless);
}

/// The forms of [index]; each formula has a table of its own.
constexpr core::Word<CurveReader> kIndexForms[] = {
    {"n", read_index_table},
    {"sellmeier", [](const config::TomlTable& block) { return read_sellmeier(block.table("sellmeier")); }},
    {"cauchy", [](const config::TomlTable& block) { return read_cauchy(block.table("cauchy")); }}};

}  // namespace

core::Curve read_index(const config::TomlTable& block) {
  const core::Word<CurveReader>* form = block.one_of(kIndexForms, true);
  if (!form) return core::Curve::constant(1.0);
  const core::Curve index = form->value(block);
  block.expect(form->word, index.min_y() >= 1.0 && index.max_y() <= kGreatestIndex,
               "a refractive index lies between 1 and 5, but this one runs from " +
                   std::to_string(index.min_y()) + " to " + std::to_string(index.max_y()),
               "check the table or the formula's coefficients (wavelength in um)");
  expect_wavelengths(block, form->word, index);
  return index;
}

std::optional<core::Curve> read_group_index(const config::TomlTable& block) {
  std::optional<core::Curve> group = block.optional_curve("group", core::Dimension::dimensionless);
  if (!group) return std::nullopt;
  block.expect("group", group->min_y() >= 1.0 && group->max_y() <= 10.0,
               "a group index lies between 1 and 10", "it is the speed of light over the group velocity");
  expect_wavelengths(block, "group", *group);
  return group;
}

namespace {

core::Curve read_extinction_length(const config::TomlTable& block) {
  const core::Curve length = block.curve("length", core::Dimension::length);
  block.expect("length", length.min_y() > 0.0, "a length must be positive",
               "for no absorption or scattering write none = true");
  expect_wavelengths(block, "length", length);
  if (!block.good("length")) return core::Curve::constant(0.0);
  std::vector<double> coefficients;
  for (const double mm : length.y()) coefficients.push_back(1.0 / mm);
  return {length.x(), std::move(coefficients)};
}

core::Curve read_extinction_coefficient(const config::TomlTable& block) {
  const core::Curve coefficient = block.curve("coefficient", core::Dimension::inverse_length);
  block.expect("coefficient", coefficient.min_y() >= 0.0, "a coefficient cannot be negative");
  expect_wavelengths(block, "coefficient", coefficient);
  return coefficient;
}

core::Curve read_no_extinction(const config::TomlTable& block) {
  const bool none = block.boolean("none");
  block.expect("none", none, "\"none\" can only be true",
               "write none = true, or give a length or a coefficient");
  return core::Curve::constant(0.0);
}

constexpr core::Word<CurveReader> kExtinctionForms[] = {{"length", read_extinction_length},
                                                        {"coefficient", read_extinction_coefficient},
                                                        {"none", read_no_extinction}};

}  // namespace

core::Curve read_extinction(const config::TomlTable& block) {
  const core::Word<CurveReader>* form = block.one_of(kExtinctionForms, true);
  return form ? form->value(block) : core::Curve::constant(0.0);
}

namespace {

double read_mean_cosine(const config::TomlTable& block, const std::string& key,
                        std::optional<double> fallback) {
  const double g = fallback ? block.number(key, *fallback) : block.number(key);
  block.expect(
      key, g > -1.0 && g < 1.0,
      fmt::format("the mean cosine of a lobe lies between -1 and 1, but this one is {:g}", g),
      "0 is isotropic, 0.9 strongly forward; of the backward lobe it is counted from the reversed ray");
  return g;
}

/// [particles]: scattering by particles, in addition to [scattering].
optics::ParticleScattering read_particles(const config::TomlTable& block, SourceRule rule,
                                          std::vector<std::string>& sources) {
  read_source(block, rule, sources);
  optics::ParticleScattering particles;
  particles.per_mm = read_extinction(block);
  block.expect("none", false, "particles that do not scatter", "leave [particles] out");
  particles.forward_g = read_mean_cosine(block, "forward", std::nullopt);
  particles.backward_g = read_mean_cosine(block, "backward", 0.0);
  particles.forward_share = block.quantity("forward_share", core::Dimension::dimensionless, 1.0);
  block.expect("forward_share", particles.forward_share >= 0.0 && particles.forward_share <= 1.0,
               fmt::format("a share lies between 0 and 1, but this one is {:g}", particles.forward_share),
               core::share_hint(particles.forward_share));
  return particles;
}

using CompositionReader = optics::Composition (*)(const config::TomlTable& block);

optics::Composition read_formula(const config::TomlTable& block) {
  return optics::composition_of_formula(block.string("formula"));
}

optics::Composition read_mass_fractions(const config::TomlTable& block) {
  std::vector<std::pair<std::string, double>> shares;
  const config::TomlTable table = block.table("mass_fractions");
  for (const std::string& symbol : table.keys())
    shares.emplace_back(symbol, table.quantity(symbol, core::Dimension::dimensionless));
  for (const auto& [symbol, share] : shares)
    if (!table.good(symbol)) return {};
  return optics::composition_of_mass_fractions(shares);
}

constexpr core::Word<CompositionReader> kCompositionForms[] = {{"formula", read_formula},
                                                               {"mass_fractions", read_mass_fractions}};

}  // namespace

void expect_share(const config::TomlTable& block, const std::string& key, const core::Curve& curve,
                  const std::string& what) {
  const double low = curve.min_y(), high = curve.max_y();
  const std::string found =
      low == high ? fmt::format("is {:g}", high) : fmt::format("runs from {:g} to {:g}", low, high);
  block.expect(key, low >= 0.0 && high <= 1.0, what + " lies between 0 and 1, but this one " + found,
               low == high ? core::share_hint(high) : "per cent are written with value_unit = \"%\"");
  expect_wavelengths(block, key, curve);
}

optics::Composition read_composition(const config::TomlTable& block) {
  const core::Word<CompositionReader>* form = block.one_of(kCompositionForms, true);
  if (!form) return {};
  try {
    return form->value(block);
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems())
      block.report(form->word, problem.what, problem.hint);
    return {};
  }
}

optics::Medium read_medium(const config::TomlTable& table, const std::string& name, SourceRule rule) {
  optics::Medium medium;
  medium.name = name;
  if (table.node()->find("base")) {
    table.take("base");
    table.report(
        "base", "a medium has a base, but only surfaces and sensors can be based on another",
        "write the medium in full: [media.NAME.index] and so on, as in the files of materials/media");
    table.skip();
    return medium;
  }
  const config::TomlTable index = table.table("index");
  if (table.has("index")) {
    read_source(index, rule, medium.sources);
    medium.index = read_index(index);
    medium.group_index = read_group_index(index);
  }
  const config::TomlTable absorption = table.table("absorption");
  if (table.has("absorption")) {
    read_source(absorption, rule, medium.sources);
    medium.absorption_per_mm = read_extinction(absorption);
  }
  read_birefringence(index, absorption, medium);
  const config::TomlTable scattering = table.table("scattering");
  if (table.has("scattering")) {
    read_source(scattering, rule, medium.sources);
    medium.scattering_per_mm = read_extinction(scattering);
    if (!scattering.has("none")) medium.scattering = scattering.choice("kind", kScatteringKinds);
  }
  if (const std::optional<config::TomlTable> particles = table.optional_table("particles"))
    medium.particles = read_particles(*particles, rule, medium.sources);
  if (const std::optional<config::TomlTable> density = table.optional_table("density")) {
    read_source(*density, rule, medium.sources);
    medium.density_g_per_cm3 = density->quantity("value", core::Dimension::density);
    density->expect("value", medium.density_g_per_cm3 > 0.0, "a density must be positive");
  }
  if (const std::optional<config::TomlTable> composition = table.optional_table("composition")) {
    read_source(*composition, rule, medium.sources);
    medium.empty_space = composition->has("none") && composition->boolean("none");
    composition->expect("none", medium.empty_space, "\"none\" can only be true",
                        "write none = true for empty space, or give a formula or mass fractions");
    if (!medium.empty_space) medium.composition = read_composition(*composition);
    if (!medium.empty_space && !table.has("density"))
      table.report("composition", "a medium with a composition needs its density too",
                   "add [density] with its value, as \"7.4 g/cm3\", and source");
  }
  read_scintillation(table, rule, medium);
  medium.shifter = read_shifter(table, rule, medium.sources);
  return medium;
}

void expect_sheet(const config::TomlTable& table, const std::string& key,
                  const optics::Reflector& reflector) {
  if (!table.good(key)) return;
  constexpr double kRounding = 1e-9;
  const double most = optics::most_kept(reflector);
  table.expect(key, most <= 1.0 + kRounding,
               fmt::format("reflectance and transmittance of \"{}\" come to {:.6g}; together they are shares "
                           "of one light, at most 1",
                           reflector.name, most),
               "lower one of them at the wavelengths where they exceed 1; what is left of 1 is absorbed");
}

optics::Reflector read_reflector(const config::TomlTable& table, const std::string& name, SourceRule rule) {
  optics::Reflector reflector;
  reflector.name = name;
  std::vector<std::string> sources;
  const config::TomlTable reflectance = table.table("reflectance");
  if (table.has("reflectance")) {
    read_source(reflectance, rule, sources);
    reflector.reflectance = reflectance.curve("value", core::Dimension::dimensionless);
    expect_share(reflectance, "value", reflector.reflectance, "a reflectance");
  }
  if (const auto transmittance = table.optional_table("transmittance")) {
    read_source(*transmittance, rule, sources);
    reflector.transmittance = transmittance->curve("value", core::Dimension::dimensionless);
    expect_share(*transmittance, "value", *reflector.transmittance, "a transmittance");
    if (reflectance.good("value")) expect_sheet(*transmittance, "value", reflector);
  }
  const config::TomlTable direction = table.table("direction");
  if (table.has("direction")) {
    read_source(direction, rule, sources);
    reflector.specular_share = direction.quantity("specular_share", core::Dimension::dimensionless);
    direction.expect(
        "specular_share", reflector.specular_share >= 0.0 && reflector.specular_share <= 1.0,
        fmt::format("a share lies between 0 and 1, but this one is {:g}", reflector.specular_share),
        core::share_hint(reflector.specular_share));
  }
  if (table.has("volume")) {
    const config::TomlTable volume = table.table("volume");
    read_source(volume, rule, sources);
    reflector.volume_index = volume.number("index");
    volume.expect("index", reflector.volume_index >= 1.0 && reflector.volume_index <= 5.0,
                  "the index of a reflector's volume lies between 1 and 5");
  }
  return reflector;
}

}  // namespace scintray::materials
