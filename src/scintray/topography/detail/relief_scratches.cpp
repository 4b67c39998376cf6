#include <algorithm>
#include <cmath>

#include "scintray/core/vec.hpp"
#include "scintray/topography/detail/relief.hpp"

namespace scintray::topography {

namespace {

struct Scratch {
  double x, y;          ///< middle, um
  double cosine, sine;  ///< of its direction
  double depth;
};

/// Beyond this many widths a groove is shallower than 1e-7 of its depth.
constexpr double kReach = 4.0;

/// Squared distance of the point (dx, dy) from a segment through the origin.
double distance2(const Scratch& scratch, double half_length, double dx, double dy) {
  const double along = scratch.cosine * dx + scratch.sine * dy;
  const double across = scratch.cosine * dy - scratch.sine * dx;
  const double past = std::max(0.0, std::abs(along) - half_length);
  return across * across + past * past;
}

/// Indices k with |k pitch - middle| <= reach, on the periodic axis, are low, low + 1, ... high.
struct Range {
  long low, high;
};
Range within(double middle, double reach, double pitch) {
  return {static_cast<long>(std::ceil((middle - reach) / pitch)),
          static_cast<long>(std::floor((middle + reach) / pitch))};
}

std::size_t wrapped(long k, std::uint32_t n) {
  const long size = static_cast<long>(n);
  return static_cast<std::size_t>(((k % size) + size) % size);
}

void difference_on_grid(const SynthesisRecipe& recipe, const Scratch& scratch, std::vector<double>& heights) {
  const double half = 0.5 * recipe.scratches.length_um, width = recipe.scratches.width_um;
  const double reach = kReach * width, pitch = recipe.pitch_um;
  const Range columns = within(scratch.x, half * std::abs(scratch.cosine) + reach, pitch);
  const Range rows = within(scratch.y, half * std::abs(scratch.sine) + reach, pitch);
  for (long j = rows.low; j <= rows.high; ++j)
    for (long i = columns.low; i <= columns.high; ++i) {
      const double d2 = distance2(scratch, half, static_cast<double>(i) * pitch - scratch.x,
                                  static_cast<double>(j) * pitch - scratch.y);
      if (d2 > reach * reach) continue;
      heights[wrapped(j, recipe.rows) * recipe.columns + wrapped(i, recipe.columns)] -=
          scratch.depth * std::exp(-d2 / (width * width));
    }
}

}  // namespace

void add_scratches(const SynthesisRecipe& recipe, std::vector<double>& heights_um) {
  const ScratchRelief& s = recipe.scratches;
  if (s.spacing_um == 0.0) return;
  const double width_x = recipe.columns * recipe.pitch_um, width_y = recipe.rows * recipe.pitch_um;
  const long number = std::lround(width_x * width_y / (s.spacing_um * s.length_um));
  ReliefRandom random(recipe, ReliefPart::scratches);
  for (long k = 0; k < number; ++k) {
    const double x = width_x * random.uniform(), y = width_y * random.uniform(),
                 angle = core::kPi * random.uniform();
    difference_on_grid(recipe, {x, y, std::cos(angle), std::sin(angle), s.depth_um * random.uniform()},
                       heights_um);
  }
}

}  // namespace scintray::topography
