#include "scintray/topography/synthesis.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/topography/map_statistics.hpp"

namespace scintray {

namespace {

/// Independent numbers for the parts of a relief.
enum class Part : std::uint64_t { gaussian = 0, ridges = 1, grooves = 2 };

void check(const SynthesisRecipe& r) {
  Problems problems;
  const auto require = [&](bool good, const std::string& what) {
    if (!good) problems.add({}, "recipe " + r.name + ": " + what);
  };
  require(r.columns >= 2 && r.rows >= 2, "map smaller than 2 x 2 points");
  require(r.pitch_um > 0.0, "pitch is not positive");
  require(r.gaussian.rms_height_um >= 0.0, "rms height is negative");
  require(r.gaussian.correlation_length_um > 0.0, "correlation length is not positive");
  const double narrow = std::min(r.columns, r.rows) * r.pitch_um;
  require(r.gaussian.correlation_length_um < 0.25 * narrow,
          "correlation length is not below a quarter of the map's width");
  const FractureRelief& f = r.fracture;
  require(f.spacing_um >= 0.0 && f.spacing_um < 0.25 * narrow,
          "fracture spacing is not between 0 and a quarter of the map's width");
  require(f.rise_um >= 0.0 && f.depth_spread_um >= 0.0, "fracture heights are negative");
  require(f.exponent >= 1.0, "fracture exponent is below 1");
  require(f.size_spread >= 0.0 && f.size_spread < 1.0, "size spread is not in [0, 1)");
  problems.throw_if_any();
}

/// One pass of a periodic filter along x; the result is transposed, so that two passes make both.
std::vector<double> blur_and_transpose(const std::vector<double>& values, std::uint32_t columns,
                                       std::uint32_t rows, const std::vector<double>& kernel) {
  const std::size_t half = kernel.size() / 2;
  std::vector<double> result(values.size());
  std::vector<double> padded(columns + 2 * half);
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::size_t k = 0; k < padded.size(); ++k)
      padded[k] = values[std::size_t{j} * columns + (k + std::size_t{columns} * half - half) % columns];
    for (std::uint32_t i = 0; i < columns; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kernel.size(); ++k) sum += kernel[k] * padded[i + k];
      result[std::size_t{i} * rows + j] = sum;
    }
  }
  return result;
}

/// White noise under a Gaussian kernel exp(-2 r^2 / T^2), whose autocorrelation is exp(-r^2 / T^2),
/// scaled to exactly the rms height asked for.
void add_gaussian(const SynthesisRecipe& recipe, std::vector<double>& heights) {
  const GaussianRelief& relief = recipe.gaussian;
  if (relief.rms_height_um == 0.0) return;
  const double scale = recipe.pitch_um / relief.correlation_length_um;
  // Below 1e-16 of the peak beyond 4.3 correlation lengths.
  const auto half = static_cast<std::size_t>(std::ceil(4.3 / scale));
  std::vector<double> kernel;
  for (std::size_t k = 0; k <= 2 * half; ++k) {
    const double r = (static_cast<double>(k) - static_cast<double>(half)) * scale;
    kernel.push_back(std::exp(-2.0 * r * r));
  }
  Rng rng(recipe.seed, StreamKind::synthesis, static_cast<std::uint64_t>(Part::gaussian));
  std::vector<double> field(heights.size());
  for (double& value : field) value = sample_normal(rng);
  field = blur_and_transpose(field, recipe.columns, recipe.rows, kernel);
  field = blur_and_transpose(field, recipe.rows, recipe.columns, kernel);

  Moments moments;
  for (const double value : field) moments.add(value);
  const double mean = moments.mean().value;
  double squares = 0.0;
  for (const double value : field) squares += (value - mean) * (value - mean);
  const double factor = relief.rms_height_um / std::sqrt(squares / static_cast<double>(field.size()));
  for (std::size_t k = 0; k < field.size(); ++k) heights[k] += factor * (field[k] - mean);
}

struct Bowl {
  double x, y, depth, scale;  // lateral um, um, 1/radius
};

