#pragma once
/// Photosensors: what happens to a photon that reaches one.

#include <string>
#include <vector>

#include "scintray/core/curve.hpp"

namespace scintray {

/// How a sensor's efficiency was measured.
enum class EfficiencyDefinition {
  internal,  ///< per photon that has entered the sensor's window or silicon
  external,  ///< per photon that arrives from `reference_index` at normal incidence: the Fresnel loss
             ///< at the entrance is inside the number and is divided out, since the tracer makes it
};

/// A sensor of the library (`materials/sensors/NAME.toml`).
struct Sensor {
  std::string name;
  Curve efficiency;  ///< conversion probability against wavelength (nm), as published
  EfficiencyDefinition definition = EfficiencyDefinition::internal;
  double reference_index = 1.0;  ///< index light came from when an external efficiency was measured
  double window_index = 1.5;     ///< index of the entrance window, for the conversion above
  std::vector<std::string> sources;

  /// Probability that a photon that has entered the sensor is converted, at a wavelength (nm).
  double conversion_probability(double wavelength_nm) const;
};

}  // namespace scintray
