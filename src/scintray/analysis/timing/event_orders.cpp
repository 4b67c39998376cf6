#include "scintray/analysis/timing/event_orders.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scintray/analysis/timing/detail/photon_time.hpp"

namespace scintray::analysis {

namespace {

constexpr float kNoTime = std::numeric_limits<float>::quiet_NaN();

}  // namespace

std::optional<TimingBound> timing_bound(const tally::LightTiming& timing, double photons,
                                        std::span<const OrderTiming> orders) {
  if (!(timing.time_spread_ns > 0.0) || !(photons > 0.0)) return std::nullopt;
  std::vector<EmissionTime> emission;
  for (const optics::DecayComponent& component : timing.decay)
    emission.push_back({component.decay_ns, component.rise_ns, component.fraction});
  const PhotonTime time(std::move(emission), timing.time_spread_ns);
  TimingBound bound;
  bound.photons = photons;
  for (const OrderTiming& order : orders)
    bound.first_ns.push_back(coincidence_bound_fwhm_ns(time_information(time, photons, order.n)));
  bound.all_ns = coincidence_bound_fwhm_ns(time_information(time, photons));
  return bound;
}

OrderCollector::OrderCollector(std::vector<std::uint64_t> orders) : places_(orders.size()) {
  std::iota(places_.begin(), places_.end(), std::size_t{0});
  std::sort(places_.begin(), places_.end(),
            [&](std::size_t a, std::size_t b) { return orders[a] < orders[b]; });
  for (const std::size_t place : places_) orders_.push_back(orders[place]);
  while (averaged_ < orders_.size() && orders_[averaged_] == averaged_ + 1) ++averaged_;
}

void OrderCollector::add(const tally::EventRecord& event) {
  const std::size_t first = single_.size(), first_average = average_.size();
  single_.resize(first + orders_.size(), kNoTime);
  average_.resize(first_average + averaged_, kNoTime);
  for (const tally::ChannelRecord& channel : event.channels) {
    if (channel.order_ns.size() != orders_.size()) continue;
    double sum = 0.0;
    for (std::size_t i = 0; i < orders_.size(); ++i) {
      const float time = channel.order_ns[places_[i]];
      single_[first + i] = std::fmin(single_[first + i], time);
      if (i >= averaged_) continue;
      sum += static_cast<double>(time);
      average_[first_average + i] =
          std::fmin(average_[first_average + i], static_cast<float>(sum / static_cast<double>(i + 1)));
    }
  }
}

std::vector<OrderTimes> OrderCollector::times(std::span<const std::size_t> events) const {
  std::vector<OrderTimes> all;
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    OrderTimes choice;
    choice.n = orders_[i];
    for (const std::size_t event : events) {
      choice.single.push_back(static_cast<double>(single_[event * orders_.size() + i]));
      if (i < averaged_) choice.average.push_back(static_cast<double>(average_[event * averaged_ + i]));
    }
    all.push_back(std::move(choice));
  }
  return all;
}

}  // namespace scintray::analysis
