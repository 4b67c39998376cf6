#pragma once
/// When light comes out after an excitation.

#include <vector>

#include "scintray/core/philox.hpp"

namespace scintray::optics {

/// One exponential component of scintillation or fluorescence light.
struct DecayComponent {
  double decay_ns = 0.0;
  double rise_ns = 0.0;   ///< 0: instantaneous rise
  double fraction = 1.0;  ///< share of the light; the fractions of a medium sum to 1
};

/// A time after excitation (ns): the rise and the decay are two exponential steps, so their sum has the
/// bi-exponential density (exp(-t/decay) - exp(-t/rise)) / (decay - rise). At least one component, else
/// InternalError.
double sample_decay(const std::vector<DecayComponent>& components, core::Rng& rng);

}  // namespace scintray::optics
