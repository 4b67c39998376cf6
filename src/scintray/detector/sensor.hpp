#pragma once
/// Photosensors: what happens to a photon that reaches one.

#include <optional>
#include <string>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/detector/sensor_data.hpp"

namespace scintray::detector {

/// A sensor of the database (`materials/sensors/NAME.toml`).
struct Sensor {
  std::string name;
  core::Curve efficiency;  ///< conversion probability against wavelength (nm), as published
  EfficiencyDefinition definition = EfficiencyDefinition::internal;
  double reference_index = 1.0;            ///< index light came from when an external efficiency was measured
  double window_index = 1.5;               ///< index of the entrance window, for the conversions here
  std::optional<AngularEfficiency> angle;  ///< nothing: the same at every angle, once light is inside
  double time_spread_ns = 0.0;  ///< standard deviation of the transit time (photomultiplier), or of the
                                ///< single photon time resolution (silicon photomultiplier)
  SingleElectron single_electron;
  std::optional<Microcells> microcells;  ///< nothing: the charge is proportional, as a photomultiplier's
  DarkCounts dark_counts;
  std::vector<std::string> sources;

  /// Probability that a photon that has entered the sensor at normal incidence is converted, at a
  /// wavelength (nm).
  double conversion_probability(double wavelength_nm) const;
  /// The same at any angle.
  /// @param transverse_index  refractive index times sine of the angle to the normal, which is the same
  ///                          on both sides of every face of the window
  double conversion_probability(double wavelength_nm, double transverse_index) const;
  /// Share of the conversion probability at normal incidence that is left at an angle, per photon inside
  /// the window. Needs `angle`. Beyond the last tabulated angle, and where no light from the reference
  /// index could be, its last value.
  double angle_factor(double transverse_index) const;
};

}  // namespace scintray::detector
