#pragma once
/// Photosensors: the conversion of photons that reach one, and its dark counts.

#include <optional>
#include <string>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/detector/avalanche_model.hpp"
#include "scintray/detector/face_response.hpp"
#include "scintray/detector/photocathode.hpp"

namespace scintray::detector {

/// How a sensor's efficiency was measured.
enum class EfficiencyDefinition {
  internal,  ///< per photon that has entered the sensor's window or silicon
  external,  ///< per photon that arrives from a reference index: the Fresnel loss at the entrance is included
             ///< in the number and is divided out, since the tracer applies it
  absorbed,  ///< per photon that is absorbed in the photocathode
};

/// Where the angle of a published dependence on angle was measured.
enum class AngleMedium {
  window,   ///< of the ray inside the window
  outside,  ///< of the ray in the reference index, before the window
};

/// Light that a sensor converts.
enum class ConvertedLight {
  entering,  ///< light that enters the sensor's part, or leaves its part at the sensor's face
  absorbed,  ///< light that the surfaces of the sensor's part absorb, from either side (Geant4's EFFICIENCY)
  both,
};

/// Dependence of the efficiency on angle, relative to normal incidence.
struct AngularEfficiency {
  core::Curve factor;  ///< against the angle to the normal (rad), 1 at 0; constant beyond its last angle
  AngleMedium measured_in = AngleMedium::window;
  EfficiencyDefinition definition = EfficiencyDefinition::internal;
  double reference_index = 1.0;  ///< of the medium of incidence; not used when internal and in the window
};

/// Charge and current of one photoelectron of a photomultiplier, or of one avalanche of a silicon
/// photomultiplier.
struct SingleElectron {
  double charge_spread = 0.0;  ///< standard deviation of the charge over its mean
  /// Current (exp(-t/decay) - exp(-t/rise)) / (decay - rise); 0: that edge is instantaneous.
  double rise_ns = 0.0, decay_ns = 0.0;
};

/// Dark count rate: avalanches without light, independent of each other, at a constant rate.
struct DarkCounts {
  double per_ns = 0.0;      ///< of the whole sensor
  double per_ns_mm2 = 0.0;  ///< per unit area; added to per_ns
};

/// A sensor of the material database (`materials/sensors/NAME.toml`).
struct Sensor {
  std::string name;
  ConvertedLight converts = ConvertedLight::entering;
  core::Curve efficiency;  ///< conversion probability against wavelength (nm), as published
  EfficiencyDefinition definition = EfficiencyDefinition::internal;
  double reference_index = 1.0;  ///< of the medium in which an external efficiency was measured
  double window_index = 1.5;     ///< index of the entrance window; not used when it is matched
  bool window_matched = false;   ///< the window has the index of what it touches: no Fresnel reflection
  std::optional<AngularEfficiency> angle;  ///< nothing: the same at every angle for light inside
  /// Film whose absorbed light is converted; the sensor then converts absorbed light alone.
  std::optional<Photocathode> cathode;
  std::optional<FaceResponse> over_face;  ///< nothing: the same at every place
  double time_spread_ns = 0.0;  ///< standard deviation of the transit time (photomultiplier), or of the
                                ///< single photon time resolution (silicon photomultiplier)
  SingleElectron single_electron;
  core::Shared<AvalancheModel> avalanches = ProportionalModel();
  DarkCounts dark_counts;
  std::vector<std::string> sources;

  bool converts_entering() const { return converts != ConvertedLight::absorbed; }
  bool converts_absorbed() const { return converts != ConvertedLight::entering; }

  /// Probability that a photon that has entered the sensor at normal incidence, or with a photocathode that
  /// was absorbed in it, is converted, at a wavelength (nm), where its face response is 1.
  double conversion_probability(double wavelength_nm) const;
  /// Probability that a photon that has entered the sensor at any angle is converted.
  /// @param transverse_index  refractive index times sine of the angle to the normal, which is the same
  ///                          on both sides of every face of the window
  double conversion_probability(double wavelength_nm, double transverse_index) const;
  /// An upper bound of the conversion probability at every angle and place, for wavelengths (nm) of a range.
  /// At most 1.
  double conversion_bound(double low_nm, double high_nm) const;
  /// Conversion probability at an angle, relative to normal incidence, per photon inside the window. Requires
  /// `angle`. Constant beyond the last tabulated angle and beyond the range of refraction from the reference
  /// index.
  double angle_factor(double transverse_index) const;

 private:
  /// Largest angle of `angle` at which light can arrive.
  double largest_angle_rad() const;
  /// Transmission into the window at normal incidence over that at an angle of `angle`, where the published
  /// numbers include it, else 1.
  double entrance_correction(double angle_rad) const;
};

}  // namespace scintray::detector
