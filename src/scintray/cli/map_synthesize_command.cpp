#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/map_options.hpp"
#include "scintray/cli/map_text.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/word_option.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/materials/power_spectrum.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::cli {

namespace {

enum class ReliefKind { ground, polished, gaussian, fracture, saw_cut, k_correlation, spectrum };
constexpr core::Word<ReliefKind> kReliefKinds[] = {
    {"ground", ReliefKind::ground},     {"polished", ReliefKind::polished},
    {"gaussian", ReliefKind::gaussian}, {"fracture", ReliefKind::fracture},
    {"saw_cut", ReliefKind::saw_cut},   {"k_correlation", ReliefKind::k_correlation},
    {"spectrum", ReliefKind::spectrum}};

const char* name_of(ReliefKind kind) { return core::word_of(kReliefKinds, kind); }

struct SynthesisArguments {
  bool json = false;
  ReliefKind kind = ReliefKind::gaussian;
  std::string output, pitch;
  std::string rms_height, correlation_length, lay_length, lay_angle;
  std::string spacing, rise, depth_spread;
  double exponent = 0.0, size_spread = -1.0;
  std::string scratch_spacing, scratch_length, scratch_depth, scratch_width;
  std::string knee_length, spectrum, frequency_unit, density_unit;
  std::string fit_normal, fit_grazing, fit_rms_height;
  std::uint32_t points = 0, seeds = 1;
  std::uint64_t seed = 1;
};

/// Sets a length when the option is set.
void set(double& value_um, const std::string& text) {
  if (!text.empty()) value_um = length_um(text);
}

/// Options that a kind requires because they have no default, with their values.
using Given = std::vector<std::pair<const char*, bool>>;
void need(ReliefKind kind, const Given& given) {
  core::Problems problems;
  for (const auto& [option, there] : given)
    if (!there) problems.add({}, fmt::format("a map of kind {} without {}", name_of(kind), option));
  problems.throw_if_any();
}

void check_needs(const SynthesisArguments& a) {
  const auto there = [](const std::string& text) { return !text.empty(); };
  const Given gaussian{{"--rms-height", there(a.rms_height)},
                       {"--correlation-length", there(a.correlation_length)}};
  Given needs;
  if (a.kind == ReliefKind::gaussian || a.kind == ReliefKind::saw_cut || a.kind == ReliefKind::fracture)
    needs = gaussian;
  if (a.kind == ReliefKind::saw_cut) {
    needs.emplace_back("--lay-length", there(a.lay_length));
    needs.emplace_back("--lay-angle", there(a.lay_angle));
  }
  if (a.kind == ReliefKind::fracture) {
    needs.emplace_back("--spacing", there(a.spacing));
    needs.emplace_back("--rise", there(a.rise));
  }
  if (a.kind == ReliefKind::k_correlation)
    needs = {{"--rms-height", there(a.rms_height)},
             {"--knee-length", there(a.knee_length)},
             {"--exponent", a.exponent > 0.0}};
  if (a.kind == ReliefKind::spectrum)
    needs = {{"--spectrum", there(a.spectrum)},
             {"--frequency-unit", there(a.frequency_unit)},
             {"--density-unit", there(a.density_unit)}};
  need(a.kind, needs);
}

/// Options that a kind does not have are errors.
void check_meaning(const SynthesisArguments& a) {
  const bool fractured = a.kind == ReliefKind::ground || a.kind == ReliefKind::fracture,
             spectral = a.kind == ReliefKind::spectrum, k_correlation = a.kind == ReliefKind::k_correlation;
  core::Problems problems;
  const auto refuse = [&](bool given, bool meaningful, const char* option) {
    if (given && !meaningful)
      problems.add({}, fmt::format("{} has no meaning for kind {}", option, name_of(a.kind)));
  };
  refuse(!a.rms_height.empty(), !spectral, "--rms-height");
  refuse(!a.correlation_length.empty(), !spectral && !k_correlation, "--correlation-length");
  refuse(!a.lay_length.empty(), a.kind == ReliefKind::saw_cut, "--lay-length");
  refuse(!a.lay_angle.empty(), a.kind == ReliefKind::saw_cut, "--lay-angle");
  refuse(!a.spacing.empty(), fractured, "--spacing");
  refuse(!a.rise.empty(), fractured, "--rise");
  refuse(!a.depth_spread.empty(), fractured, "--depth-spread");
  refuse(a.size_spread >= 0.0, fractured, "--size-spread");
  refuse(a.exponent > 0.0, fractured || k_correlation, "--exponent");
  refuse(!a.knee_length.empty(), k_correlation, "--knee-length");
  refuse(!a.spectrum.empty(), spectral, "--spectrum");
  problems.throw_if_any();
}

void set_scratches(const SynthesisArguments& a, topography::ScratchRelief& scratches) {
  set(scratches.spacing_um, a.scratch_spacing);
  set(scratches.length_um, a.scratch_length);
  set(scratches.depth_um, a.scratch_depth);
  set(scratches.width_um, a.scratch_width);
}

void set_fracture(const SynthesisArguments& a, topography::FractureRelief& fracture) {
  set(fracture.spacing_um, a.spacing);
  set(fracture.rise_um, a.rise);
  set(fracture.depth_spread_um, a.depth_spread);
  if (a.exponent > 0.0) fracture.exponent = a.exponent;
  if (a.size_spread >= 0.0) fracture.size_spread = a.size_spread;
}

topography::SynthesisRecipe recipe_of(const SynthesisArguments& a) {
  check_needs(a);
  check_meaning(a);
  topography::SynthesisRecipe recipe;
  if (a.kind == ReliefKind::ground) recipe = topography::ground_recipe();
  if (a.kind == ReliefKind::polished) recipe = topography::polished_recipe();
  recipe.name = name_of(a.kind);
  recipe.seed = a.seed;
  if (a.points > 0) recipe.columns = recipe.rows = a.points;
  set(recipe.pitch_um, a.pitch);
  if (a.kind == ReliefKind::spectrum) {
    recipe.spectrum = materials::read_power_spectrum(a.spectrum, a.frequency_unit, a.density_unit);
  } else if (a.kind == ReliefKind::k_correlation) {
    set(recipe.k_correlation.rms_height_um, a.rms_height);
    set(recipe.k_correlation.knee_length_um, a.knee_length);
    recipe.k_correlation.exponent = a.exponent;
  } else {
    set(recipe.gaussian.rms_height_um, a.rms_height);
    set(recipe.gaussian.correlation_length_um, a.correlation_length);
    set(recipe.gaussian.lay_length_um, a.lay_length);
    if (!a.lay_angle.empty())
      recipe.gaussian.lay_angle_rad = core::parse_quantity(a.lay_angle, core::Dimension::angle);
  }
  if (a.kind == ReliefKind::ground || a.kind == ReliefKind::fracture) set_fracture(a, recipe.fracture);
  set_scratches(a, recipe.scratches);
  return recipe;
}

topography::SlopeTarget target_of(const SynthesisArguments& a) {
  topography::SlopeTarget target;
  target.normal_rad = core::parse_quantity(a.fit_normal, core::Dimension::angle);
  if (!a.fit_grazing.empty())
    target.grazing_rad = core::parse_quantity(a.fit_grazing, core::Dimension::angle);
  set(target.rms_height_um, a.fit_rms_height);
  target.realisations = a.seeds;
  return target;
}

/// Slopes of each seed: a recipe is a class of surfaces, and a fit is for their mean.
void print_seeds(topography::SynthesisRecipe recipe, std::uint32_t seeds) {
  std::cout << fmt::format("\n{:>6}{:>10}{:>12}{:>12}{:>22}{:>22}\n", "seed", "Sq um", "lowest um",
                           "highest um", "visible slope, normal deg", "grazing deg");
  for (std::uint32_t k = 0; k < seeds; ++k, ++recipe.seed) {
    const topography::HeightMap map = topography::synthesize(recipe);
    const optics::HeightField field = topography::make_height_field(map);
    const topography::MapStatistics s = topography::map_statistics(map);
    const core::Estimate normal = topography::mean_visible_slope(field, optics::Side::inside, 0.0),
                         grazing = topography::mean_visible_slope(field, optics::Side::inside,
                                                                  topography::kGrazingStated_rad);
    std::cout << fmt::format("{:>6}{:>10.4f}{:>12.3f}{:>12.3f}{:>13.2f} +- {:>4.2f}{:>14.2f} +- {:>4.2f}\n",
                             recipe.seed, s.sq_um, s.lowest_um, s.highest_um, normal.value / core::kDegree,
                             normal.error / core::kDegree, grazing.value / core::kDegree,
                             grazing.error / core::kDegree);
  }
}

void synthesize_map(const SynthesisArguments& arguments) {
  const JsonAnswer answer(arguments.json);
  topography::SynthesisRecipe recipe = recipe_of(arguments);
  if (!arguments.fit_normal.empty())
    recipe = with_progress("fitting the recipe to the slopes",
                           [&] { return topography::fit_recipe(recipe, target_of(arguments)); });
  const topography::HeightMap map =
      with_progress("making the map", [&] { return topography::synthesize(recipe); });
  print_summary(map);
  print_visible_slopes(topography::make_height_field(map));
  if (arguments.seeds > 1) print_seeds(recipe, arguments.seeds);
  print_warnings(map);
  topography::write_gsf(arguments.output, map);
  std::cout << "written      " << arguments.output << " (one period: build tables with --periodic)\n";
  answer.print([&] { return map_json(map); });
}

void add_relief_options(CLI::App& app, SynthesisArguments& a) {
  app.add_option("--rms-height", a.rms_height,
                 "Sq of the Gaussian relief or of the K-correlation, as \"0.9 um\"");
  app.add_option("--correlation-length", a.correlation_length, "of the Gaussian relief, as \"4.8 um\"");
  app.add_option("--lay-length", a.lay_length, "Correlation length along the saw marks, as \"60 um\"");
  app.add_option("--lay-angle", a.lay_angle, "Direction of the saw marks from x, as \"30 deg\"");
  app.add_option("--spacing", a.spacing, "Distance of the bowls of a fracture, as \"3 um\"");
  app.add_option("--rise", a.rise, "Height of a bowl at half that distance, as \"0.05 um\"");
  app.add_option("--exponent", a.exponent, "Shape of the bowls (2: paraboloid), or C of the K-correlation")
      ->check(CLI::Range(1.0, 100.0));
  app.add_option("--depth-spread", a.depth_spread, "Depths of bowls vary by +- this, as \"0.1 um\"");
  app.add_option("--size-spread", a.size_spread, "Sizes of bowls vary by +- this share")
      ->check(CLI::Range(0.0, 0.99));
  app.add_option("--scratch-spacing", a.scratch_spacing, "Area over total length of scratches, as \"20 um\"");
  app.add_option("--scratch-length", a.scratch_length, "Length of a scratch, as \"30 um\"");
  app.add_option("--scratch-depth", a.scratch_depth, "Depth of the deepest scratch, as \"0.03 um\"");
  app.add_option("--scratch-width", a.scratch_width, "Half its width at 1/e of its depth, as \"0.5 um\"");
  app.add_option("--knee-length", a.knee_length, "B of the K-correlation, as \"5 um\"");
  app.add_option("--spectrum", a.spectrum,
                 "CSV of spatial frequency and two-dimensional, isotropic power spectral density");
  app.add_option("--frequency-unit", a.frequency_unit, "of the first column, as 1/um");
  app.add_option("--density-unit", a.density_unit, "of the second column, as um4");
}

}  // namespace

