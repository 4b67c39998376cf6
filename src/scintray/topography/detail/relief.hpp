#pragma once
/// The parts of a synthetic relief. Recipes have been checked before.

#include <cstdint>
#include <functional>
#include <vector>

#include "scintray/core/rng.hpp"
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

inline core::Rng relief_random(const SynthesisRecipe& recipe, ReliefPart part) {
  return core::Rng(recipe.seed, core::StreamKind::synthesis, static_cast<std::uint64_t>(part));
}

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
