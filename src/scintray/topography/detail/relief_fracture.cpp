#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/topography/detail/relief.hpp"

namespace scintray::topography {

namespace {

struct Bowl {
  double x, y, depth, scale;  // lateral um, um, 1/radius
};

/// The lowest of a periodic set of bowls, at every pixel.
class Bowls {
 public:
  Bowls(const SynthesisRecipe& recipe, ReliefPart part)
      : recipe_(recipe),
        width_x_(recipe.columns * recipe.pitch_um),
        width_y_(recipe.rows * recipe.pitch_um),
        half_exponent_(0.5 * recipe.fracture.exponent) {
    const FractureRelief& f = recipe.fracture;
    ReliefRandom random(recipe, part);
    // One bowl anywhere in each cell of a grid: no large gap, whose rim would be far above the rest.
    const auto across = static_cast<std::uint32_t>(std::lround(width_x_ / f.spacing_um));
    const auto along = static_cast<std::uint32_t>(std::lround(width_y_ / f.spacing_um));
    for (std::uint32_t k = 0; k < across * along; ++k) {
      const double x = width_x_ * (k % across + random.uniform()) / across;
      const double y = width_y_ * (k / across + random.uniform()) / along;
      const double depth = f.depth_spread_um * (2.0 * random.uniform() - 1.0);
      const double radius = 0.5 * f.spacing_um * (1.0 + f.size_spread * (2.0 * random.uniform() - 1.0));
      bowls_.push_back({x, y, depth, 1.0 / radius});
    }
  }

  /// Adds sign * (lowest bowl) to every height. Rows of tiles keep only bowls that can be lowest
  /// somewhere in the tile; they do not share heights, so the result does not depend on threads.
  void add(double sign, std::vector<double>& heights) const {
    const std::uint32_t tile_rows = (recipe_.rows + kTile - 1) / kTile;
    tbb::parallel_for(std::uint32_t{0}, tile_rows,
                      [&](std::uint32_t row) { add_tiles(sign, row * kTile, heights); });
  }

 private:
  static constexpr std::uint32_t kTile = 16;

  void add_tiles(double sign, std::uint32_t j0, std::vector<double>& heights) const {
    std::vector<Bowl> near;
    const std::uint32_t j1 = std::min(j0 + kTile, recipe_.rows);
    for (std::uint32_t i0 = 0; i0 < recipe_.columns; i0 += kTile) {
      const std::uint32_t i1 = std::min(i0 + kTile, recipe_.columns);
      candidates(0.5 * (i0 + i1 - 1) * recipe_.pitch_um, 0.5 * (j0 + j1 - 1) * recipe_.pitch_um,
                 0.5 * kTile * recipe_.pitch_um * std::sqrt(2.0), near);
      for (std::uint32_t j = j0; j < j1; ++j)
        for (std::uint32_t i = i0; i < i1; ++i)
          heights[std::size_t{j} * recipe_.columns + i] +=
              sign * lowest(i * recipe_.pitch_um, j * recipe_.pitch_um, near);
    }
  }

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

}  // namespace

void add_fracture(const SynthesisRecipe& recipe, std::vector<double>& heights_um) {
  if (recipe.fracture.spacing_um == 0.0) return;
  Bowls(recipe, ReliefPart::ridges).add(1.0, heights_um);
  Bowls(recipe, ReliefPart::grooves).add(-1.0, heights_um);
}

}  // namespace scintray::topography