/// The lowest of a periodic set of bowls, at every pixel.
class Bowls {
 public:
  Bowls(const SynthesisRecipe& recipe, Part part)
      : recipe_(recipe),
        width_x_(recipe.columns * recipe.pitch_um),
        width_y_(recipe.rows * recipe.pitch_um),
        half_exponent_(0.5 * recipe.fracture.exponent) {
    const FractureRelief& f = recipe.fracture;
    Rng rng(recipe.seed, StreamKind::synthesis, static_cast<std::uint64_t>(part));
    // One bowl anywhere in each cell of a grid: no large gap, whose rim would tower over the rest.
    const auto across = static_cast<std::uint32_t>(std::lround(width_x_ / f.spacing_um));
    const auto along = static_cast<std::uint32_t>(std::lround(width_y_ / f.spacing_um));
    for (std::uint32_t k = 0; k < across * along; ++k) {
      const double x = width_x_ * (k % across + rng.uniform()) / across;
      const double y = width_y_ * (k / across + rng.uniform()) / along;
      const double depth = f.depth_spread_um * (2.0 * rng.uniform() - 1.0);
      const double radius = 0.5 * f.spacing_um * (1.0 + f.size_spread * (2.0 * rng.uniform() - 1.0));
      bowls_.push_back({x, y, depth, 1.0 / radius});
    }
  }

  /// Adds sign * (lowest bowl) to every height. Tiles of pixels keep only bowls that can be lowest
  /// somewhere in the tile.
  void add(double sign, std::vector<double>& heights) const {
    constexpr std::uint32_t kTile = 16;
    std::vector<Bowl> near;
    for (std::uint32_t j0 = 0; j0 < recipe_.rows; j0 += kTile)
      for (std::uint32_t i0 = 0; i0 < recipe_.columns; i0 += kTile) {
        const std::uint32_t i1 = std::min(i0 + kTile, recipe_.columns),
                            j1 = std::min(j0 + kTile, recipe_.rows);
        candidates(0.5 * (i0 + i1 - 1) * recipe_.pitch_um, 0.5 * (j0 + j1 - 1) * recipe_.pitch_um,
                   0.5 * kTile * recipe_.pitch_um * std::sqrt(2.0), near);
        for (std::uint32_t j = j0; j < j1; ++j)
          for (std::uint32_t i = i0; i < i1; ++i)
            heights[std::size_t{j} * recipe_.columns + i] +=
                sign * lowest(i * recipe_.pitch_um, j * recipe_.pitch_um, near);
      }
  }

 private:
  double distance2(const Bowl& bowl, double x, double y) const {
    const double dx = std::remainder(x - bowl.x, width_x_), dy = std::remainder(y - bowl.y, width_y_);
    return dx * dx + dy * dy;
  }

  double height(const Bowl& bowl, double squared) const {
    return bowl.depth +
           recipe_.fracture.rise_um * std::pow(squared * bowl.scale * bowl.scale, half_exponent_);
  }

  void candidates(double x, double y, double reach, std::vector<Bowl>& near) const {
    double bound = std::numeric_limits<double>::infinity();
    for (const Bowl& bowl : bowls_) {
      const double far = std::sqrt(distance2(bowl, x, y)) + reach;
      bound = std::min(bound, height(bowl, far * far));
    }
    near.clear();
    for (const Bowl& bowl : bowls_) {
      const double close = std::max(0.0, std::sqrt(distance2(bowl, x, y)) - reach);
      if (height(bowl, close * close) <= bound) near.push_back(bowl);
    }
  }

  double lowest(double x, double y, const std::vector<Bowl>& near) const {
    double result = std::numeric_limits<double>::infinity();
    for (const Bowl& bowl : near)
      if (bowl.depth < result) result = std::min(result, height(bowl, distance2(bowl, x, y)));
    return result;
  }

  const SynthesisRecipe& recipe_;
  double width_x_, width_y_, half_exponent_;
  std::vector<Bowl> bowls_;
};

std::string describe(const SynthesisRecipe& r) {
  std::string text = "made by recipe " + r.name + ", seed " + std::to_string(r.seed);
  if (r.gaussian.rms_height_um > 0.0)
    text += ", Gaussian relief Sq " + std::to_string(r.gaussian.rms_height_um) + " um, correlation length " +
            std::to_string(r.gaussian.correlation_length_um) + " um";
  if (r.fracture.spacing_um > 0.0)
    text += ", fracture spacing " + std::to_string(r.fracture.spacing_um) + " um, rise " +
            std::to_string(r.fracture.rise_um) + " um, exponent " + std::to_string(r.fracture.exponent) +
            ", depth spread " + std::to_string(r.fracture.depth_spread_um) + " um, size spread " +
            std::to_string(r.fracture.size_spread);
  return text;
}

