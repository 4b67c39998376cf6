#pragma once
/// Time of emission of light after an excitation.

#include <vector>

#include "scintray/core/rng.hpp"

namespace scintray::optics {

/// Distribution of the time of emission after an excitation.
enum class TimeProfile {
  exponential,  ///< about the decay time, after a rise
  delta         ///< the decay time itself: every photon is delayed alike, as by Geant4's profile "delta"
};

/// One component of scintillation or fluorescence light.
struct DecayComponent {
  double decay_ns = 0.0;
  double rise_ns = 0.0;   ///< 0: instantaneous rise
  double fraction = 1.0;  ///< share of the light; the sum over a medium's components is 1
  TimeProfile profile = TimeProfile::exponential;
};

/// Time from excitation to emission (ns), drawn at random: the rise and the decay are two exponential steps,
/// so their sum has the bi-exponential density (exp(-t/decay) - exp(-t/rise)) / (decay - rise). Throws
/// InternalError without components.
double sample_decay(const std::vector<DecayComponent>& components, core::Rng& rng);

}  // namespace scintray::optics
