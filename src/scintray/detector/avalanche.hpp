#pragma once
/// Photons converted by a sensor, and the avalanches that they trigger.

#include <cstdint>
#include <limits>

namespace scintray::detector {

/// A converted photon. Without a position (NaN) it may be anywhere on the sensor's face.
struct Arrival {
  double time_ns = 0.0;
  double x_mm = std::numeric_limits<double>::quiet_NaN();  ///< from the centre of the face
  double y_mm = std::numeric_limits<double>::quiet_NaN();
};

enum class AvalancheCause : std::uint8_t { photon, dark, crosstalk, afterpulse };
inline constexpr std::size_t kAvalancheCauses = 4;

/// Time constants, or standard deviations, after which nothing is left: exp(-10) is 5e-5.
inline constexpr double kTimesToForget = 10.0;

/// One avalanche: the charge that reaches the electronics.
struct Avalanche {
  double time_ns = 0.0;
  double charge = 0.0;  ///< photoelectrons: 1 is the mean of a full avalanche
  AvalancheCause cause = AvalancheCause::photon;
};

/// The rectangle on which a sensor's photons arrive.
struct SensorFace {
  double width_mm = 1.0;   ///< along x
  double height_mm = 1.0;  ///< along y
  double area_mm2() const { return width_mm * height_mm; }
};

}  // namespace scintray::detector