/// Slope met from inside by a recipe's map.
double slope_met(const SynthesisRecipe& recipe, double incidence_rad) {
  constexpr std::uint64_t kRays = 40000;
  const HeightField field = make_height_field(synthesize(recipe));
  return mean_slope_met(field, Side::inside, incidence_rad, kRays).value;
}

constexpr double kSearchTolerance = 0.02 * kDegree;

/// Root of an increasing function on [low, high], to a tolerance in its value.
double bisect(const std::function<double(double)>& f, double low, double high) {
  double middle = 0.5 * (low + high);
  for (int step = 0; step < 40; ++step) {
    middle = 0.5 * (low + high);
    const double value = f(middle);
    if (std::abs(value) < kSearchTolerance) break;
    (value < 0.0 ? low : high) = middle;
  }
  return middle;
}

/// Scales the relief until the slope at normal incidence is met.
SynthesisRecipe fit_normal(SynthesisRecipe recipe, double target_rad) {
  const bool fractured = recipe.fracture.spacing_um > 0.0;
  double& size = fractured ? recipe.fracture.rise_um : recipe.gaussian.rms_height_um;
  const double widest = fractured ? recipe.fracture.spacing_um : recipe.gaussian.correlation_length_um;
  size = bisect(
      [&](double value) {
        size = value;
        return slope_met(recipe, 0.0) - target_rad;
      },
      0.0, widest);
  return recipe;
}

}  // namespace

HeightMap synthesize(const SynthesisRecipe& recipe) {
  check(recipe);
  HeightMap map;
  map.columns = recipe.columns;
  map.rows = recipe.rows;
  map.pitch_x_um = map.pitch_y_um = recipe.pitch_um;
  map.title = recipe.name;
  map.periodic = true;
  map.steps.push_back(describe(recipe));
  map.heights_um.assign(std::size_t{recipe.columns} * recipe.rows, 0.0);
  add_gaussian(recipe, map.heights_um);
  if (recipe.fracture.spacing_um > 0.0) {
    Bowls(recipe, Part::ridges).add(1.0, map.heights_um);
    Bowls(recipe, Part::grooves).add(-1.0, map.heights_um);
  }
  double mean = 0.0;
  for (const double h : map.heights_um) mean += h;
  mean /= static_cast<double>(map.heights_um.size());
  for (double& h : map.heights_um) h -= mean;
  return map;
}

SynthesisRecipe fit_recipe(SynthesisRecipe recipe, const SlopeTarget& target) {
  if (recipe.fracture.spacing_um > 0.0 && target.grazing_rad > 0.0) {
    recipe.fracture.exponent = bisect(
        [&](double exponent) {
          recipe.fracture.exponent = exponent;
          recipe = fit_normal(recipe, target.normal_rad);
          return slope_met(recipe, kGrazingStated_rad) - target.grazing_rad;
        },
        1.5, 8.0);
  }
  recipe = fit_normal(recipe, target.normal_rad);
  constexpr double kClose = 0.5 * kDegree;
  const double normal = slope_met(recipe, 0.0), grazing = slope_met(recipe, kGrazingStated_rad);
  if (std::abs(normal - target.normal_rad) > kClose ||
      (target.grazing_rad > 0.0 && std::abs(grazing - target.grazing_rad) > kClose))
    throw InputError({{},
                      "recipe " + recipe.name + " comes to mean slopes of " +
                          std::to_string(normal / kDegree) + " deg at normal and " +
                          std::to_string(grazing / kDegree) + " deg at grazing incidence, not to the targets",
                      "change its spacing, spreads or correlation length"});
  return recipe;
}

SynthesisRecipe ground_recipe() {
  SynthesisRecipe recipe;
  recipe.name = "ground";
  recipe.gaussian = {0.05, 1.0};
  recipe.fracture = {3.0, 0.0366, 5.15, 0.25, 0.3};
  return recipe;
}

SynthesisRecipe polished_recipe() {
  SynthesisRecipe recipe;
  recipe.name = "polished";
  recipe.gaussian = {0.0112, 0.9};
  return recipe;
}

}  // namespace scintray
