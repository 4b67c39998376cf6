#pragma once
/// Photosensors: what happens to a photon that reaches one.

#include <optional>
#include <string>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/detector/avalanche_model.hpp"

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

/// Avalanches without light: independent of each other, at a constant rate.
struct DarkCounts {
  double per_ns = 0.0;      ///< of the whole sensor
  double per_ns_mm2 = 0.0;  ///< of its area; added to the other
};

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
  core::Shared<AvalancheModel> avalanches = ProportionalModel();
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
