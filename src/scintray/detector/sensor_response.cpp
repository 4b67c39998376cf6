#include "scintray/detector/sensor_response.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

#include "scintray/core/sampling.hpp"

namespace scintray::detector {

namespace {

/// Time constants, or standard deviations, after which nothing is left: exp(-10) is 5e-5.
constexpr double kTimesToForget = 10.0;

struct Carrier {
  double time_ns;
  std::uint32_t cell;
  AvalancheCause cause;
};

bool later(const Carrier& a, const Carrier& b) { return a.time_ns > b.time_ns; }

/// The cells of one sensor during one event.
class FiringCells {
 public:
  FiringCells(const Microcells& cells, const MicrocellGrid& grid, std::size_t expected)
      : cells_(cells), grid_(grid), neighbour_rate_(-std::log1p(-cells.crosstalk) / 8.0) {
    fired_ns_.reserve(expected);
  }

  /// Lets a carrier fire its cell, and whatever that fires at once. `deliver(time, charge, cause)` takes the
  /// avalanches; carriers that are released later are left to be taken.
  template <class Deliver>
  void fire(const Carrier& first, core::Rng& rng, const Deliver& deliver) {
    at_once_.assign(1, first);
    while (!at_once_.empty()) {
      const Carrier carrier = at_once_.back();
      at_once_.pop_back();
      const double charge = discharge(carrier);
      if (charge <= 0.0) continue;
      deliver(carrier.time_ns, charge, carrier.cause);
      spread(carrier, charge, rng);
      if (cells_.afterpulse > 0.0 && rng.uniform() < cells_.afterpulse * charge)
        released_.push({carrier.time_ns + cells_.afterpulse_time_ns * core::sample_exponential(rng),
                        carrier.cell, AvalancheCause::afterpulse});
    }
  }

  /// Time of the next carrier to be released, infinite when there is none; and that carrier.
  double next_release_ns() const { return released_.empty() ? HUGE_VAL : released_.top().time_ns; }
  Carrier take_released() {
    const Carrier carrier = released_.top();
    released_.pop();
    return carrier;
  }

 private:
  /// Charge of a cell that fires now, as a share of a full one.
  double discharge(const Carrier& carrier) {
    const auto [cell, is_first] = fired_ns_.try_emplace(carrier.cell, carrier.time_ns);
    if (is_first) return 1.0;
    const double charge = -std::expm1((cell->second - carrier.time_ns) / cells_.recovery_ns);
    cell->second = carrier.time_ns;
    return charge;
  }

  /// Each neighbour catches a photon of the avalanche, independently: the gaps between those that do are
  /// geometric, and drawn as exponentials.
  void spread(const Carrier& carrier, double charge, core::Rng& rng) {
    if (neighbour_rate_ <= 0.0) return;
    std::array<std::uint32_t, 8> buffer{};
    const auto around = grid_.neighbours(carrier.cell, buffer);
    const double rate = neighbour_rate_ * charge;
    double index = std::floor(core::sample_exponential(rng) / rate);
    while (index < static_cast<double>(around.size())) {
      at_once_.push_back(
          {carrier.time_ns, around[static_cast<std::size_t>(index)], AvalancheCause::crosstalk});
      index += 1.0 + std::floor(core::sample_exponential(rng) / rate);
    }
  }

  const Microcells& cells_;
  const MicrocellGrid& grid_;
  double neighbour_rate_;
  std::unordered_map<std::uint32_t, double> fired_ns_;
  std::vector<Carrier> at_once_;
  std::priority_queue<Carrier, std::vector<Carrier>, decltype(&later)> released_{&later};
};

}  // namespace

SensorResponse::SensorResponse(const Sensor& sensor, const SensorFace& face)
    : time_spread_ns_(sensor.time_spread_ns),
      charge_spread_(sensor.single_electron.charge_spread),
      dark_per_ns_(sensor.dark_counts.per_ns + sensor.dark_counts.per_ns_mm2 * face.area_mm2()),
      memory_ns_(kTimesToForget * sensor.time_spread_ns),
      microcells_(sensor.microcells) {
  if (!microcells_) return;
  grid_.emplace(*microcells_, face);
  memory_ns_ += kTimesToForget * std::max(microcells_->recovery_ns, microcells_->afterpulse_time_ns);
}

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
      carriers.push_back({arrival.time_ns, grid_ ? grid_->at(arrival, rng) : 0, AvalancheCause::photon});
  if (dark_per_ns_ > 0.0) {
    const double first_ns = start_ns - memory_ns_;
    for (double t = first_ns + core::sample_exponential(rng) / dark_per_ns_; t < last_ns;
         t += core::sample_exponential(rng) / dark_per_ns_)
      carriers.push_back({t, grid_ ? grid_->any(rng) : 0, AvalancheCause::dark});
  }

  std::vector<Avalanche> result;
  result.reserve(carriers.size());
  const auto deliver = [&](double time_ns, double charge, AvalancheCause cause) {
    const double gain = charge_spread_ > 0.0 ? core::sample_gamma(charge_spread_, rng) : 1.0;
    const double delay_ns = time_spread_ns_ > 0.0 ? time_spread_ns_ * core::sample_normal(rng) : 0.0;
    if (time_ns + delay_ns < end_ns) result.push_back({time_ns + delay_ns, charge * gain, cause});
  };
  if (!grid_) {
    for (const Carrier& carrier : carriers) deliver(carrier.time_ns, 1.0, carrier.cause);
  } else {
    std::stable_sort(carriers.begin(), carriers.end(),
                     [](const Carrier& a, const Carrier& b) { return a.time_ns < b.time_ns; });
    FiringCells cells(*microcells_, *grid_, carriers.size());
    for (std::size_t next = 0;;) {
      const double carrier_ns = next < carriers.size() ? carriers[next].time_ns : HUGE_VAL;
      if (std::min(carrier_ns, cells.next_release_ns()) >= last_ns) break;
      cells.fire(cells.next_release_ns() < carrier_ns ? cells.take_released() : carriers[next++], rng,
                 deliver);
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Avalanche& a, const Avalanche& b) { return a.time_ns < b.time_ns; });
  return result;
}

}  // namespace scintray::detector
