#include "scintray/topography/synthesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/topography/map_statistics.hpp"

namespace scintray::topography {

namespace {

constexpr double kClose = 0.02;
constexpr std::uint64_t kRays = 40000;

/// Slopes and height of a recipe, as means over the realisations.
struct Shown {
  double normal_rad = 0.0, grazing_rad = 0.0, rms_height_um = 0.0;
};

Shown show(SynthesisRecipe recipe, std::uint32_t realisations) {
  Shown shown;
  for (std::uint32_t k = 0; k < realisations; ++k, ++recipe.seed) {
    const HeightMap map = synthesize(recipe);
    const optics::HeightField field = make_height_field(map);
    shown.normal_rad += mean_visible_slope(field, optics::Side::inside, 0.0, kRays).value / realisations;
    shown.grazing_rad +=
        mean_visible_slope(field, optics::Side::inside, kGrazingStated_rad, kRays).value / realisations;
    shown.rms_height_um += map_statistics(map).sq_um / realisations;
  }
  return shown;
}

/// The equations, in the form that Eigen's solvers require: unknowns are logarithms of the parameters,
/// residuals logarithms of the values over their targets.
class Equations {
 public:
  Equations(const SynthesisRecipe& recipe, const SlopeTarget& target) : recipe_(recipe), target_(target) {}

  Eigen::VectorXd start() const {
    const bool fractured = recipe_.fracture.spacing_um > 0.0;
    std::vector<double> logarithms{
        std::log(fractured ? recipe_.fracture.rise_um : recipe_.gaussian.rms_height_um)};
    if (target_.grazing_rad > 0.0) logarithms.push_back(std::log(recipe_.fracture.exponent - 1.0));
    if (target_.rms_height_um > 0.0) logarithms.push_back(std::log(recipe_.gaussian.rms_height_um));
    return Eigen::Map<Eigen::VectorXd>(logarithms.data(), static_cast<Eigen::Index>(logarithms.size()));
  }

  SynthesisRecipe recipe(const Eigen::VectorXd& logarithms) const {
    // A search for an impossible target moves far from any surface, where rays take very long: reliefs as
    // high as they are wide, and bowls with steep walls, are the bounds.
    const auto value = [&](Eigen::Index k, double most) {
      return std::exp(std::clamp(logarithms[k], -20.0, std::log(most)));
    };
    constexpr double kMostExponent = 8.0;
    SynthesisRecipe result = recipe_;
    if (result.fracture.spacing_um > 0.0)
      result.fracture.rise_um = value(0, 0.5 * result.fracture.spacing_um);
    else
      result.gaussian.rms_height_um = value(0, result.gaussian.correlation_length_um);
    Eigen::Index next = 1;
    if (target_.grazing_rad > 0.0) result.fracture.exponent = 1.0 + value(next++, kMostExponent - 1.0);
    if (target_.rms_height_um > 0.0)
      result.gaussian.rms_height_um = value(next, result.gaussian.correlation_length_um);
    return result;
  }

  int operator()(const Eigen::VectorXd& logarithms, Eigen::VectorXd& residuals) const {
    const Shown shown = show(recipe(logarithms), target_.realisations);
    residuals[0] = std::log(shown.normal_rad / target_.normal_rad);
    Eigen::Index next = 1;
    if (target_.grazing_rad > 0.0) residuals[next++] = std::log(shown.grazing_rad / target_.grazing_rad);
    if (target_.rms_height_um > 0.0) residuals[next] = std::log(shown.rms_height_um / target_.rms_height_um);
    return 0;
  }

 private:
  SynthesisRecipe recipe_;
  SlopeTarget target_;
};

void require_possible(const SynthesisRecipe& recipe, const SlopeTarget& target) {
  core::Problems problems;
  const bool fractured = recipe.fracture.spacing_um > 0.0;
  const double searched = fractured ? recipe.fracture.rise_um : recipe.gaussian.rms_height_um;
  if (!(target.normal_rad > 0.0 && target.normal_rad < 0.5 * core::kPi))
    problems.add({}, "slope to fit at normal incidence is not between 0 and 90 deg");
  if (!(searched > 0.0))
    problems.add({}, "recipe " + recipe.name + " has neither a fracture nor a Gaussian relief to fit",
                 "give it a height to start from");
  if (target.grazing_rad != 0.0 && !(fractured && recipe.fracture.exponent > 1.0))
    problems.add({}, "recipe " + recipe.name + " has no fracture to fit a slope at grazing incidence with",
                 "fit the slope at normal incidence only, or start from the ground recipe");
  if (target.rms_height_um != 0.0 && !(fractured && recipe.gaussian.rms_height_um > 0.0))
    problems.add({},
                 "recipe " + recipe.name + " has no Gaussian relief beside a fracture to fit the height with",
                 "fit slopes only, or start from the ground recipe");
  if (target.realisations == 0) problems.add({}, "0 realisations to fit; expected at least 1");
  problems.throw_if_any();
}

bool near(double shown, double wanted) { return wanted == 0.0 || std::abs(shown / wanted - 1.0) <= kClose; }

}  // namespace

SynthesisRecipe fit_recipe(const SynthesisRecipe& recipe, const SlopeTarget& target) {
  require_possible(recipe, target);
  Equations equations(recipe, target);
  Eigen::VectorXd logarithms = equations.start();
  Eigen::HybridNonLinearSolver<Equations> solver(equations);
  // Traced slopes are a little rough as functions of the recipe: differences over 1 % are smooth.
  solver.parameters.epsfcn = 1e-4;
  solver.parameters.xtol = 1e-4;
  solver.parameters.maxfev = 30;
  // Its status is not needed: the slopes of the recipe are compared below.
  solver.solveNumericalDiff(logarithms);
  const SynthesisRecipe result = equations.recipe(logarithms);
  const Shown shown = show(result, target.realisations);
  if (!near(shown.normal_rad, target.normal_rad) || !near(shown.grazing_rad, target.grazing_rad) ||
      !near(shown.rms_height_um, target.rms_height_um))
    throw core::InputError(
        {{},
         fmt::format("recipe {} has mean slopes of {:.2f} deg at normal and {:.2f} deg at grazing "
                     "incidence and an rms height of {:.4g} um, not the targets",
                     recipe.name, shown.normal_rad / core::kDegree, shown.grazing_rad / core::kDegree,
                     shown.rms_height_um),
         "change its spacing, spreads or correlation length"});
  return result;
}

}  // namespace scintray::topography
