#pragma once
/// What a sensor's data sheet states beside its efficiency: how an avalanche looks, and what fires one.

#include <cstdint>
#include <optional>

#include "scintray/core/curve.hpp"

namespace scintray::detector {

/// How a sensor's efficiency was measured.
enum class EfficiencyDefinition {
  internal,  ///< per photon that has entered the sensor's window or silicon
  external,  ///< per photon that arrives from a reference index: the Fresnel loss at the entrance is
             ///< inside the number and is divided out, since the tracer makes it
};

/// Where the angle of a published dependence on angle was measured.
enum class AngleMedium {
  window,   ///< of the ray inside the window
  outside,  ///< of the ray in the reference index, before the window
};

/// Efficiency against angle, relative to normal incidence.
struct AngularEfficiency {
  core::Curve factor;  ///< against the angle to the normal (rad), 1 at 0; from its end on its last value
  AngleMedium measured_in = AngleMedium::window;
  EfficiencyDefinition definition = EfficiencyDefinition::internal;
  double reference_index = 1.0;  ///< index that light came from; not used when internal and in the window
};

/// What one photoelectron of a photomultiplier, or one avalanche of a silicon photomultiplier, gives.
struct SingleElectron {
  double charge_spread = 0.0;  ///< standard deviation of the charge over its mean
  /// Current (exp(-t/decay) - exp(-t/rise)) / (decay - rise); 0: that side is instantaneous.
  double rise_ns = 0.0, decay_ns = 0.0;
};

/// The cells of a silicon photomultiplier. Exactly one of pitch and count is not 0.
struct Microcells {
  double pitch_mm = 0.0;
  std::uint32_t count = 0;   ///< over the whole sensor
  double recovery_ns = 0.0;  ///< time constant of the recharge, above 0
  double crosstalk = 0.0;    ///< probability that a full avalanche fires at least one neighbour at once
  double afterpulse = 0.0;   ///< probability that a full avalanche fires its own cell once more later
  double afterpulse_time_ns = 0.0;  ///< time constant of that delay
};

/// Avalanches without light: independent of each other, at a constant rate.
struct DarkCounts {
  double per_ns = 0.0;      ///< of the whole sensor
  double per_ns_mm2 = 0.0;  ///< of its area; added to the other
};

}  // namespace scintray::detector
