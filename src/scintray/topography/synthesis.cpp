#include "scintray/topography/synthesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/relief.hpp"

namespace scintray::topography {

namespace {

using Require = std::function<void(bool, const std::string&)>;

void check(const GaussianRelief& g, double narrow, const Require& require) {
  require(g.rms_height_um >= 0.0, "rms height is negative");
  require(g.correlation_length_um > 0.0, "correlation length is not positive");
  require(g.correlation_length_um < 0.25 * narrow,
          "correlation length is not below a quarter of the map's width");
  require(g.lay_length_um == 0.0 || g.lay_length_um >= g.correlation_length_um,
          "the correlation length along the lay is below the one across it");
  require(std::isfinite(g.lay_length_um) && std::isfinite(g.lay_angle_rad), "the lay is not finite");
}

void check(const FractureRelief& f, double narrow, const Require& require) {
  require(f.spacing_um >= 0.0 && f.spacing_um < 0.25 * narrow,
          "fracture spacing is not between 0 and a quarter of the map's width");
  require(f.rise_um >= 0.0 && f.depth_spread_um >= 0.0, "fracture heights are negative");
  require(f.exponent >= 1.0, "fracture exponent is below 1");
  require(f.size_spread >= 0.0 && f.size_spread < 1.0, "size spread is not in [0, 1)");
}

void check(const ScratchRelief& s, double narrow, const Require& require) {
  require(s.spacing_um >= 0.0, "spacing of scratches is negative");
  if (s.spacing_um == 0.0) return;
  require(s.depth_um >= 0.0 && std::isfinite(s.depth_um), "depth of scratches is negative");
  require(s.width_um > 0.0 && s.width_um < 0.05 * narrow,
          "width of scratches is not between 0 and a twentieth of the map's width");
  require(s.length_um > 0.0 && s.length_um < 0.5 * narrow,
          "length of scratches is not between 0 and half the map's width");
  // Scratches that together cover the map more than ten times are no longer scratches.
  require(s.spacing_um * 10.0 >= s.width_um, "scratches are closer than a tenth of their width");
}

void check(const KCorrelationRelief& k, const Require& require) {
  require(k.rms_height_um >= 0.0, "rms height of the K-correlation spectrum is negative");
  require(k.knee_length_um > 0.0, "knee length is not positive");
  require(k.exponent > 1.0,
          "exponent of the K-correlation spectrum is not above 1, so its power is infinite");
}

void check(const SpectrumRelief& s, const Require& require) {
  require(s.frequency_per_um.size() == s.density_um4.size(), "spectrum with columns of different length");
  if (s.frequency_per_um.empty() || s.frequency_per_um.size() != s.density_um4.size()) return;
  require(s.frequency_per_um.size() >= 2, "spectrum of a single point; expected at least 2");
  for (std::size_t k = 0; k < s.frequency_per_um.size(); ++k) {
    const double f = s.frequency_per_um[k], density = s.density_um4[k];
    if (!(f > 0.0 && std::isfinite(f)))
      return require(
          false, fmt::format("spatial frequency {} of the spectrum is {} 1/um; expected above 0", k + 1, f));
    if (k > 0 && f <= s.frequency_per_um[k - 1])
      return require(false, fmt::format("spatial frequency {} of the spectrum is {} 1/um after {}; expected "
                                        "increasing frequencies",
                                        k + 1, f, s.frequency_per_um[k - 1]));
    if (!(density >= 0.0 && std::isfinite(density)))
      return require(false, fmt::format("power density {} of the spectrum is {} um^4; expected 0 or more",
                                        k + 1, density));
  }
}

void check(const SynthesisRecipe& r) {
  core::Problems problems;
  const Require require = [&](bool good, const std::string& what) {
    if (!good) problems.add({}, "recipe " + r.name + ": " + what);
  };
  require(r.columns >= 2 && r.rows >= 2, "map smaller than 2 x 2 points");
  require(r.columns <= 16384 && r.rows <= 16384, "map larger than 16384 x 16384 points");
  require(r.pitch_um > 0.0, "pitch is not positive");
  const double narrow = std::min(r.columns, r.rows) * r.pitch_um;
  check(r.gaussian, narrow, require);
  check(r.fracture, narrow, require);
  check(r.scratches, narrow, require);
  check(r.k_correlation, require);
  check(r.spectrum, require);
  problems.throw_if_any();
}

}  // namespace

std::string describe(const SynthesisRecipe& r) {
  std::string text = fmt::format("recipe {}: {} x {} points of {} um, seed {}", r.name, r.columns, r.rows,
                                 r.pitch_um, r.seed);
  if (const GaussianRelief& g = r.gaussian; g.rms_height_um > 0.0) {
    text += fmt::format(", Gaussian relief Sq {} um, correlation length {} um", g.rms_height_um,
                        g.correlation_length_um);
    if (g.lay_length_um > 0.0)
      text += fmt::format(" across and {} um along a lay at {:.10g} deg", g.lay_length_um,
                          g.lay_angle_rad / core::kDegree);
  }
  if (const FractureRelief& f = r.fracture; f.spacing_um > 0.0)
    text +=
        fmt::format(", fracture spacing {} um, rise {} um, exponent {}, depth spread {} um, size spread {}",
                    f.spacing_um, f.rise_um, f.exponent, f.depth_spread_um, f.size_spread);
  if (const ScratchRelief& s = r.scratches; s.spacing_um > 0.0)
    text += fmt::format(", scratches of spacing {} um, length {} um, depth {} um, width {} um", s.spacing_um,
                        s.length_um, s.depth_um, s.width_um);
  if (const KCorrelationRelief& k = r.k_correlation; k.rms_height_um > 0.0)
    text += fmt::format(", K-correlation spectrum of Sq {} um, knee length {} um, exponent {}",
                        k.rms_height_um, k.knee_length_um, k.exponent);
  if (const SpectrumRelief& s = r.spectrum; !s.frequency_per_um.empty())
    text += fmt::format(", spectrum of {} points from {} to {} 1/um", s.frequency_per_um.size(),
                        s.frequency_per_um.front(), s.frequency_per_um.back());
  return text;
}

HeightMap synthesize(const SynthesisRecipe& recipe) {
  check(recipe);
  HeightMap map;
  map.columns = recipe.columns;
  map.rows = recipe.rows;
  map.pitch_x_um = map.pitch_y_um = recipe.pitch_um;
  map.title = recipe.name;
  map.periodic = true;
  map.steps.push_back("made by " + describe(recipe));
  map.heights_um.assign(std::size_t{recipe.columns} * recipe.rows, 0.0);
  add_gaussian(recipe, map.heights_um);
  add_k_correlation(recipe, map.heights_um);
  add_spectrum(recipe, map.heights_um);
  add_fracture(recipe, map.heights_um);
  add_scratches(recipe, map.heights_um);
  double mean = 0.0;
  for (const double h : map.heights_um) mean += h;
  mean /= static_cast<double>(map.heights_um.size());
  for (double& h : map.heights_um) h -= mean;
  return map;
}

SynthesisRecipe ground_recipe() {
  SynthesisRecipe recipe;
  recipe.name = "ground";
  recipe.gaussian.rms_height_um = 0.4033;
  recipe.gaussian.correlation_length_um = 7.0;
  recipe.fracture = {2.5, 0.03815, 5.2185, 0.05, 0.1};
  return recipe;
}

SynthesisRecipe polished_recipe() {
  SynthesisRecipe recipe;
  recipe.name = "polished";
  recipe.gaussian.rms_height_um = 0.0109;
  recipe.gaussian.correlation_length_um = 0.9;
  recipe.scratches = {10.0, 30.0, 0.02, 0.5};
  return recipe;
}

}  // namespace scintray::topography
