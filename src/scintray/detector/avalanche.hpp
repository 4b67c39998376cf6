#pragma once
/// Photons that a sensor has converted, and the avalanches that it makes of them.

#include <cstdint>
#include <limits>

namespace scintray::detector {

/// A converted photon. Where it is not known (NaN) it may be anywhere on the sensor's face.
struct Arrival {
  double time_ns = 0.0;
  double x_mm = std::numeric_limits<double>::quiet_NaN();  ///< from the middle of the face
  double y_mm = std::numeric_limits<double>::quiet_NaN();
};

enum class AvalancheCause : std::uint8_t { photon, dark, crosstalk, afterpulse };
inline constexpr std::size_t kAvalancheCauses = 4;

/// Time constants, or standard deviations, after which nothing is left: exp(-10) is 5e-5.
inline constexpr double kTimesToForget = 10.0;

/// Charge that reaches the electronics.
struct Avalanche {
  double time_ns = 0.0;
  double charge = 0.0;  ///< photoelectrons: 1 is the mean of a full avalanche
  AvalancheCause cause = AvalancheCause::photon;
};

/// The rectangle that a sensor's photons arrive on.
struct SensorFace {
  double width_mm = 1.0;   ///< along x
  double height_mm = 1.0;  ///< along y
  double area_mm2() const { return width_mm * height_mm; }
};

}  // namespace scintray::detector