void add_map_synthesize_command(CLI::App& map) {
  auto arguments = std::make_shared<SynthesisArguments>();
  SynthesisArguments& a = *arguments;
  CLI::App* app =
      map.add_subcommand("synthesize", "Synthesise a height map from a recipe and print its visible slopes");
  add_word_option(*app, "kind", a.kind, kReliefKinds,
                  "ground, polished, gaussian, fracture, saw_cut, k_correlation or spectrum")
      ->required();
  app->add_option("-o,--output", a.output, "Height map to write (.gsf)")->required();
  app->add_option("--seed", a.seed, "Seed of the random numbers")->capture_default_str();
  app->add_option("--points", a.points, "Columns and rows, 514 unless given")->check(CLI::Range(2, 16384));
  app->add_option("--pitch", a.pitch, "Distance of points, \"0.175 um\" unless given");
  add_relief_options(*app, a);
  CLI::Option* normal =
      app->add_option("--fit-normal", a.fit_normal, "Fit the recipe to this mean slope at normal incidence");
  app->add_option("--fit-grazing", a.fit_grazing, "and, of a fracture, to this one at 88.5 deg")
      ->needs(normal);
  app->add_option("--fit-rms-height", a.fit_rms_height,
                  "and, of a fracture with a Gaussian relief, to this Sq")
      ->needs(normal);
  app->add_option("--seeds", a.seeds, "Fit the mean of this many seeds, from --seed upwards, and print each")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_json_flag(*app, a.json);
  const std::string words = "  scintray " + map.get_name() + " synthesize ";
  app->footer("Examples:\n" + words + "ground -o ground.gsf\n" + words +
              "gaussian --rms-height \"0.5 um\" --correlation-length \"5 um\" -o rough.gsf");
  app->callback([arguments] { synthesize_map(*arguments); });
}

}  // namespace scintray::cli
