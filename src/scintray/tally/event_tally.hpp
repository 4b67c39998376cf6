#pragma once
/// Records of events.

#include <functional>

#include "scintray/source/light_source.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/point_sums.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray::tally {

/// Writes a channel's signal into its record of an event; the number of detected photons is kept.
void write_signal(detector::ChannelSignal signal, ChannelRecord& record);

/// Tally of events, one after the other.
class EventTally {
 public:
  EventTally(const scene::Scene& scene, const TallyPlan& plan)
      : scene_(scene), plan_(plan), arrivals_(plan.readout.size()) {}

  /// Starts the record of an event.
  void begin(std::uint64_t event, std::uint32_t point, const source::EventLight& light);
  /// Adds a photon of the event that was detected.
  void detected(std::uint32_t channel, const source::Photon& photon);
  /// Adds `count` detected photons of the event, at least one, the first of them at `first_ns`.
  void detected(std::uint32_t channel, std::uint64_t count, double first_ns);
  /// True with a readout: each detected photon is then also passed as an arrival.
  bool wants_arrivals() const { return !arrivals_.empty(); }
  void arrived(std::uint32_t channel, const detector::Arrival& arrival) {
    arrivals_[channel].push_back(arrival);
  }
  /// Ends the record of the event: its channels are read out, each with the random stream `stream(channel)`.
  void end(const std::function<core::Rng(std::uint32_t)>& stream);

  const std::vector<EventRecord>& events() const { return events_; }
  /// Adds the events to the sums over others.
  void add_to(EnergySums& total) const { total.add(balance_); }

 private:
  void read_out(std::uint32_t channel, core::Rng rng);

  const scene::Scene& scene_;
  const TallyPlan& plan_;
  std::vector<EventRecord> events_;  ///< the last is not complete
  std::vector<std::vector<detector::Arrival>>
      arrivals_;  ///< per channel, of that event; empty without [readout]
  EnergyBalance balance_;
  bool has_light_ = false;  ///< of that event: it deposited energy, or is of a list of photons
};

}  // namespace scintray::tally
