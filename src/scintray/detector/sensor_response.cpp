#include "scintray/detector/channel.hpp"

#include <algorithm>

#include "scintray/core/sampling.hpp"

namespace scintray::detector {

SensorResponse::SensorResponse(const Sensor& sensor, const SensorFace& face)
    : time_spread_ns_(sensor.time_spread_ns),
      charge_spread_(sensor.single_electron.charge_spread),
      dark_per_ns_(sensor.dark_counts.per_ns + sensor.dark_counts.per_ns_mm2 * face.area_mm2()),
      process_(sensor.avalanches->on(face)),
      memory_ns_(kTimesToForget * sensor.time_spread_ns + process_->memory_ns()) {}

double SensorResponse::dark_counts(double start_ns, double end_ns) const {
  return dark_per_ns_ * (end_ns - start_ns + memory_ns_ + kTimesToForget * time_spread_ns_);
}

std::vector<Avalanche> SensorResponse::avalanches(std::span<const Arrival> arrivals, double start_ns,
                                                  double end_ns, core::Rng& rng) const {
  const double last_ns = end_ns + kTimesToForget * time_spread_ns_;
  std::vector<Carrier> carriers;
  carriers.reserve(arrivals.size());
  for (const Arrival& arrival : arrivals)
    if (arrival.time_ns < last_ns)
      carriers.push_back({arrival.time_ns, process_->cell(arrival, rng), AvalancheCause::photon});
  if (dark_per_ns_ > 0.0) {
    const double first_ns = start_ns - memory_ns_;
    for (double t = first_ns + core::sample_exponential(rng) / dark_per_ns_; t < last_ns;
         t += core::sample_exponential(rng) / dark_per_ns_)
      carriers.push_back({t, process_->cell({t}, rng), AvalancheCause::dark});
  }

  std::vector<Avalanche> result;
  result.reserve(carriers.size());
  const auto deliver = [&](double time_ns, double charge, AvalancheCause cause) {
    const double gain = charge_spread_ > 0.0 ? core::sample_gamma(charge_spread_, rng) : 1.0;
    const double delay_ns = time_spread_ns_ > 0.0 ? time_spread_ns_ * core::sample_normal(rng) : 0.0;
    if (time_ns + delay_ns < end_ns) result.push_back({time_ns + delay_ns, charge * gain, cause});
  };
  process_->fire(carriers, last_ns, rng, deliver);
  std::stable_sort(result.begin(), result.end(),
                   [](const Avalanche& a, const Avalanche& b) { return a.time_ns < b.time_ns; });
  return result;
}

}  // namespace scintray::detector
