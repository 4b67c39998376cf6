#pragma once
/// The parts of a synthetic relief. Recipes have been checked before.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/core/sampling_laws.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::topography {

/// Independent random numbers for each part of a relief.
enum class ReliefPart : std::uint64_t {
  gaussian = 0,
  ridges = 1,
  grooves = 2,
  scratches = 3,
  k_correlation = 4,
  spectrum = 5,
};

/// The random numbers of a part: those of Philox alone, in its order, so that a recipe and its seed remain
/// the same relief whatever photons draw.
class ReliefRandom {
 public:
  ReliefRandom(const SynthesisRecipe& recipe, ReliefPart part)
      : counter_{0, 0, static_cast<std::uint64_t>(part), 3}, seed_(recipe.seed) {}

  /// Uniform on [0, 1), 53 bits.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// Standard normal deviate.
  double normal() {
    const double for_radius = static_cast<double>((bits() >> 11) + 1) * 0x1.0p-53;
    return core::normal_deviates<double>(for_radius, uniform()).first;
  }

 private:
  std::uint64_t bits() {
    if (used_ == block_.size()) {
      block_ = core::philox4x64(counter_, {seed_, 0});
      ++counter_[0];
      used_ = 0;
    }
    return block_[used_++];
  }

  std::array<std::uint64_t, 4> counter_, block_{};
  std::uint64_t seed_;
  std::size_t used_ = block_.size();
};

/// Each function adds its part, um, to the row-major heights of the recipe's grid.
void add_gaussian(const SynthesisRecipe& recipe, std::vector<double>& heights_um);
void add_k_correlation(const SynthesisRecipe& recipe, std::vector<double>& heights_um);
void add_spectrum(const SynthesisRecipe& recipe, std::vector<double>& heights_um);
void add_fracture(const SynthesisRecipe& recipe, std::vector<double>& heights_um);
void add_scratches(const SynthesisRecipe& recipe, std::vector<double>& heights_um);

/// Power spectral densities, um^4, at spatial frequencies in 1/um.
double gaussian_density(const GaussianRelief& relief, double fx, double fy);
double k_correlation_density(const KCorrelationRelief& relief, double f);
double tabulated_density(const SpectrumRelief& relief, double f);

}  // namespace scintray::topography
