#pragma once
/// Sensors and light of the tests: numbers chosen to show one thing each.

#include <vector>

#include "scintray/core/sampling.hpp"
#include "scintray/detector/channel.hpp"
#include "scintray/detector/microcells.hpp"
#include "support/laws.hpp"

namespace scintray::test {

inline constexpr detector::SensorFace kFace{3.0, 3.0};
inline constexpr double kLongAfter_ns = 1e6;

/// A silicon photomultiplier whose cells fire and recover, and nothing else.
inline detector::Sensor quiet_sipm(std::uint32_t cells) {
  detector::Sensor sensor;
  sensor.avalanches = detector::MicrocellModel({0.0, cells, 20.0, 0.0, 0.0, 0.0});
  return sensor;
}

/// Gives a silicon photomultiplier another number for its cells.
inline void set_cells(detector::Sensor& sensor, double detector::Microcells::*number, double value) {
  detector::MicrocellModel model = *sensor.avalanches.get_if<detector::MicrocellModel>();
  model.cells.*number = value;
  sensor.avalanches = model;
}

/// So many carriers at one time, anywhere on the face.
inline std::vector<detector::Arrival> flash(std::size_t photoelectrons, double time_ns = 0.0) {
  return std::vector<detector::Arrival>(photoelectrons, detector::Arrival{time_ns});
}

/// Independent carriers at a constant rate up to a time.
inline std::vector<detector::Arrival> steady_light(double per_ns, double end_ns, core::Rng& rng) {
  std::vector<detector::Arrival> arrivals;
  for (double t = core::sample_exponential(rng) / per_ns; t < end_ns;
       t += core::sample_exponential(rng) / per_ns)
    arrivals.push_back({t});
  return arrivals;
}

inline core::Rng event_stream(std::uint64_t event, std::uint64_t test = 0) {
  return core::Rng(20'13, core::StreamKind::other, event, test);
}

inline double total_charge(const std::vector<detector::Avalanche>& avalanches) {
  double sum = 0.0;
  for (const detector::Avalanche& avalanche : avalanches) sum += avalanche.charge;
  return sum;
}

inline std::uint64_t count_of(const std::vector<detector::Avalanche>& avalanches,
                              detector::AvalancheCause cause) {
  std::uint64_t count = 0;
  for (const detector::Avalanche& avalanche : avalanches) count += avalanche.cause == cause;
  return count;
}

/// The sample standard deviation with its standard error for a normal distribution.
inline core::Estimate spread_of(const core::Moments& moments) {
  const double s = moments.standard_deviation();
  return {s, s / std::sqrt(2.0 * static_cast<double>(moments.count - 1))};
}

}  // namespace scintray::test
